"""Load: a dead load on a link of a robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Load:
    """It keeps its direction in the world until it is taken away."""

    link: str
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In world axes [N]."""
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the force acts, in the link's own frame [m]."""
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In world axes [N m]."""
