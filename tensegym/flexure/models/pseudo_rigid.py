"""Where the paper puts its springs: lambda of the 1-DoF model, a and b of the planar one, and the drift of the axis.

Rakshin and Borisov 2023, with the tip (x_i, y_i, theta_i) of a sweep:

    F1(lambda) = sum_i [ sqrt(y_i^2 + (L (1 - lambda) - x_i)^2) - lambda L ]^2
    x_sp = x - a L - b L cos(theta),  y_sp = y - b L sin(theta),   d = max - min over the sweep
    F2(a, b) = dx_sp^2 + dy_sp^2      (as printed; it does not depend on a, so a = 1 - b: the spring rests at zero)

Table 1 was evidently made by minimising dx_sp alone; that reading is ``reading="dx"``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize, minimize_scalar

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States

READINGS = ("dx", "F2")


@dataclass(frozen=True)
class Placement:
    """a and b of the planar spring and the drift they leave."""

    a: float
    b: float
    dx: float
    """Extent of x_sp over the sweep [m]."""
    dy: float
    """Extent of y_sp over the sweep [m]."""
    reading: str


def torsion_lambda(states: States, length: float) -> float:
    """The fraction lambda that minimises F1: the link of the 1-DoF model is lambda L. Golden section, as fminbnd.

    Args:
        states: a sweep of 3 or more, tips measured.
        length: L [m].
    """
    _sweep(states)
    x, y = states.tip.T

    def cost(fraction: float) -> float:
        return float(np.sum((np.hypot(y, length * (1 - fraction) - x) / length - fraction) ** 2))

    # F1 has a flat far end (a large circle is a line): look on a grid first, so that the near valley is taken
    grid = np.linspace(0.01, 4.0, 200)
    best = grid[int(np.argmin([cost(g) for g in grid]))]
    return float(minimize_scalar(cost, bounds=(best - 0.04, best + 0.04), method="bounded", options={"xatol": 1e-10}).x)


def spring_track(states: States, length: float, b: float) -> FloatArray:
    """Displacement of the planar spring along the states, with a = 1 - b.

    Args:
        states: n of them.
        length: L [m].
        b: link from the spring to the tip, of L.

    Returns:
        (n, 2) x_sp, y_sp [m].
    """
    c, s = np.cos(states.theta), np.sin(states.theta)
    return states.tip - length * np.column_stack([1 - b + b * c, b * s])


def planar_placement(states: States, length: float, reading: str = "dx") -> Placement:
    """Where the planar spring stands, by gradient descent on the extents (scipy's SLSQP; the paper used fmincon).

    Args:
        states: a sweep of 3 or more, tips measured.
        length: L [m].
        reading: "dx" minimises dx_sp alone, which gives the paper's Table 1; "F2" the printed objective.

    Raises:
        FlexureError: for another reading, too few states, or states that do not turn.
    """
    _sweep(states)
    if str(reading) not in READINGS:
        raise FlexureError(f"reading = {reading!r}; one of {', '.join(READINGS)}")

    def extent(b: float) -> FloatArray:
        return np.asarray(np.ptp(spring_track(states, length, b), axis=0))

    def cost(b: float) -> float:
        d = extent(b) / length
        return float(d[0] if reading == "dx" else np.hypot(d[0], d[1]))

    grid = np.linspace(0, 1, 41)
    first = grid[int(np.argmin([cost(b) for b in grid]))]
    rough = float(minimize(lambda v: cost(v[0]), [first], bounds=[(0, 1)], method="SLSQP").x[0])
    low, high = max(0.0, min(first, rough) - 0.03), min(1.0, max(first, rough) + 0.03)
    b = float(minimize_scalar(cost, bounds=(low, high), method="bounded", options={"xatol": 1e-10}).x)
    dx, dy = extent(b)
    return Placement(1 - b, b, float(dx), float(dy), reading)


def _sweep(states: States) -> None:
    if len(states) < 3 or not np.isfinite(states.tip).all():
        raise FlexureError(f"{len(states)} states; a sweep needs 3 or more, each with its tip measured")
    if not np.ptp(states.theta) > 0:
        raise FlexureError("theta is the same in every state: no sweep; turn the hinge")
