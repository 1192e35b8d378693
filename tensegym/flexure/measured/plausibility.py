"""Are measured states those of this hinge? Rest pose, sign and scale, before anything is fitted to them."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.hinge import Hinge, States

NEAR = 0.1  # of L: by so much the tip at rest may miss (L, 0)
FAR = 10.0  # times the FEM's load: a unit, not a material that one takes for another of its kind
SLOW, SURE = 0.02, 5.0  # of L a radian, and standard errors: below them the tip does not tell which way it goes


def check_measured(states: States, length: float) -> None:
    """Refuse states that a hinge cannot have: a unit, a sign or an origin is another.

    The tip at rest must stand at (L, 0), where moment and force act the same way it must move the way they push, and
    the loads must have done work. States without a tip, or too far from rest to tell, pass.

    Args:
        states: as they were measured.
        length: L [m].

    Raises:
        FlexureError: naming what was found and what it looks like.
    """
    _check_tips(states.pick(np.asarray(np.isfinite(states.tip).all(axis=1))), length)
    loaded = states.pick(np.asarray(np.isfinite(np.column_stack([states.moment, states.force])).all(axis=1)))
    moved = loaded.tip - [length, 0.0]
    if not loaded.force.any():
        moved = np.zeros_like(moved)
    work = loaded.theta * loaded.moment + np.sum(loaded.force * moved, axis=1)
    if float(work[np.isfinite(work)].sum()) < 0:
        raise FlexureError("the moment turns against the angle: the sign of the load or of the angle is wrong")


def _check_tips(seen: States, length: float) -> None:
    span = np.abs(seen.theta).max(initial=0.0)
    if len(seen) < 2 or not np.ptp(seen.theta) > 0 or np.abs(seen.theta).min() > 0.3 * span:
        return
    rest, rate, error = _at_rest(seen)
    if np.abs(rest - [length, 0.0]).max() > NEAR * length:
        raise FlexureError(f"the tip at rest would be at ({1e3 * rest[0]:.4g}, {1e3 * rest[1]:.4g}) mm and not at "
                           f"L = {1e3 * length:.4g} mm on the x axis: {_guess(rest, length)}")  # fmt: skip
    aligned = seen.moment * seen.force[:, 1] >= 0
    if aligned.mean() > 0.9 and rate < -max(SLOW * length, SURE * error):
        raise FlexureError(f"the tip goes to y = {1e3 * rate * span:.3g} mm where the angle goes to "
                           f"+{np.degrees(span):.3g} deg: y is counted downwards, or the angle clockwise; base axes "
                           "have y upwards and the angle counterclockwise: turn the sign of one of them")  # fmt: skip


def load_note(states: States, hinge: Hinge) -> str:
    """A line where the loads are far from those that the hinge's FEM takes at the same angle; "" where they are not.

    The FEM is turned to the largest angle measured, by the wrench measured there, scaled.
    """
    loaded = states.pick(np.isfinite(states.force).all(axis=1) & (np.abs(states.moment) > 0) & (states.theta != 0))
    if not len(loaded):
        return ""
    far = int(np.argmax(np.abs(loaded.theta)))
    theta, moment = float(loaded.theta[far]), float(loaded.moment[far])
    solution = fem.rotate(hinge, [theta], direction=[*loaded.force[far], moment])
    if solution.status[0] != fem.CONVERGED:
        return f"the FEM of this hinge cannot be turned to {np.degrees(theta):.3g} deg by the wrench measured there"
    ratio = moment / float(solution.moment[0])
    if 1 / FAR < ratio < FAR:
        return ""
    return (f"at {np.degrees(theta):.3g} deg the load is {ratio:.3g} times that of this hinge's FEM "
            f"({hinge.material.modulus_name}, E = {hinge.material.youngs_modulus / 1e9:g} GPa): look at the unit of "
            "load and angle, and at E")  # fmt: skip


def _at_rest(states: States) -> tuple[FloatArray, float, float]:
    """The tip (2,) [m] that the states give at no rotation, dy/dtheta there and its standard error [m/rad]."""
    degree = min(2, len(np.unique(states.theta)) - 1)
    fitted = np.polynomial.polynomial.polyfit(states.theta, states.tip, degree)
    powers = states.theta[:, None] ** np.arange(degree + 1)
    scatter = np.sum((states.tip[:, 1] - powers @ fitted[:, 1]) ** 2) / max(len(states) - degree - 1, 1)
    error = np.sqrt(scatter * np.linalg.pinv(powers.T @ powers)[1, 1])
    return fitted[0], float(fitted[1, 1]), float(error)


def _guess(rest: FloatArray, length: float) -> str:
    """What the data look like, in words."""
    for scale, words in ((1e3, "the positions are in mm under a header in m"),
                         (1e-3, "the positions are in m under a header in mm")):  # fmt: skip
        if np.abs(rest - [scale * length, 0.0]).max() < NEAR * scale * length:
            return words
    if np.abs(rest).max() < NEAR * length:
        return "x and y are counted from the tip at rest; base axes begin at the hinge's fixed end, so add L to x"
    if abs(rest[1]) < NEAR * abs(rest[0]):
        return "the hinge has another length, or x is not counted from its fixed end"
    return "x and y are not counted from the hinge's fixed end, with x along the undeformed arm"
