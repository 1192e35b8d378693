"""The default design beside a search's start and what it found, over growing difficulty: inclines.py and bumps.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.cli.design import open_search
from tensegym.processes import Pool
from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP, pick
from tensegym.search.evaluate import TrialSpec, try_all
from tensegym.tasks.task import Task

POLICY = {"policy": "onboard", "gain": 1.0, "amplitudes": [0.0, 0.0]}  # the default design's controller: it alone


@dataclass(frozen=True)
class Tried:
    """Episodes of a design on one ground: mean speed [L/s], its standard error, median slip share, sound episodes."""

    speed: float
    error: float
    slip_share: float
    sound: str

    @property
    def row(self) -> tuple[float, float, float, str]:
        return self.speed, self.error, self.slip_share, self.sound


def side_by_side(
    folder: Path, field: str, values: Sequence[float], episodes: int, candidates: int
) -> tuple[str, list[tuple[Tried, Tried, Tried]]]:
    """Table over the values of a task's field, and what stands in it: the default design under the policy of level
    ground, the search's start, what it found.

    All are tried from the same starts, which no search draws, at the environments' time step, to the end of the
    episode. The found one is the best on other such starts among the best ``candidates`` trials as searched.
    """
    problem, store = open_search(folder)
    finished = store.finished()
    best = pick(problem, finished, Pool(1), episodes, candidates, skip=episodes)
    start, found = (problem.space.apply(values) for values in (problem.space.start, finished[best][0]))
    changes: list[dict[str, Any]] = [{field: v, "dt": TIME_STEP, "patience": problem.task.seconds} for v in values]
    plain = {"design": {}, "controller": POLICY}
    tasks = [replace(problem.task, **change) for change in changes]
    rows_of = [(tried(plain, t, episodes), tried(start, t, episodes), tried(found, t, episodes)) for t in tasks]
    rows = [[v, *d.row, *s.row, *f.row, float((f.speed - s.speed) / np.hypot(f.error, s.error))]
            for v, (d, s, f) in zip(values, rows_of, strict=True)]  # fmt: skip
    columns = [f"{who} {what}" for who in ("default:", "start:", f"trial {best}:")
               for what in ("L/s", "its error", "slip", "sound")]  # fmt: skip
    header = [field, *columns, "found less start, over its error"]
    return table(header, rows), rows_of


def tried(tables: dict[str, Any], task: Task, episodes: int) -> Tried:
    """A design and its controller, as tables, over new starts of a task."""
    seeds = tuple(FIRST_SEED + i for i in range(episodes))
    rows = try_all(TrialSpec(0, tables["design"], tables["controller"], task, seeds)).episodes
    speeds = np.array([e["speed_lps"] for e in rows])
    return Tried(
        float(speeds.mean()), float(speeds.std(ddof=1) / np.sqrt(len(speeds))),
        float(np.median([e["slip_share"] for e in rows])), f"{sum(e['sound'] for e in rows):.0f} of {len(rows)}",
    )  # fmt: skip
