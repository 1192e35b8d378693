"""Roll: make way in a wanted direction, on whatever ground."""

from __future__ import annotations

from dataclasses import dataclass

from tensegym.tables import parsed

from .bound import Bound
from .task import Task


@dataclass(frozen=True, kw_only=True)
class Roll(Task):
    """Roll along one direction; on a slope it is uphill, bumps are crossed in it."""

    goal: Bound = parsed(Bound.parse, Bound("speed_lps", True, 0.2))
