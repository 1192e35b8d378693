"""Path: a line on the ground to go along, as a goal."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.bearing import Bearing
from tensegym.robot.robot import TensegrityRobot

from .goal import Goal

SAMPLES = 2000  # points that a path is kept as


def line() -> FloatArray:
    """Straight on for its size."""
    return np.array([[0.0, 0.0], [1.0, 0.0]])


def arc() -> FloatArray:
    """Half a circle of its size across."""
    angle = np.linspace(0, math.pi, 181)
    return np.column_stack([np.sin(angle), 1 - np.cos(angle)]) / 2


def triangle() -> FloatArray:
    """Around a right triangle whose legs are its size and three quarters of it, along the longer one first."""
    return np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.75], [0.0, 0.0]])


def eight() -> FloatArray:
    """Bernoulli's lemniscate, its size long, from the end of one loop on."""
    angle = np.linspace(0, 2 * math.pi, 721)
    along = np.cos(angle) / (1 + np.sin(angle) ** 2)
    return np.column_stack([along * np.sin(angle), 1 - along]) / 2


SHAPES: dict[str, Callable[[], FloatArray]] = {"line": line, "arc": arc, "triangle": triangle, "eight": eight}
"""Corners (k, 2) of each shape at size 1, from the origin on, the way there along x."""


def sampled(corners: FloatArray) -> FloatArray:
    """(SAMPLES, 2) points evenly along the straight lines between corners (k, 2)."""
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    at = np.linspace(0, run[-1], SAMPLES)
    return np.column_stack([np.interp(at, run, corners[:, 0]), np.interp(at, run, corners[:, 1])])


class Path(Goal):
    """Go along a line: the bearing points to where it will be some way ahead (pure pursuit, R. C. Coulter,
    Implementation of the pure pursuit path tracking algorithm, CMU-RI-TR-92-01, 1992).

    How far the robot has come only grows, by at most ``ahead`` at a time, so that a path may cross itself.

    Args:
        points: (n, 2) evenly along the line [m], in the world.
        ahead: how far ahead the bearing points [m].
        reach: from nearer than this the end is reached [m].
    """

    def __init__(self, points: FloatArray, ahead: float, reach: float) -> None:
        self.points, self.ahead, self._reach = points, ahead, reach
        self.spacing = float(np.linalg.norm(np.diff(points, axis=0), axis=1).mean())
        self._window = max(1, round(ahead / self.spacing))
        self._come = 0
        self._squares, self._updates = 0.0, 0
        self.ended = False
        """Whether the end is reached."""

    def bearing(self, robot: TensegrityRobot) -> Bearing:
        """As `Goal` has it; the distance is that to the end once it is what the bearing points to."""
        at = min(self._come + self._window, len(self.points) - 1)
        to_go = self.points[at] - robot.centre_of_mass_in_world()[:2]
        distance = float(np.linalg.norm(to_go))
        direction = to_go / distance if distance > 1e-9 else np.array([1.0, 0.0])
        return Bearing(direction, distance if at == len(self.points) - 1 else math.inf)

    def update(self, robot: TensegrityRobot, way: float, seconds: float) -> None:
        """As `Goal` has it."""
        here = robot.centre_of_mass_in_world()[:2]
        off = np.linalg.norm(self.points[self._come : self._come + self._window + 1] - here, axis=1)
        self._come += int(off.argmin())
        self._squares += float(off.min()) ** 2
        self._updates += 1
        self.ended = bool(np.linalg.norm(self.points[-1] - here) <= self._reach
                          and self._come + self._window >= len(self.points) - 1)  # fmt: skip

    @property
    def share(self) -> float:
        """How much of the line it has come along; all of it once the end is reached."""
        return 1.0 if self.ended else self._come / (len(self.points) - 1)

    @property
    def length(self) -> float:
        """Of the line [m]."""
        return self.spacing * (len(self.points) - 1)

    @property
    def off(self) -> float:
        """Root mean square distance to the line [m], of the centre of mass after each control step."""
        return math.sqrt(self._squares / max(1, self._updates))
