"""Box: the rotations and forces that a joint model is fitted to and meant for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.tables import show

from .ranges import check_max_angle, check_positive, finite_array

Ends = tuple[float, float]
SLACK = 1e-9  # of half the range


@dataclass(frozen=True)
class Box:
    """|theta| and the dead force at the tip in base axes, each axis. Raises FlexureError out of range."""

    max_angle: float
    """[rad], in (0, pi/2)."""
    max_force: float
    """|Fx| and |Fy| at most [N], in (0, inf), but on an axis that has ends of its own."""
    force_x: Ends | None = None
    """Least and largest Fx [N]: a pivot that is only ever pulled has (0, 40)."""
    force_y: Ends | None = None
    """Least and largest Fy [N]."""

    def __post_init__(self) -> None:
        check_max_angle(self.max_angle)
        check_positive("max_force", self.max_force, "N")
        for name in ("force_x", "force_y"):
            ends = getattr(self, name)
            if ends is None:
                continue
            low, high = finite_array(ends, name, 2)
            if not low < high:
                why = "the ends are swapped" if low > high else "they leave no range"
                raise FlexureError(f"{name} = {show(ends)} N: {why}; give the least force and then a larger one")
            object.__setattr__(self, name, (float(low), float(high)))

    @property
    def symmetric(self) -> bool:
        """Whether both axes have +-max_force."""
        return self.force_x is None and self.force_y is None

    @property
    def ends(self) -> FloatArray:
        """(2, 2) least and largest force [N] on x and on y."""
        both = (-self.max_force, self.max_force)
        return np.array([self.force_x or both, self.force_y or both])

    @property
    def centre(self) -> FloatArray:
        """(2,) middle of the forces on x and y [N]."""
        return np.asarray(0.5 * (self.ends[:, 0] + self.ends[:, 1]))

    @property
    def half(self) -> FloatArray:
        """(2,) half the range of the forces on x and y [N]."""
        return np.asarray(0.5 * (self.ends[:, 1] - self.ends[:, 0]))

    def holds(self, force: FloatArray) -> NDArray[np.bool_]:
        """(n,) whether forces (n, 2) at the tip in base axes [N] are in the box, but for rounding."""
        return np.asarray((np.abs(force - self.centre) <= self.half * (1 + SLACK)).all(axis=1))

    @property
    def axial(self) -> Ends:
        """Least and largest force along the half-angle axis, cos(theta/2) Fx + sin(theta/2) Fy, over the box [N]."""
        half = self.max_angle / 2
        if self.symmetric:
            largest = float(self.max_force * (np.cos(half) + np.sin(half)))
            return -largest, largest
        corners = np.array([[x, y] for x in self.ends[0] for y in self.ends[1]])  # it is linear in the force
        return -_reach(-corners, half), _reach(corners, half)

    def told(self) -> str:
        """The forces as text."""
        if self.symmetric:
            return f"+-{self.max_force:.4g} N on each axis"
        (a, b), (c, d) = self.ends
        return f"Fx in [{a:.4g}, {b:.4g}] N and Fy in [{c:.4g}, {d:.4g}] N"


def _reach(corners: FloatArray, half: float) -> float:
    """Largest of the corners (n, 2) along any direction within +-half [rad] of x."""
    way = np.arctan2(corners[:, 1], corners[:, 0])
    return float(np.max(np.hypot(*corners.T) * np.cos(way - np.clip(way, -half, half))))
