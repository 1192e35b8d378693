"""Where a joint model stands under dead loads: the state whose moment is the asked one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.hinge import Box, Hinge

from .joint import Model

GRID = 129  # angles scanned for a crossing


@dataclass(frozen=True)
class Answer:
    """The pose under one load, or why there is none."""

    theta: float
    """[rad]; NaN with a reason, as the rest."""
    x: float
    """Tip in base axes [m]."""
    y: float
    energy: float
    """Strain energy [J]; NaN for a model that has none."""
    reason: str = ""


def solve_fem(hinge: Hinge, loads: FloatArray, elements: int = fem.ELEMENTS) -> list[Answer]:
    """Where the FEM stands under loads, each applied from rest in proportion.

    Args:
        hinge: what is loaded.
        loads: (n, 3) dead force x, y at the tip in base axes [N] and moment about the tip [N m].
        elements: of a leaf as long as the hinge.
    """
    solution = fem.apply_wrench(hinge, loads, elements=elements)
    columns = np.column_stack([solution.theta, solution.tip, solution.energy]).tolist()
    return [Answer(t, x, y, energy, solution.reason(i)) for i, (t, x, y, energy) in enumerate(columns)]


def solve_model(model: Model, box: Box, loads: FloatArray) -> list[Answer]:
    """Where a fitted model stands under loads: a root of M(theta) at the load's force, bracketed.

    Args:
        model: of a joint.
        box: where it was fitted; a load outside gets a reason in place of a pose.
        loads: (n, 3) as ``solve_fem``.
    """
    return [_solve_one(model, box, load) for load in loads]


def _solve_one(model: Model, box: Box, load: FloatArray) -> Answer:
    nothing = (np.nan, np.nan, np.nan, np.nan)
    force, asked = load[:2], float(load[2])
    if not box.holds(force[None])[0]:
        return Answer(*nothing, f"the force ({force[0]:.4g}, {force[1]:.4g}) N is outside the fitted {box.told()}")
    angles = np.linspace(-box.max_angle, box.max_angle, GRID)
    try:
        gap = model.poses(angles, np.broadcast_to(force, (GRID, 2))).moment - asked
    except FlexureError as error:
        return Answer(*nothing, str(error))
    rising = np.flatnonzero((gap[:-1] <= 0) & (gap[1:] > 0))  # a falling moment is an unstable state
    if not len(rising):
        low, high = np.nanmin(gap) + asked, np.nanmax(gap) + asked
        angle = np.degrees(box.max_angle)
        return Answer(*nothing, f"no stable state within +-{angle:.4g} deg: at this force the moment spans "
                      f"{1e3 * low:.4g} to {1e3 * high:.4g} Nmm")  # fmt: skip
    i = rising[np.argmin(np.abs(angles[rising]))]

    def miss(theta: float) -> float:
        return float(model.poses(np.array([theta]), force[None]).moment[0]) - asked

    theta = angles[i] if gap[i] == 0 else brentq(miss, angles[i], angles[i + 1], xtol=1e-14, rtol=1e-14)
    state = model.poses(np.array([theta]), force[None])
    energy = float(model.energies(state)[0]) if hasattr(model, "energies") else np.nan
    return Answer(float(theta), float(state.tip[0, 0]), float(state.tip[0, 1]), energy)
