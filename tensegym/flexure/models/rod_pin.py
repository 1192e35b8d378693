"""RodPin: the pin with a torsion spring that stands for a hinge inside a rod.

Not the pin of the paper's F1, which looks at the tip's path alone: a rod's far end sees the turn as well. A leaf bent
by a moment turns its tip about L / 2, while the tip's path is a circle about L / 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.fem.buckling import buckling_load, check_parts
from tensegym.flexure.hinge import Hinge, States, join
from tensegym.flexure.hinge.ranges import check_max_angle

from .torsion_spring import TorsionSpring, stiffness_about

POINTS = 20  # states a side
PASSES = 4  # of the direction of the rod's line; the tip moves little with it


@dataclass(frozen=True)
class RodPin:
    """A pin on the hinge's axis, a torsion spring in it, and how far both are from the hinge."""

    fraction: float
    """Where it stands on the hinge's length, from its base."""
    stiffness: float
    """[N m/rad]."""
    moment_error: float
    """Largest difference of the moment about the pin over the range, of the largest moment."""
    tip_error: float
    """Largest distance of the hinge's tip from where the pin puts it [m]."""
    buckling_ratio: float
    """Buckling load of the rod with the pin over that with the hinge: far from 1, the hinge gives way by more than its
    turn, as a parallel guide does, and no pin stands for it."""


@lru_cache(maxsize=256)
def rod_pin(hinge: Hinge, before: float, after: float, max_angle: float, compression: float = 0.0,
            elements: int = fem.ELEMENTS) -> RodPin:  # fmt: skip
    """The pin fitted by least squares to a hinge in a rod that equal and opposite end moments bend.

    Args:
        hinge: symmetric about its axis.
        before, after: rigid parts of the rod on the hinge's base and tip [m].
        max_angle: largest bend either way [rad], in (0, pi/2).
        compression: on the line of the rod's ends besides [N]: the fit is then to the hinge as it bends in the loaded
            rod, where its moment varies along it.
        elements: of a leaf as long as the hinge.

    Raises:
        FlexureError: as ``buckling_load``, and for an angle or a compression out of range.
    """
    check_parts(before, after)
    check_max_angle(max_angle)
    limit = buckling_load(hinge, before, after, elements)
    if not 0 <= compression < limit:
        raise FlexureError(f"compression = {compression:g} N is outside [0, {limit:.4g}) N, the rod's buckling load; "
                           "lower it or take a stiffer hinge")  # fmt: skip
    angle = max_angle * np.arange(1, POINTS + 1) / POINTS
    halves = [rod_states(hinge, sign * angle, before, after, compression, elements) for sign in (-1, 1)]
    states = join(halves)
    turned = np.column_stack([np.cos(states.theta) - 1, np.sin(states.theta)]).ravel()
    link = float(turned @ (states.tip - [hinge.length, 0.0]).ravel() / (turned @ turned))
    stiffness = stiffness_about(states, hinge.length - link)
    model = TorsionSpring(hinge.length, link / hinge.length, stiffness).poses(states.theta, states.force)
    rod, first = before + hinge.length + after, before + hinge.length - link
    return RodPin(
        1 - link / hinge.length, stiffness,
        float(np.abs(states.moment - model.moment).max() / (stiffness * max_angle)),
        float(np.hypot(*(states.tip - model.tip).T).max()),
        stiffness * rod / (first * (rod - first)) / limit,
    )  # fmt: skip


def rod_states(hinge: Hinge, theta: FloatArray, before: float, after: float, compression: float,
               elements: int = fem.ELEMENTS) -> States:  # fmt: skip
    """States of a hinge in a rod that moments bend and that is compressed along the line of its ends.

    Args:
        hinge, before, after, compression, elements: as ``rod_pin``.
        theta: (n,) [rad].

    Raises:
        FlexureError: where the hinge does not reach them.
    """
    line = 0.5 * theta  # exact for a symmetric rod
    for _ in range(PASSES if compression else 1):
        force = -compression * np.column_stack([np.cos(line), np.sin(line)])
        solution = fem.rotate(hinge, theta, force=force, elements=elements)
        bad = np.flatnonzero(solution.status != fem.CONVERGED)
        if len(bad):
            i = int(bad[0])
            raise FlexureError(f"{hinge.name}: a rod compressed by {compression:g} N {solution.reason(i)} towards "
                               f"{np.degrees(theta[i]):.3g} deg; lower max_angle")  # fmt: skip
        ends = solution.tip + after * np.column_stack([np.cos(theta), np.sin(theta)]) + [before, 0.0]
        line = np.arctan2(ends[:, 1], ends[:, 0])
    return solution.states()
