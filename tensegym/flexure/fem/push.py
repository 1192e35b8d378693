"""Travel control: the tip pushed along y to where it is wanted, as a guide is."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.hinge.ranges import number_array

from .equilibrium import apply_wrench
from .mesh import ELEMENTS, mesh_of
from .path import CONVERGED
from .solution import Solution, together
from .tangent import memory_at, tip_stiffness

ROUNDS = 30
ACCURACY, FAR = 1e-9, 0.1  # of L: of the travel, and the most that one round goes by the tangent


def push(hinge: Hinge, travel: ArrayLike, *, axial: float = 0.0, moment: float = 0.0,
         elements: int = ELEMENTS) -> Solution:  # fmt: skip
    """The tip at y = travel under a dead force along y, found by Newton's method on the force; it may turn freely.

    Args:
        hinge: what is pushed.
        travel: (n,) y of the tip [m].
        axial: dead force along x besides [N].
        moment: dead moment besides [N m].
        elements: of a leaf as long as the hinge.

    Returns:
        The states with their nodes.

    Raises:
        FlexureError: for a travel of the hinge's length or more, and where the hinge cannot be pushed that far: it
            buckles, or gives way without end.
    """
    targets = np.atleast_1d(number_array(travel, "travel"))
    if not (np.abs(targets) < hinge.length).all():
        raise FlexureError(f"travel = {1e3 * np.abs(targets).max():.4g} mm is not below the hinge's length "
                           f"{1e3 * hinge.length:g} mm")  # fmt: skip
    mesh, parts, force, last, flexibility = mesh_of(hinge, elements), [], 0.0, np.nan, np.nan
    for target in targets:
        for _ in range(ROUNDS):
            if np.isfinite(flexibility):
                force += float(np.clip(target - last, -FAR * hinge.length, FAR * hinge.length)) / flexibility
            found = apply_wrench(hinge, [axial, force, moment], elements=elements, keep_nodes=True)
            if found.status[0] != CONVERGED:
                why = f"{force:.4g} N across and {axial:.4g} N along it {found.reason(0)}"
                raise FlexureError(
                    f"{hinge.name}: at {1e3 * target:.4g} mm of travel, {why}; lower the travel or the load"
                )
            last = float(found.tip[0, 1])
            stiffness = tip_stiffness(mesh, memory_at(mesh, found, 0))
            flexibility = float(np.linalg.inv(stiffness)[1, 1])
            if abs(last - target) <= ACCURACY * hinge.length:
                break
        else:
            raise FlexureError(f"{hinge.name}: no force holds the tip at {1e3 * target:.4g} mm; lower the travel")
        parts.append(found)
    return together(parts)
