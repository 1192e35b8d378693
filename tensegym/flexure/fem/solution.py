"""Solution: equilibrium states as the FEM found them, or why it did not."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray, IntArray
from tensegym.flexure.hinge import States

from .path import BUCKLED, CONVERGED


@dataclass(frozen=True)
class Solution:
    """Equilibrium states in the order asked; a state that was not reached is NaN with a status other than CONVERGED."""

    theta: FloatArray
    """(n,) [rad]."""
    tip: FloatArray
    """(n, 2) base axes [m]."""
    force: FloatArray
    """(n, 2) on the tip body at the tip, base axes [N]."""
    moment: FloatArray
    """(n,) on the tip body about the tip [N m]."""
    energy: FloatArray
    """(n,) strain energy [J]."""
    status: IntArray
    """(n,) CONVERGED, BUCKLED or FAILED."""
    stable: NDArray[np.bool_]
    """(n,) the state is a minimum of the potential energy under its dead load."""
    reached: FloatArray
    """(n,) fraction of the path to the asked state that is stable: where it buckled; 1 when converged."""
    nodes: FloatArray
    """(n, k, 3) x, y [m] and turn [rad] of every leaf node, leaf after leaf; (0, k, 3) when not kept."""

    def states(self) -> States:
        """The converged states, for a fit."""
        good = self.status == CONVERGED
        return States(self.theta[good], self.tip[good], self.force[good], self.moment[good])

    def reason(self, index: int) -> str:
        """Why a state is missing; empty when it is not."""
        if self.status[index] == CONVERGED:
            return ""
        if self.status[index] == BUCKLED:
            return f"buckles at {self.reached[index]:.3g} of this load"
        return f"no equilibrium found beyond {self.reached[index]:.3g} of this load"


def together(parts: list[Solution]) -> Solution:
    """One Solution of all parts, in order."""
    return Solution(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Solution)))
