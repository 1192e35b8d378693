"""One trial of a search: a design under a controller tries a task. A pure function, importable by any worker."""

from __future__ import annotations

import math
import time
from contextlib import closing
from dataclasses import dataclass, field
from typing import Any

from tensegym.control.table import make_controller
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.errors import TensegymError
from tensegym.tasks.rollout import rollout
from tensegym.tasks.task import Task
from tensegym.tasks.trials import Setup, iterate

from .measure import aggregate

Episode = dict[str, float]


@dataclass(frozen=True)
class TrialSpec:
    """What a worker gets. design and controller are tables as in a task file, seeds one an episode.

    bar: a loss; a trial whose mean loss over the first half of its episodes, rounded up, is above it is stopped there.
    """

    number: int
    design: dict[str, Any]
    controller: dict[str, Any]
    task: Task
    seeds: tuple[int, ...]
    bar: float = math.inf

    def setup(self) -> Setup:
        """What is tried. Raises what a design or a controller that is none raises."""
        return Setup(f"trial {self.number}", self.task, self.controller, design_from_dict(self.design))


@dataclass(frozen=True)
class TrialResult:
    """What a worker gives back. refused: why there is no result, or None. seconds: of wall time."""

    number: int
    metrics: dict[str, float] = field(default_factory=dict)
    episodes: int = 0
    stopped: bool = False
    refused: str | None = None
    seconds: float = 0.0


@dataclass(frozen=True)
class EpisodeSet:
    """All episodes of a trial, one by one."""

    number: int
    episodes: tuple[Episode, ...]


def evaluate(design: RobotDesign, control: dict[str, Any], task: Task, seed: int) -> Episode:
    """Metrics of one episode. Raises DesignError or StructureError for what cannot be built."""
    with closing(Setup("episode", task, control, design).robot()) as robot:
        return rollout(robot, make_controller(control), task, seed).scores()


def try_all(trial: TrialSpec) -> EpisodeSet:
    """Every episode of a trial, without a bar. Raises DesignError or StructureError."""
    results = iterate(trial.setup(), make_controller(trial.controller), trial.seeds)
    return EpisodeSet(trial.number, tuple(result.scores() for result in results))


def run_trial(trial: TrialSpec) -> TrialResult:
    """All episodes of a trial, or as many as it takes to see that it is hopeless.

    Whatever it raises is its result: one bad robot ends no search. What this package does not raise on purpose is
    named by its class.
    """
    begun = time.perf_counter()
    try:
        found = _tried(trial)
    except TensegymError as error:
        return TrialResult(trial.number, refused=str(error), seconds=time.perf_counter() - begun)
    except Exception as error:
        why = f"{type(error).__name__}: {error}"
        return TrialResult(trial.number, refused=why, seconds=time.perf_counter() - begun)
    stopped = len(found) < len(trial.seeds)
    return TrialResult(trial.number, aggregate(found), len(found), stopped, None, time.perf_counter() - begun)


def _tried(trial: TrialSpec) -> list[Episode]:
    found: list[Episode] = []
    half = math.ceil(len(trial.seeds) / 2)
    with closing(iterate(trial.setup(), make_controller(trial.controller), trial.seeds)) as results:
        for result in results:
            found.append(result.scores())
            if len(found) == half and progress_loss(trial.task, found) > trial.bar:
                break
    return found


def progress_loss(task: Task, episodes: list[Episode]) -> float:
    """How far the goal is missed by some episodes of a trial: what the bar is compared with."""
    return task.goal.violation(aggregate(episodes))
