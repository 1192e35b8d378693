"""Gymnasium environments. Importing registers them; `import tensegym` is enough."""

if not __name__.startswith("tensegym."):
    raise ImportError("import tensegym.envs, not envs: the folder is a part of the tensegym package")

from typing import Any

from gymnasium.envs.registration import register, registry

ROLLING = "tensegym/SixRodRolling-v0"
FLEXIBLE_ROLLING = "tensegym/FlexibleSixRodRolling-v0"
STEER, PLACES, PATH, COURSE, STEP = (
    f"tensegym/SixRod{name}-v0" for name in ("Steer", "Places", "Path", "Course", "Step")
)
EPISODE_SECONDS = 20.0
CONTROL_PERIOD = 0.4

IDS: dict[str, tuple[float, dict[str, Any]]] = {  # seconds of an episode, and arguments of RollingEnv
    ROLLING: (EPISODE_SECONDS, {"design": "six_rod"}),
    FLEXIBLE_ROLLING: (EPISODE_SECONDS, {"design": "six_rod_flexible"}),
    STEER: (60.0, {"task": "steer", "observation": "full-goal"}),
    PLACES: (60.0, {"task": "places", "observation": "full-goal"}),
    PATH: (120.0, {"task": "path", "observation": "full-goal"}),
    COURSE: (180.0, {"task": "course"}),
    STEP: (60.0, {"task": "stand"}),
}

for name, (seconds, arguments) in IDS.items():
    if name not in registry:
        register(
            id=name,
            entry_point="tensegym.envs.rolling:RollingEnv",
            vector_entry_point="tensegym.envs.vector:RollingVectorEnv",
            kwargs=arguments,
            max_episode_steps=round(seconds / CONTROL_PERIOD),
        )
