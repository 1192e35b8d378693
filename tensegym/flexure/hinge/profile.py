"""Profile: how the thickness of a leaf runs from its start to its end.

Taper: linear. Notch: a web between two fillets, each a quarter of an ellipse, which meets the web smoothly and ends at
infinite slope; with the distance d from the nearer end of the leaf, semi-axes a along the leaf and b across it,

    t(d) = web + 2 b (1 - sqrt(1 - (1 - d/a)^2)) for d < a, else web.

a = b: circular fillets (corner-filleted leaf); a = half the leaf's length: no straight web, an elliptic notch, and with
a = b as well the circular notch of Paros and Weisbord (Machine Design 37, 1965).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

from .ranges import check_positive


@dataclass(frozen=True)
class Taper:
    """Linear from the leaf's thickness at its start. Raises FlexureError out of range."""

    end_thickness: float
    """In plane, at the leaf's end [m]."""

    def __post_init__(self) -> None:
        check_positive("end_thickness", self.end_thickness, "m, the leaf would end in an edge that carries no moment")

    def check(self, where: str, thickness: float, length: float) -> None:
        """Refuse a taper that is no beam on a leaf of that length [m]."""
        if not self.end_thickness < length / 4:
            raise FlexureError(f"{where}: end_thickness = {self.end_thickness:g} m at a length of {length:g} m; beam "
                               "theory needs a thickness below length / 4")  # fmt: skip

    def ends(self, thickness: float) -> tuple[float, float]:
        """Thickness at the leaf's start and end [m]."""
        return thickness, self.end_thickness

    def at(self, share: FloatArray, thickness: float, length: float) -> FloatArray:
        """Thickness (n,) [m] at shares (n,) of the leaf's length, 0 at its start."""
        return thickness + (self.end_thickness - thickness) * share


@dataclass(frozen=True)
class Notch:
    """A web of the leaf's thickness between elliptic fillets. Raises FlexureError out of range."""

    along: float
    """Semi-axis a along the leaf [m], at most half its length."""
    across: float
    """Semi-axis b across the leaf [m]; equal to ``along`` for circles."""

    def __post_init__(self) -> None:
        check_positive("notch: radius along the leaf", self.along, "m")
        check_positive("notch: depth across the leaf", self.across, "m")

    def check(self, where: str, thickness: float, length: float) -> None:
        """Refuse fillets that do not both fit on a leaf of that length [m]."""
        if self.along > length / 2 * (1 + 1e-9):
            raise FlexureError(f"{where}: the notch's radius {self.along:g} m along the leaf is above half of the "
                               f"web's length {length:g} m; give {length / 2:g} m or less")  # fmt: skip

    def ends(self, thickness: float) -> tuple[float, float]:
        """Thickness at the leaf's start and end [m]."""
        return thickness + 2 * self.across, thickness + 2 * self.across

    def at(self, share: FloatArray, thickness: float, length: float) -> FloatArray:
        """Thickness (n,) [m] at shares (n,) of the leaf's length, 0 at its start."""
        reach = np.clip(1 - length * np.minimum(share, 1 - share) / self.along, 0.0, 1.0)
        return np.asarray(thickness + 2 * self.across * (1 - np.sqrt(1 - reach * reach)))


Profile = Taper | Notch
