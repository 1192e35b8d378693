"""One evaluation: a design under a controller tries a task. A pure function of the four, importable by any worker."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.errors import DesignError, SimulationError, StructureError
from tensegym.robot.gait import DriveMeter, GaitMeter
from tensegym.robot.robot import TensegrityRobot

from .controllers import Start, controller
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

    def __str__(self) -> str:
        return f"trial {self.number}"


@dataclass(frozen=True)
class Outcome:
    """What a worker gives back. refused: why the design cost no simulation, or None. seconds: of wall time."""

    number: int
    metrics: dict[str, float] = field(default_factory=dict)
    episodes: int = 0
    stopped: bool = False
    refused: str | None = None
    seconds: float = 0.0


def evaluate(design: RobotDesign, control: dict[str, Any], task: Task, seed: int) -> Episode:
    """Metrics of one episode. Raises DesignError or StructureError for what cannot be built."""
    with TensegrityRobot(design, dt=task.dt, ground=task.ground) as robot:
        return _episode(robot, controller(control), task, seed)


@dataclass(frozen=True)
class Tried:
    """All episodes of a trial, one by one."""

    number: int
    episodes: tuple[Episode, ...]


def try_all(trial: Trial) -> Tried:
    """Every episode of a trial, without a bar. Raises DesignError or StructureError."""
    design, start = design_from_dict(trial.design), controller(trial.controller)
    with TensegrityRobot(design, dt=trial.task.dt, ground=trial.task.ground) as robot:
        return Tried(trial.number, tuple(_episode(robot, start, trial.task, seed) for seed in trial.seeds))


def run_trial(trial: Trial) -> Outcome:
    """All episodes of a trial, or as many as it takes to see that it is hopeless."""
    begun = time.perf_counter()
    try:
        design, start = design_from_dict(trial.design), controller(trial.controller)
        episodes: list[Episode] = []
        with TensegrityRobot(design, dt=trial.task.dt, ground=trial.task.ground) as robot:
            start(robot, np.array([1.0, 0.0]))  # refuses what does not fit before any step
            for seed in trial.seeds:
                episodes.append(_episode(robot, start, trial.task, seed))
                if 2 * len(episodes) == len(trial.seeds) and progress_loss(trial.task, episodes) > trial.bar:
                    break
    except (DesignError, StructureError) as error:
        return Outcome(trial.number, refused=str(error), seconds=time.perf_counter() - begun)
    seconds = time.perf_counter() - begun
    return Outcome(trial.number, aggregate(episodes), len(episodes), len(episodes) < len(trial.seeds), None, seconds)


def progress_loss(task: Task, episodes: list[Episode]) -> float:
    """How far the goal is missed by some episodes of a trial: what the bar is compared with."""
    return task.goal.violation(aggregate(episodes))


def start_of(robot: TensegrityRobot, task: Task, seed: int) -> tuple[FloatArray, int]:
    """Stand the robot as the episode of a seed begins; returns the wanted direction (2,) and the face it leads to.

    That face is -1 unless the task is to step onto it.
    """
    rng = np.random.default_rng(seed)
    face = int(rng.integers(len(robot.faces.triangles)))
    heading, towards = rng.uniform(-math.pi, math.pi, 2)
    direction, target = np.array([math.cos(towards), math.sin(towards)]), -1
    robot.reset(face, heading)
    if task.motion == "step":
        edge = int(rng.integers(3))
        corners = robot.node_positions_in_world()[robot.faces.triangles[face]][:, :2]
        across = corners[[edge, (edge + 1) % 3]].mean(axis=0) - corners.mean(axis=0)
        direction, target = across / np.linalg.norm(across), int(robot.faces.neighbours[face, edge])
    robot.slope(math.radians(task.slope), direction)
    robot.step(round(task.settle / robot.dt))
    return direction, target


def _episode(robot: TensegrityRobot, start: Start, task: Task, seed: int) -> Episode:
    sound = True
    direction, target = start_of(robot, task, seed)
    meter = GaitMeter(robot, direction)
    drives, driver = DriveMeter(robot), start(robot, direction)
    substeps = max(1, round(driver.period / robot.dt))
    metrics = meter.metrics()
    for tick in range(max(1, math.floor(task.seconds / (substeps * robot.dt) + 1e-9))):
        if meter.tips == 0 and tick * substeps * robot.dt >= task.patience:
            break
        if target >= 0 and meter.tips > 0:
            break
        try:
            robot.command(driver.angles())
            robot.step(substeps)
            meter.update()
            drives.update()
        except SimulationError:
            sound = False
            break
        metrics = meter.metrics()
    sound = sound and metrics.audit_passed
    found = {k: float(v) for k, v in vars(metrics).items()}
    mass, arrived = robot.design.mass, sound and meter.face == target
    found |= {"arrived": float(arrived), "drive_load": drives.load, "mass": mass,
              "weight": mass * robot.design.gravity, "sound": float(sound)}  # fmt: skip
    if not sound:
        found |= {"speed": 0.0, "speed_lps": 0.0, "tips": 0.0}
    if not (sound and math.isfinite(found["cost_of_transport"])):
        found["cost_of_transport"] = WORST_COST
    return found
