"""Targets: directions and places to go to, one after another, as a goal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from tensegym.arrays import FloatArray
from tensegym.control.bearing import Bearing
from tensegym.robot.robot import TensegrityRobot

from .goal import Goal, Place, unit


class Target(NamedTuple):
    """A direction, or a place in that direction from the last one."""

    angle: float
    """From the world's x axis [rad]."""
    distance: float
    """To the place [m]; inf for a direction alone."""
    seconds: float
    """How long the direction holds, or the robot is to stay at the place; 0 goes on at once."""
    drift: float
    """Rate at which the direction turns [rad/s]."""


class Leg(NamedTuple):
    """The way towards one target."""

    place: bool
    seconds: float
    """It took."""
    way: float
    """Made towards the target [m]."""


class Targets(Goal):
    """One target after another; each begins when the one before is reached, has been stayed at, or has had its time.

    Args:
        robot: standing where the episode starts.
        targets: endless; each is drawn when it begins.
        reach: from nearer than this a place counts as reached [m].
        within: the same for a place to stay at [m].
    """

    def __init__(self, robot: TensegrityRobot, targets: Iterator[Target], reach: float, within: float) -> None:
        self._targets, self._reach, self._within = targets, reach, within
        self.legs: list[Leg] = []
        """Those that are over."""
        self.places = 0
        """Reached so far."""
        self.arrived = False
        """Whether one was in the last control step."""
        self.stays, self.stayed = 0.0, 0.0
        """For how long it was to stay at a place so far, and was near enough [s]."""
        self._next(_centre(robot))

    def _next(self, start: FloatArray) -> None:
        """Another target; a place is measured from ``start`` (2,)."""
        self.target = target = next(self._targets)
        self._place: Place | None = None
        if math.isfinite(target.distance):
            self._place = Place(start + target.distance * unit(target.angle), target.seconds > 0, target.angle)
        self._seconds, self._way, self._reached_at = 0.0, 0.0, math.inf

    def bearing(self, robot: TensegrityRobot) -> Bearing:
        """As `Goal` has it."""
        if self._place is not None:
            return self._place.bearing(robot)
        return Bearing(unit(self.target.angle + self.target.drift * self._seconds))

    def made(self, bearing: Bearing, before: FloatArray, after: FloatArray) -> float:
        """As `Goal` has it; towards a place, by how much nearer it is."""
        if self._place is None:
            return super().made(bearing, before, after)
        return self._place.made(bearing, before, after)

    def update(self, robot: TensegrityRobot, way: float, seconds: float) -> None:
        """As `Goal` has it."""
        self._seconds += seconds
        self._way += way
        begun = 0.0
        if self._place is not None:
            begun = self._reached(self.bearing(robot), seconds)
        if self._seconds - begun >= self.target.seconds - 1e-9:
            self.legs.append(Leg(self._place is not None, self._seconds, self._way))
            self._next(_centre(robot) if self._place is None else self._place.at)

    def _reached(self, bearing: Bearing, seconds: float) -> float:
        """When the place was reached, inf before; counts it, and the time of the stay there."""
        near = bearing.distance <= (self._within if bearing.stay else self._reach)
        if math.isfinite(self._reached_at):
            self.stays += seconds
            self.stayed += seconds * near
        self.arrived = near and math.isinf(self._reached_at)
        if self.arrived:
            self.places += 1
            self._reached_at = self._seconds
        return self._reached_at

    def all_legs(self) -> list[Leg]:
        """Those that are over, or else the one that is not."""
        return self.legs or [Leg(self._place is not None, max(self._seconds, 1e-9), self._way)]


def _centre(robot: TensegrityRobot) -> FloatArray:
    return robot.centre_of_mass_in_world()[:2]
