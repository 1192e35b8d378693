"""Goals: what is wanted of one episode. Whatever it is, a controller is told a direction at each of its periods."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.robot.robot import TensegrityRobot


class Goal(Protocol):
    """What an episode wants of a robot."""

    def direction(self, robot: TensegrityRobot) -> FloatArray:
        """(2,) wanted heading now: a unit vector in the world's horizontal plane."""


@dataclass(frozen=True)
class Heading:
    """One direction for the whole episode."""

    towards: FloatArray
    """(2,) unit vector in the world's horizontal plane."""

    @classmethod
    def at(cls, angle: float) -> Heading:
        """That of an angle from the world's x axis [rad]."""
        return cls(np.array([math.cos(angle), math.sin(angle)]))

    def direction(self, robot: TensegrityRobot) -> FloatArray:
        """(2,) as `Goal` has it."""
        return self.towards


@dataclass(frozen=True)
class Neighbour(Heading):
    """Across one edge of the face the robot stands on, onto the next face."""

    face: int = -1
    """Index of the face to arrive on."""
