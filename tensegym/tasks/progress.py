"""Progress: what a task sees of an episode of it."""

from __future__ import annotations

from typing import Protocol

from tensegym.robot.gait import GaitMeter, GaitMetrics
from tensegym.robot.reading import Reading
from tensegym.robot.robot import TensegrityRobot

from .goal import Goal
from .start import Start


class Progress(Protocol):
    """An episode so far; `tensegym.tasks.episode.Episode` is one."""

    robot: TensegrityRobot
    start: Start
    goal: Goal
    meter: GaitMeter
    gait: GaitMetrics
    reading: Reading
    """Of the robot after the last control step."""

    @property
    def sound(self) -> bool:
        """Whether what it did can be believed: it has not diverged, and keeps the energy audit."""
