"""Confirmation: the best trials tried again from starts the search never drew, and the winner at half the time step."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tensegym.tasks.bound import Bound

from .evaluate import Episode, TrialSpec, try_all
from .problem import Problem
from .space import Tables
from .store import Finished
from .winner import ranked
from .workers import Workers

FIRST_SEED = 2**32  # a search draws its seeds below this
CHUNK = 5  # episodes that go to a worker at a time
TIME_STEP = 2e-3  # s, the environments' own


@dataclass(frozen=True)
class Confirmed:
    """number: the winner's. rows: episodes by (who, time step), where who is start or found."""

    number: int
    rows: dict[tuple[str, float], list[Episode]]


def confirm(problem: Problem, finished: Finished, workers: Workers, episodes: int, candidates: int = 5) -> Confirmed:
    """Pick the winner, then try it and the start over ``episodes`` others.

    Every episode is tried as long as the task says, however hopeless.
    """
    winner = pick(problem, finished, workers, max(2, episodes // 2), candidates, skip=episodes)
    both = {"start": problem.space.start, "found": finished[winner][0]}
    wanted = {(who, dt): problem.space.apply(v) for who, v in both.items() for dt in (TIME_STEP, TIME_STEP / 2)}
    return Confirmed(winner, over_starts(problem, wanted, episodes, 0, workers))


def pick(
    problem: Problem, finished: Finished, workers: Workers, episodes: int, candidates: int = 5, skip: int = 0
) -> int:
    """Number of the trial with the best mean over new starts, among the best ``candidates`` as searched."""
    tables = {n: problem.space.apply(finished[n][0]) for n in ranked(problem, finished)[:candidates]}
    sign = 1 if problem.settings.objectives[0].maximise else -1
    metric = problem.settings.objectives[0].metric
    rows = over_starts(problem, {(n, TIME_STEP): t for n, t in tables.items()}, episodes, skip, workers)
    return max(tables, key=lambda n: sign * float(np.mean([row[metric] for row in rows[n, TIME_STEP]])))


def over_starts(
    problem: Problem, wanted: Mapping[Any, Tables], episodes: int, skip: int, workers: Workers
) -> dict[Any, list[Episode]]:
    """Episodes of each of ``wanted``, keys ending in the time step, from seeds ``skip`` after the first on."""
    seeds = [FIRST_SEED + skip + i for i in range(episodes)]
    chunks = [tuple(seeds[i : i + CHUNK]) for i in range(0, episodes, CHUNK)]
    keys = [(key, chunk) for key in wanted for chunk in chunks]
    trials = [
        TrialSpec(i, wanted[key]["design"], wanted[key]["controller"],
              problem.task.changed(dt=key[-1], patience=problem.task.seconds), chunk)
        for i, (key, chunk) in enumerate(keys)
    ]  # fmt: skip
    results = {tried.number: tried.episodes for tried in workers.map(try_all, trials)}
    rows: dict[Any, list[Episode]] = {key: [] for key in wanted}
    for i, (key, _) in enumerate(keys):
        rows[key] += results[i]
    return rows


class Gain(NamedTuple):
    """Of the winner over the start in one metric, from the same starts: mean of the differences, its 95 % interval."""

    metric: str
    mean: float
    low: float
    high: float
    start: float

    @property
    def text(self) -> str:
        """What it says in words, as in "speed_lps is below the start's: -0.02 [-0.03, -0.01], from 0.31"."""
        side = "above" if self.low > 0 else "below" if self.high < 0 else "not to be told from"
        return (f"{self.metric} is {side} the start's: {self.mean:+.4g} [{self.low:+.4g}, {self.high:+.4g}], "
                f"from {self.start:.4g}")  # fmt: skip


def gain(start: Sequence[Episode], found: Sequence[Episode], metric: str) -> Gain:
    """Of ``found`` over ``start``, episodes in the order of the same seeds; 1.96 standard errors to either side."""
    before = np.array([row[metric] for row in start])
    apart = np.array([row[metric] for row in found]) - before
    reach = 1.96 * float(apart.std(ddof=1)) / math.sqrt(len(apart))
    mean = float(apart.mean())
    return Gain(metric, mean, mean - reach, mean + reach, float(before.mean()))


class Verdict(NamedTuple):
    """Whether a bound holds for the mean of many episodes."""

    bound: str
    mean: float
    kept: bool

    @property
    def text(self) -> str:
        """What it says in words, as in "slip_share <= 0.27 is not kept: 0.28 in the mean"."""
        return f"{self.bound} is {'kept' if self.kept else 'not kept'}: {self.mean:.4g} in the mean"


def judge(bound: Bound, rows: Sequence[Episode]) -> Verdict:
    """Of a goal or a constraint over new starts."""
    mean = float(np.mean([row[bound.metric] for row in rows]))
    return Verdict(str(bound), mean, bound.violation({bound.metric: mean}) <= 0)


def summary(rows: Sequence[Episode]) -> dict[str, float]:
    """What the report tells of many episodes."""
    speeds = np.array([row["speed_lps"] for row in rows])
    return {
        "episodes": len(rows),
        "speed_lps_median": float(np.median(speeds)),
        "speed_lps_mean": float(speeds.mean()),
        "speed_lps_low": float(np.quantile(speeds, 0.1)),
        "speed_lps_high": float(np.quantile(speeds, 0.9)),
        "slip_share_median": float(np.median([row["slip_share"] for row in rows])),
        "tips_median": float(np.median([row["tips"] for row in rows])),
        "cost_of_transport_median": float(np.median([row["cost_of_transport"] for row in rows])),
        "drive_load_largest": max(row["drive_load"] for row in rows),
        "audit_failures": sum(row["audit_excess"] > 0.01 for row in rows),
        "disqualified": sum(not row["sound"] for row in rows),
    }
