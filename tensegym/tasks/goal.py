"""Goals: what is wanted of one episode. Whatever it is, a controller is told a bearing at each of its periods."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.bearing import Bearing
from tensegym.robot.robot import TensegrityRobot


class Goal:
    """Base: what an episode wants of a robot."""

    def bearing(self, robot: TensegrityRobot) -> Bearing:
        """The way to go now."""
        raise NotImplementedError

    def update(self, robot: TensegrityRobot, way: float, seconds: float) -> None:
        """Look at the robot after a control step of so many seconds, in which it `made` so much way [m].

        The bearing may be another from now on.
        """

    def made(self, bearing: Bearing, before: FloatArray, after: FloatArray) -> float:
        """Way made towards what a bearing wanted [m], by a centre of mass that went from one place (2,) to another."""
        return float(bearing.direction @ after) - float(bearing.direction @ before)


@dataclass(frozen=True)
class Heading(Goal):
    """One direction for the whole episode."""

    towards: FloatArray
    """(2,) unit vector in the world's horizontal plane."""

    @classmethod
    def at(cls, angle: float) -> Heading:
        """That of an angle from the world's x axis [rad]."""
        return cls(unit(angle))

    def bearing(self, robot: TensegrityRobot) -> Bearing:
        """As `Goal` has it."""
        return Bearing(self.towards)


@dataclass(frozen=True)
class Place(Goal):
    """A place to go to."""

    at: FloatArray
    """(2,) [m]."""
    stay: bool = True
    """Whether to stop there."""
    fallback: float = 0.0
    """Angle of the way to go at the very place, from the world's x axis [rad]."""

    def bearing(self, robot: TensegrityRobot) -> Bearing:
        """As `Goal` has it."""
        to_go = self.at - robot.centre_of_mass_in_world()[:2]
        distance = float(np.linalg.norm(to_go))
        return Bearing(to_go / distance if distance > 1e-9 else unit(self.fallback), distance, self.stay)

    def made(self, bearing: Bearing, before: FloatArray, after: FloatArray) -> float:
        """As `Goal` has it: by how much nearer it is."""
        return float(np.linalg.norm(self.at - before) - np.linalg.norm(self.at - after))


def unit(angle: float) -> FloatArray:
    """(2,) unit vector at an angle from the world's x axis [rad]."""
    return np.array([math.cos(angle), math.sin(angle)])
