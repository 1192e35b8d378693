"""RandomCommands: the baseline that any controller has to beat."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.robot.robot import TensegrityRobot

from .bearing import Bearing


class RandomCommands:
    """Every drive anywhere in its range, drawn anew each period."""

    def __init__(self, period: float = 0.4) -> None:
        self.period = period

    def begin(self, robot: TensegrityRobot, seed: int) -> None:
        """As `Controller` has it."""
        self._rng = np.random.default_rng(seed)

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        """As `Controller` has it."""
        return robot.angles_of(self._rng.uniform(-1, 1, len(robot.drives)))
