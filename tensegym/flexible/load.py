"""Load: a dead load on a link of a robot."""

from __future__ import annotations

from dataclasses import dataclass

from tensegym.flexure.hinge.ranges import finite_array
from tensegym.tables import show


@dataclass(frozen=True)
class Load:
    """It keeps its direction in the world until it is taken away. Raises FlexureError unless finite."""

    link: str
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In world axes [N]."""
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the force acts, in the link's own frame [m]."""
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In world axes [N m]."""

    def __post_init__(self) -> None:
        for name in ("force", "point", "torque"):
            finite_array(getattr(self, name), f"{name} on link {show(self.link)}", 3)
