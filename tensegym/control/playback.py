"""Playback: commands against time, as a file gives them."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot

from .bearing import Bearing


class Playback:
    """Plays spool angles against time, linear in between, the last ones held.

    Args:
        times: (t,) growing [s]; the first is where the episode begins.
        commands: (t, w) spool angles [rad].
        period: a command is held for this long [s].
    """

    def __init__(self, times: FloatArray, commands: FloatArray, period: float) -> None:
        self.times, self.commands, self.period = times, commands, period

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        """As `Controller` has it. Raises DesignError where there is not one command a drive, or one is out of range."""
        if self.commands.shape[1] != len(robot.drives):
            raise DesignError(f"{self.commands.shape[1]} commands where the robot has {len(robot.drives)} drives")
        limit = robot.command_limit
        over = np.argwhere((self.commands > limit * (1 + 1e-9)) | (self.commands < 0))
        if len(over):
            row, drive = over[0]
            raise DesignError(f"drive_{drive + 1}_rad = {self.commands[row, drive]:g} at {self.times[row]:g} s is "
                              f"outside [0, {limit[drive]:.4g}] rad")  # fmt: skip
        self._played = 0

    def angles(self, robot: TensegrityRobot, bearing: Bearing | None = None) -> FloatArray:
        """As `Controller` has it: the commands of the period after the last one asked for."""
        now = self.times[0] + self._played * self.period
        self._played += 1
        return np.array([np.interp(now, self.times, column) for column in self.commands.T])
