"""Load: a dead load on a link of a robot."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tensegym.errors import FlexureError


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
            value = getattr(self, name)
            if len(value) != 3 or not all(map(math.isfinite, value)):
                raise FlexureError(f"{name} = {tuple(value)} on link {self.link!r}; give 3 finite values")
