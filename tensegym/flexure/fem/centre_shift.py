"""Centre shift of a pivot: how far the point that should stand still moves."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from tensegym.arrays import FloatArray
from tensegym.flexure.hinge import States, preset

from .equilibrium import rotate
from .mesh import ELEMENTS


def centre_shift(states: States, length: float, place: float) -> FloatArray:
    """(n,) distance [m] that the tip body's point, at (place, 0) [m] at rest, has moved."""
    arm = length - place
    moved = states.tip - arm * np.column_stack([np.cos(states.theta), np.sin(states.theta)])
    return np.asarray(np.hypot(moved[:, 0] - place, moved[:, 1]))


def crossing_shift(crossing: float, angle: float, elements: int = ELEMENTS, **dimensions: float) -> float:
    """Shift [m] of the crossing point of a cross-spring pivot turned by a pure moment to ``angle`` [rad]."""
    hinge = preset("cross-spring", crossing=crossing, **dimensions)
    states = rotate(hinge, angle * np.arange(1, 5) / 4, elements=elements).states()
    return float(centre_shift(states, hinge.length, crossing * hinge.length)[-1])


def least_shift_crossing(angle: float, elements: int = ELEMENTS, **dimensions: float) -> tuple[float, float]:
    """Crossing fraction in (0, 0.5) of least centre shift at ``angle`` [rad], and that shift [m].

    The known answer is near 0.13. For slender leaves of length l that cross at half angle alpha the shift begins as
    |9 c^2 - 9 c + 1| theta^2 l / (15 cos alpha) in the crossing fraction c: least at (3 - sqrt 5)/6 = 0.1273.
    """
    grid = np.linspace(0.02, 0.48, 24)
    best = grid[int(np.argmin([crossing_shift(c, angle, elements, **dimensions) for c in grid]))]
    result = minimize_scalar(lambda c: crossing_shift(c, angle, elements, **dimensions),
                             bounds=(best - 0.02, best + 0.02), method="bounded", options={"xatol": 1e-6})  # fmt: skip
    return float(result.x), float(result.fun)
