"""The rollout: a controller drives a robot through one episode of a task."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tensegym.control.controller import Controller
from tensegym.errors import DesignError
from tensegym.robot.fallen import FLAT, has_fallen
from tensegym.robot.gait import GaitMetrics
from tensegym.robot.robot import TensegrityRobot

from .episode import Episode, Watcher
from .start import Start
from .stride import time_to_stride
from .task import Task

TIME_LIMIT, GIVEN_UP = "time limit", "given up"
WORST_COST = 1e3  # what an infinite cost of transport counts as in a mean or an objective


class Result(NamedTuple):
    """What one episode came to."""

    seed: int
    start: Start
    gait: GaitMetrics
    """Until the last step that could be trusted."""
    measures: dict[str, float]
    """drive_load, stride [s], mass [kg], weight [N] and what the task measures itself."""
    ended: str
    diverged: bool
    fallen: bool = False
    """Whether it lay flat at the end, with a quarter of its volume at rest or less."""
    fault: str | None = None
    """When and by what the energy audit was broken, None where it held."""

    @property
    def sound(self) -> bool:
        """Whether what it did counts: it has not diverged or fallen flat, and keeps the energy audit."""
        return not (self.diverged or self.fallen) and self.gait.audit_passed

    def row(self) -> dict[str, Any]:
        """Plain JSON types: how it began and ended, and the gait as measured."""
        ends = {"seed": self.seed, "face": self.start.face, "terminated": self.diverged, "ended": self.ended,
                "fallen": self.fallen, "fault": self.fault}  # fmt: skip
        return ends | self.gait.as_dict()

    def scores(self) -> dict[str, float]:
        """All metrics as numbers to be averaged: an unsound episode makes no way, at the worst cost."""
        found = {k: float(v) for k, v in vars(self.gait).items()} | self.measures | {"sound": float(self.sound)}
        if not self.sound:
            found |= {"speed": 0.0, "speed_lps": 0.0, "tips": 0.0}
        if not (self.sound and math.isfinite(found["cost_of_transport"])):
            found["cost_of_transport"] = WORST_COST
        return found


def rollout(
    robot: TensegrityRobot, controller: Controller, task: Task, seed: int, *,
    rng: np.random.Generator | None = None, watcher: Watcher | None = None,
) -> Result:  # fmt: skip
    """One episode; a simulation that diverges is a result too.

    Args:
        robot: made with the task's time step and ground.
        controller: told to begin, then asked for commands once a period of its own.
        task: says how long, and when it is over.
        seed: of the start, and of a controller that draws.
        rng: a generator that has gone on from the seed; default: a fresh one.
        watcher: called while the robot moves.

    Raises:
        DesignError: the controller does not fit the robot.
    """
    episode = Episode(robot, task, np.random.default_rng(seed) if rng is None else rng)
    if not episode.diverged:
        controller.begin(robot, seed)
        _drive(episode, controller, watcher)
    return _result(episode, seed)


def whole_steps(period: float, dt: float) -> int:
    """How many steps of ``dt`` [s] a control period [s] is. Raises DesignError where it is no whole number of them."""
    number = isinstance(period, int | float) and not isinstance(period, bool)
    if not (number and 1e-6 <= period <= 60.0):
        raise DesignError(f"control_period = {period!r} is outside [1e-06, 60] s")
    steps = round(period / dt)
    if not (steps >= 1 and math.isclose(steps * dt, period, rel_tol=1e-6)):
        raise DesignError(f"control_period = {period!r} s must be a whole number of steps of dt = {dt!r} s")
    return steps


def _drive(episode: Episode, controller: Controller, watcher: Watcher | None) -> None:
    robot, task = episode.robot, episode.task
    substeps = max(1, round(controller.period / robot.dt))
    period = substeps * robot.dt
    for tick in range(max(1, math.floor(task.seconds / period + 1e-9))):
        if episode.meter.tips == 0 and tick * period >= task.patience:
            episode.ended = GIVEN_UP
        if episode.ended:
            return
        episode.advance(controller.angles(robot, episode.bearing), substeps, watcher)
    episode.ended = episode.ended or TIME_LIMIT


def _result(episode: Episode, seed: int) -> Result:
    design = episode.robot.design
    measures = {"mass": design.mass, "weight": design.mass * design.gravity, "drive_load": episode.drives.rms_current,
                "stride": _stride(episode)}  # fmt: skip
    task = episode.task
    fallen = not episode.diverged and has_fallen(episode.robot, FLAT)
    sound = episode.sound and not fallen
    measures |= task.measures(episode) if sound else {n: task.WORST.get(n, 0.0) for n in task.MEASURES}
    return Result(seed, episode.start, episode.gait, measures, str(episode.ended), episode.diverged, fallen,
                  episode.fault)


def _stride(episode: Episode) -> float:
    """Seconds until it goes as fast as it will; the whole episode where it never does."""
    steps, seconds = len(episode.ways) - 1, episode.gait.duration
    if episode.diverged or steps < 2:
        return seconds
    return min(seconds, time_to_stride(np.array(episode.ways), seconds / steps)[0])
