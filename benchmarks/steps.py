"""Of which steps a robot makes how many: from closed and open faces onto closed and open ones, start and winner.

    tensegym design run --task step --budget 113 --out runs/step
    python benchmarks/steps.py --folder runs/step

The three edges of a closed face are cables; an open face lacks one. Starts are those of `tensegym design report`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np
import tyro

from tensegym.cli.design import open_search
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.processes import Pool
from tensegym.report import table
from tensegym.robot.robot import TensegrityRobot
from tensegym.search.confirm import FIRST_SEED, TIME_STEP, pick
from tensegym.search.evaluate import TrialSpec, try_all
from tensegym.tasks.episode import Episode
from tensegym.tasks.step_onto import Neighbour
from tensegym.tasks.task import Task


@dataclass(frozen=True)
class Steps:
    """Share of steps that arrive, by the kinds of the two faces."""

    folder: Path
    """Folder of the search."""
    episodes: int = 100
    """Steps tried."""

    def run(self) -> str:
        problem, store = open_search(self.folder)
        finished = store.finished()
        best = pick(problem, finished, Pool(1), max(2, self.episodes // 2), skip=self.episodes)  # the report's
        task = replace(problem.task, dt=TIME_STEP, patience=problem.task.seconds)
        seeds = tuple(FIRST_SEED + i for i in range(self.episodes))
        rows = []
        for who, values in (("start", problem.space.start), (f"trial {best}", finished[best][0])):
            tables = problem.space.apply(values)
            episodes = try_all(TrialSpec(0, tables["design"], tables["controller"], task, seeds)).episodes
            kinds = kinds_of(design_from_dict(tables["design"]), task, seeds)
            for kind in sorted(set(kinds)):
                arrived = [e["arrived"] for e, k in zip(episodes, kinds, strict=True) if k == kind]
                rows.append([who, kind, len(arrived), float(np.mean(arrived))])
        return table(["design", "step", "tried", "arrived, share"], rows)


def kinds_of(design: RobotDesign, task: Task, seeds: Sequence[int]) -> list[str]:
    """Which kind of face each step begins on, and which it is to reach."""
    kinds = []
    with TensegrityRobot(design, dt=task.dt) as robot:
        for seed in seeds:
            episode = Episode(robot, task, np.random.default_rng(seed))
            both = robot.faces.closed[[episode.start.face, cast(Neighbour, episode.goal).face]]
            kinds.append(" onto ".join("closed" if closed else "open" for closed in both))
    return kinds


if __name__ == "__main__":
    print(tyro.cli(Steps).run())
