"""Why rows fail, in plain words, by problem and engine."""

from __future__ import annotations

_OWN_STEP = (
    "The engine's own step, of first order in the time step. No robot here has such a body: rods and balls are "
    "symmetric about an axis, and stepped as the body above."
)
REASONS = {
    ("boxes", "pybullet"): _OWN_STEP,
    ("boxes", "mujoco"): _OWN_STEP,
    ("four_bars", "pybullet"): (
        "PyBullet closes a loop by an impulse a step and a spring, and that takes energy, a fifth of it at half"
        " the step. The loop itself holds: after ten turns through the pose in a line the rods are still "
        "parallel. Robots here are free bodies and trees; none has a loop."
    ),
    ("pushed", "mujoco"): (
        "MuJoCo's contacts are soft, its friction too: the balls slip on the box, take less of the push, and "
        "the box is the faster for it."
    ),
    ("contacts", "mujoco"): (
        "MuJoCo's contacts give way, by hundredths of a millimetre at rest and by a millimetre or more where a foot "
        "hits the ground; it makes no energy, see the audit below."
    ),
    ("stopping", "mujoco"): (
        "MuJoCo solves contact as a convex problem, whose known price (Anitescu 2006) is that what slides is lifted, "
        "with its speed and the friction: a lone rod at 2 m/s hops, as the notes above count, and stops up to a hop "
        "off. Feet of a robot that rolls slide slower than that."
    ),
}


def reason(problem: str, engine: str) -> str:
    """Of the failing rows of a problem in an engine."""
    return REASONS.get((problem, engine), "Not understood yet.")
