"""Gymnasium environments. Importing registers them; `import tensegym` is enough."""

if not __name__.startswith("tensegym."):
    raise ImportError("import tensegym.envs, not envs: the folder is a part of the tensegym package")

from gymnasium.envs.registration import register, registry

ROLLING = "tensegym/SixRodRolling-v0"
FLEXIBLE_ROLLING = "tensegym/FlexibleSixRodRolling-v0"
EPISODE_SECONDS = 20.0
CONTROL_PERIOD = 0.4

for name, design in ((ROLLING, "six_rod"), (FLEXIBLE_ROLLING, "six_rod_flexible")):
    if name not in registry:
        register(
            id=name,
            entry_point="tensegym.envs.rolling:RollingEnv",
            vector_entry_point="tensegym.envs.vector:RollingVectorEnv",
            kwargs={"design": design},
            max_episode_steps=round(EPISODE_SECONDS / CONTROL_PERIOD),
        )
