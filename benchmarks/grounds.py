"""The default design beside the one a search found, over grounds of growing difficulty: inclines.py and bumps.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.commands.design import open_search
from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP, pick
from tensegym.search.engine import JoblibEngine
from tensegym.search.evaluate import Trial, try_all
from tensegym.search.task import Task

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
) -> tuple[str, list[tuple[Tried, Tried]]]:
    """Table over the values of a task's field, and what stands in it: the default design's row beside the found one's.

    Both are tried from the same starts, which no search draws, at the environments' time step, to the end of the
    episode. The found one is the best on other such starts among the best ``candidates`` trials as searched.
    """
    problem, store = open_search(folder)
    finished = store.finished()
    best = pick(problem, finished, JoblibEngine(1), episodes, candidates, skip=episodes)
    found = problem.space.apply(finished[best][0])
    changes: list[dict[str, Any]] = [{field: v, "dt": TIME_STEP, "patience": problem.task.seconds} for v in values]
    plain = {"design": {}, "controller": POLICY}
    tasks = [replace(problem.task, **change) for change in changes]
    both = [(_tried(plain, task, episodes), _tried(found, task, episodes)) for task in tasks]
    rows = [[v, *d.row, *f.row, float((f.speed - d.speed) / np.hypot(f.error, d.error))]
            for v, (d, f) in zip(values, both, strict=True)]  # fmt: skip
    header = [field, *(f"{who} {what}" for who in ("default:", f"trial {best}:")
                       for what in ("L/s", "its error", "slip", "sound")), "difference over its error"]  # fmt: skip
    return table(header, rows), both


def _tried(tables: dict[str, Any], task: Task, episodes: int) -> Tried:
    seeds = tuple(FIRST_SEED + i for i in range(episodes))
    tried = try_all(Trial(0, tables["design"], tables["controller"], task, seeds)).episodes
    speeds = np.array([e["speed_lps"] for e in tried])
    return Tried(
        float(speeds.mean()), float(speeds.std(ddof=1) / np.sqrt(len(speeds))),
        float(np.median([e["slip_share"] for e in tried])), f"{sum(e['sound'] for e in tried):.0f} of {len(tried)}",
    )  # fmt: skip
