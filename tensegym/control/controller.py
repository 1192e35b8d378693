"""Controller: what drives a robot through an episode, one protocol for all of them."""

from __future__ import annotations

from typing import Protocol

from tensegym.arrays import FloatArray
from tensegym.robot.robot import TensegrityRobot

from .bearing import Bearing


class Controller(Protocol):
    """Told to begin on a robot that stands as its episode starts, then asked for commands once a period."""

    @property
    def period(self) -> float:
        """A command is held for this long [s]."""

    def begin(self, robot: TensegrityRobot, seed: int) -> None:
        """Forget the last episode.

        Args:
            robot: the one it is about to drive, settled at the episode's start.
            seed: the episode's, for controllers that draw.

        Raises:
            DesignError: it does not fit the robot.
        """

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        """Commanded spool angles (w,) [rad] for the next period.

        Args:
            robot: as it is now.
            bearing: the way to go now.
        """
