"""One evaluation: a design under a controller tries a task. A pure function of the four, importable by any worker."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tensegym.control.cpg import Cpg, CpgController
from tensegym.design import RobotDesign
from tensegym.design_file import design_from_dict
from tensegym.errors import DesignError, SimulationError, StructureError
from tensegym.gait import GaitMeter
from tensegym.robot import TensegrityRobot

from .measure import WORST_COST, aggregate
from .task import Task

Episode = dict[str, float]


@dataclass(frozen=True)
class Trial:
    """What a worker gets. design and controller are tables as in a task file, seeds one an episode.

    bar: a loss; a trial whose mean loss over the first half of its episodes is above it is stopped there.
    """

    number: int
    design: dict[str, Any]
    controller: dict[str, Any]
    task: Task
    seeds: tuple[int, ...]
    bar: float = math.inf


@dataclass(frozen=True)
class Outcome:
    """What a worker gives back. refused: why the design cost no simulation, or None. seconds: of wall time."""

    number: int
    metrics: dict[str, float] = field(default_factory=dict)
    episodes: int = 0
    stopped: bool = False
    refused: str | None = None
    seconds: float = 0.0


def evaluate(design: RobotDesign, controller: dict[str, Any], task: Task, seed: int) -> Episode:
    """Metrics of one episode. Raises DesignError or StructureError for what cannot be built."""
    with TensegrityRobot(design, dt=task.dt) as robot:
        return _episode(robot, Cpg.from_dict(controller), task, seed)


def run_trial(trial: Trial) -> Outcome:
    """All episodes of a trial, or as many as it takes to see that it is hopeless."""
    begun = time.perf_counter()
    try:
        design, parameters = design_from_dict(trial.design), Cpg.from_dict(trial.controller)
        episodes: list[Episode] = []
        with TensegrityRobot(design, dt=trial.task.dt) as robot:
            CpgController(robot, parameters, np.array([1.0, 0.0]))  # refuses what does not fit before any step
            for seed in trial.seeds:
                episodes.append(_episode(robot, parameters, trial.task, seed))
                if 2 * len(episodes) == len(trial.seeds) and progress_loss(trial.task, episodes) > trial.bar:
                    break
    except (DesignError, StructureError) as error:
        return Outcome(trial.number, refused=str(error), seconds=time.perf_counter() - begun)
    seconds = time.perf_counter() - begun
    return Outcome(trial.number, aggregate(episodes), len(episodes), len(episodes) < len(trial.seeds), None, seconds)


def progress_loss(task: Task, episodes: list[Episode]) -> float:
    """How far the goal is missed by some episodes of a trial: what the bar is compared with."""
    return task.goal.violation(aggregate(episodes))


def _episode(robot: TensegrityRobot, parameters: Cpg, task: Task, seed: int) -> Episode:
    rng = np.random.default_rng(seed)
    face = int(rng.integers(len(robot.faces.triangles)))
    heading, towards = rng.uniform(-math.pi, math.pi, 2)
    direction = np.array([math.cos(towards), math.sin(towards)])
    sound = True
    robot.reset(face, heading)
    robot.step(round(task.settle / robot.dt))
    meter = GaitMeter(robot, direction)
    controller = CpgController(robot, parameters, direction)
    substeps = max(1, round(controller.period / robot.dt))
    metrics = meter.metrics()
    for tick in range(max(1, math.floor(task.seconds / (substeps * robot.dt) + 1e-9))):
        if meter.tips == 0 and tick * substeps * robot.dt >= task.patience:
            break
        try:
            robot.command(controller.angles())
            robot.step(substeps)
            meter.update()
        except SimulationError:
            sound = False
            break
        metrics = meter.metrics()
    sound = sound and metrics.audit_passed
    found = {k: float(v) for k, v in vars(metrics).items()}
    found |= {"arrived": 0.0, "mass": robot.design.mass, "weight": robot.design.mass * robot.design.gravity,
              "sound": float(sound)}  # fmt: skip
    if not sound:
        found |= {"speed": 0.0, "speed_lps": 0.0, "tips": 0.0}
    if not (sound and math.isfinite(found["cost_of_transport"])):
        found["cost_of_transport"] = WORST_COST
    return found
