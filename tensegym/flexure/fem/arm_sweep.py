"""The paper's sweep: a hinge turned through its range by a force at the end of the stand's arm."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Hinge, States, join

from .equilibrium import arm_direction, rotate
from .mesh import ELEMENTS
from .path import CONVERGED


def arm_sweep(hinge: Hinge, max_angle: float, count: int = 60, elements: int = ELEMENTS) -> States:
    """States over +-max_angle under a force in base y at the end of the arm; a hinge without arm: a pure moment.

    Args:
        hinge: its ``arm`` is the lever.
        max_angle: [rad].
        count: states on either side of rest.
        elements: of a leaf as long as the hinge.

    Returns:
        2 count + 1 states in the order of their angles.

    Raises:
        FlexureError: where the hinge cannot be turned that far.
    """
    angle = max_angle * np.arange(1, count + 1) / count
    parts = [_half_sweep(hinge, -angle, elements).pick(slice(None, None, -1)),
             States(np.zeros(1), np.array([[hinge.length, 0.0]]), np.zeros((1, 2)), np.zeros(1)),
             _half_sweep(hinge, angle, elements)]  # fmt: skip
    return join(parts)


def _half_sweep(hinge: Hinge, angle: FloatArray, elements: int) -> States:
    direction = arm_direction(angle, hinge.arm) if hinge.arm else (0.0, 0.0, 1.0)
    solution = rotate(hinge, angle, direction=direction, elements=elements)
    bad = np.flatnonzero(solution.status != CONVERGED)
    if len(bad):
        raise FlexureError(f"{hinge.name}: the arm's sweep {solution.reason(int(bad[0]))} towards "
                           f"{np.degrees(angle[bad[0]]):.3g} deg; lower max_angle")  # fmt: skip
    return solution.states()
