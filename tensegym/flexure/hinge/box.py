"""Box: the rotations and forces that a joint model is fitted to and meant for."""

from __future__ import annotations

from dataclasses import dataclass

from .ranges import check_max_angle, check_positive


@dataclass(frozen=True)
class Box:
    """|theta| and the dead force at the tip in base axes, each axis. Raises FlexureError out of range."""

    max_angle: float
    """[rad], in (0, pi/2)."""
    max_force: float
    """|Fx| and |Fy| at most [N], in (0, inf)."""

    def __post_init__(self) -> None:
        check_max_angle(self.max_angle)
        check_positive("max_force", self.max_force, "N")
