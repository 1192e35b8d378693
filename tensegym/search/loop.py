"""The loop: ask for a batch, evaluate what is not stored yet, store each outcome as it comes, tell, and so on."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from tensegym.errors import InputError

from .asker import Asker
from .evaluate import TrialResult, TrialSpec, run_trial
from .problem import Problem
from .space import Value
from .store import Store
from .workers import Workers

BARS_FROM = 4  # batches whose losses set the bar of the next one


def run_search(
    problem: Problem, store: Store, workers: Workers, budget: int,
    progress: Callable[[TrialResult], None] | None = None, evaluate: Callable[[TrialSpec], TrialResult] = run_trial,
) -> None:
    """Go on until ``budget`` trials are stored. Trials that are stored already are not run again.

    The trials and their values depend on the problem alone: not on where they run, on how many workers, or how often
    the search was killed in between. Raises InputError where the stored trials are not those this problem asks for.
    """
    asker, finished = Asker(problem), store.finished()
    losses: list[list[float]] = []
    number, batch = 0, 0
    while number < budget:
        asked = asker.ask()
        trials = {
            number + i: _trial(problem, number + i, batch, values, _bar(problem, losses))
            for i, values in enumerate(asked)
        }  # fmt: skip
        values_of = dict(zip(trials, asked, strict=True))
        for n in trials.keys() & finished.keys():
            if not _same(values_of[n], finished[n][0]):
                raise InputError(f"stored trial {n} is not the one this search asks for: made with other versions?")
        due = [trial for n, trial in trials.items() if n not in finished and n < budget]
        for outcome in workers.map(evaluate, due):
            store.add(asker, values_of[outcome.number], outcome)
            finished[outcome.number] = (values_of[outcome.number], outcome)
            if progress:
                progress(outcome)
        number, batch = number + len(trials), batch + 1
        if number <= budget:
            outcomes = [finished[n][1] for n in trials]
            asker.tell(outcomes)
            losses.append([problem.task.goal.violation(o.metrics) for o in outcomes if o.refused is None])


def _same(one: dict[str, Value], other: dict[str, Value]) -> bool:
    return one.keys() == other.keys() and all(
        math.isclose(one[k], other[k], rel_tol=1e-9, abs_tol=1e-12) for k in one
    )


def _bar(problem: Problem, losses: list[list[float]]) -> float:
    """The loss half way above which a trial is stopped: a quantile of those of the last batches."""
    recent = [loss for batch in losses[-BARS_FROM:] for loss in batch]
    quantile = problem.settings.stop_above
    if quantile == 1 or len(losses) <= BARS_FROM:
        return math.inf
    return float(np.quantile(recent, quantile))


def _trial(problem: Problem, number: int, batch: int, values: dict[str, Value], bar: float) -> TrialSpec:
    settings = problem.settings
    tables = problem.space.apply(values)
    key = (settings.seed, batch if settings.fresh_starts else 0)
    seeds = np.random.SeedSequence(key).generate_state(settings.episodes)
    return TrialSpec(number, tables["design"], tables["controller"], problem.task, tuple(int(s) for s in seeds), bar)
