"""Which of the finished trials is best: one by one, and as a Pareto front."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray

from .asker import penalised
from .problem import Problem
from .store import Finished


def ranked(problem: Problem, finished: Finished) -> list[int]:
    """Numbers of the trials by the first objective, constraints as penalties, best first.

    Refused trials are left out, those stopped early come last.
    """
    sign = -1 if problem.settings.objectives[0].maximise else 1
    tried = [n for n, (_, o) in finished.items() if o.refused is None]
    return sorted(tried, key=lambda n: (finished[n][1].stopped, sign * penalised(problem, finished[n][1].metrics), n))


def best_number(problem: Problem, finished: Finished) -> int | None:
    """Number of the best trial, or None when there is none."""
    order = ranked(problem, finished)
    return order[0] if order else None


def losses_of(problem: Problem, finished: Finished) -> tuple[list[int], FloatArray]:
    """Numbers of the trials that keep all constraints and were not stopped, and their objectives (t, m), least best."""
    kept = [n for n, (_, o) in sorted(finished.items())
            if o.refused is None and not o.stopped and max(problem.losses(o.metrics)) <= 0]  # fmt: skip
    signs = [-1.0 if o.maximise else 1.0 for o in problem.settings.objectives]
    rows = [[s * finished[n][1].metrics[o.metric] for s, o in zip(signs, problem.settings.objectives, strict=True)]
            for n in kept]  # fmt: skip
    return kept, np.reshape(rows, (len(kept), len(signs)))


def pareto(losses: FloatArray) -> list[int]:
    """Rows (t, m) that no other row is at least as good as in everything and better in something."""
    return [
        i for i, row in enumerate(losses)
        if not ((losses <= row).all(axis=1) & (losses < row).any(axis=1)).any()
    ]  # fmt: skip
