"""Searches side by side: the best so far by sampler over seeds, or the hypervolume where there are several objectives.

    python benchmarks/design_compare.py --folders runs/carry-cmaes-* runs/carry-random-*
    tensegym design run --task benchmarks/samplers.toml --sampler tpe --seed 0 --budget 401 --out runs/tpe-0 # and so on
    python benchmarks/design_compare.py --folders runs/cmaes-* runs/tpe-* runs/random-* --episodes 20

Compares at the number of trials that all have. Refused, stopped and out-of-constraint trials count as trials but never
as the best. Hypervolumes are of objectives scaled so that the worst and best of all searches are 1 and 0.

With --episodes the best is not the one as searched, which flatters whoever has the luckiest starts, but the mean of the
first objective's winner over as many starts that no search drew.

Intervals are of 95 % over seeds: Student's of a sampler's mean, Welch's of its difference from random search.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro
from optuna._hypervolume import compute_hypervolume
from scipy import stats

from tensegym.cli.design import open_search
from tensegym.processes import Pool
from tensegym.report import table
from tensegym.search.confirm import TIME_STEP, over_starts, pick
from tensegym.search.problem import Problem
from tensegym.search.store import Finished
from tensegym.search.winner import losses_of, pareto


@dataclass(frozen=True)
class Compare:
    """Median and spread over seeds, sampler by sampler."""

    folders: tuple[Path, ...]
    """Folders of searches of one task with different samplers and seeds."""
    trials: int | None = None
    """Trials to compare at; default: as many as all have."""
    episodes: int = 0
    """New starts that each search's winner is tried from, picked as `tensegym design report` does; 0: as searched."""
    jobs: int = 1
    """Processes."""

    def run(self) -> str:
        searches = []
        for folder in self.folders:
            problem, store = open_search(folder)
            searches.append((problem, store.finished()))
        budget = self.trials or min(len(finished) for _, finished in searches)
        losses = [losses_of(p, {n: t for n, t in f.items() if n < budget})[1] for p, f in searches]
        everything = np.concatenate(losses)
        low, high = everything.min(axis=0), everything.max(axis=0)
        objectives = searches[0][0].settings.objectives
        several = len(objectives) > 1 and not self.episodes
        by_sampler: dict[str, list[float]] = {}
        for (problem, finished), rows in zip(searches, losses, strict=True):
            if self.episodes:
                score = self._confirmed(problem, {n: t for n, t in finished.items() if n < budget})
            elif several:
                scaled = (rows - low) / np.maximum(high - low, 1e-12)
                score = float(compute_hypervolume(scaled[pareto(scaled)], np.ones(len(objectives))))
            else:
                score = float(rows.min()) * (-1 if objectives[0].maximise else 1)
            by_sampler.setdefault(problem.settings.sampler, []).append(score)
        what = "hypervolume" if several else str(objectives[0])
        what += f" over {self.episodes} new starts" if self.episodes else ""
        random = by_sampler.get("random")
        lines = [[name, len(v), budget, float(np.median(v)), min(v), max(v), *_mean(v), *_beyond(v, random)]
                 for name, v in by_sampler.items()]  # fmt: skip
        return table(["sampler", "seeds", "trials", f"{what}, median", "least", "most", "mean", "95 %",
                      "less random's", "95 %"], lines)  # fmt: skip

    def _confirmed(self, problem: Problem, finished: Finished) -> float:
        with Pool(self.jobs) as engine:
            best = pick(problem, finished, engine, max(2, self.episodes // 2), skip=self.episodes)
            rows = over_starts(problem, {(best, TIME_STEP): problem.space.apply(finished[best][0])}, self.episodes,
                               0, engine)  # fmt: skip
        return float(np.mean([row[problem.settings.objectives[0].metric] for row in rows[best, TIME_STEP]]))


def _mean(scores: list[float]) -> tuple[float, str]:
    """Mean over seeds, and its interval."""
    return float(np.mean(scores)), _interval(scores)


def _beyond(scores: list[float], random: list[float] | None) -> tuple[float | str, str]:
    """Mean less that of random search, and its interval."""
    if random is None or random is scores:
        return "-", "-"
    return float(np.mean(scores) - np.mean(random)), _interval(scores, random)


def _interval(scores: list[float], others: list[float] | None = None) -> str:
    if min(len(scores), len(others or scores)) < 2:
        return "-"
    test = stats.ttest_1samp(scores, 0.0) if others is None else stats.ttest_ind(scores, others, equal_var=False)
    low, high = test.confidence_interval(0.95)
    return f"[{low:.3f}, {high:.3f}]"


if __name__ == "__main__":
    print(tyro.cli(Compare).run())
