"""How a search scales over workers: trials that only sleep, so what is left is the scheduler, storage and sampler.

    python benchmarks/design_scaling.py --seconds 1 --workers 1 4 16 64
    python benchmarks/design_scaling.py --real --workers 1 2      # evaluations of the task, in processes

Sleeping trials run as threads: they need no core, so one machine stands for a cluster of any size.
Prints, for each number of workers, trials a second against the ideal, and the processor time that storing a trial, and
asking and telling, take.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import tyro
from timing import in_turn, row

from tensegym.processes import Pool
from tensegym.report import table
from tensegym.search.asker import Asker
from tensegym.search.evaluate import TrialResult, TrialSpec, run_trial
from tensegym.search.loop import run_search
from tensegym.search.problem import load_problem
from tensegym.search.store import Store


@dataclass(frozen=True)
class Scaling:
    """Throughput of a search with an artificial evaluation time."""

    seconds: float = 1.0
    """Of one trial [s]."""
    workers: tuple[int, ...] = (1, 4, 16, 64)
    """Numbers of workers."""
    generations: int = 3
    """Batches a run, each of 64 trials, or of as many as there are workers if those are more."""
    task: str = "carry"
    """Task file, for its space and sampler."""

    real: bool = False
    """Instead: evaluate the task's start, some seconds a round, in processes; each number of workers once a round."""
    rounds: int = 5
    """Of --real."""

    def run(self) -> str:
        if self.real:
            return self._run_real()
        rows = []
        for workers in self.workers:
            problem = load_problem(self.task).with_settings(batch=max(64, workers))
            budget = 1 + (self.generations if workers >= 16 else 1) * problem.settings.batch
            with tempfile.TemporaryDirectory() as folder, Threads(workers) as pool:
                store = Timed(Path(folder), problem)
                begun = time.perf_counter()
                run_search(problem, store, pool, 1, evaluate=self._sleep)
                start = time.perf_counter() - begun
                begun = time.perf_counter()
                run_search(problem, store, pool, budget, evaluate=self._sleep)
                wall = time.perf_counter() - begun
                added = store.spent / budget
            asked = _ask_and_tell(self.task, problem.settings.batch)
            rate, ideal = (budget - 1) / wall, workers / self.seconds
            rows.append([workers, budget - 1, rate, ideal, rate / ideal, 1e3 * added, 1e3 * asked, start])
        header = ["workers", "trials", "trials/s", "ideal", "efficiency", "store ms", "ask and tell ms",
                  "one trial alone s"]  # fmt: skip
        return table(header, rows)

    def _run_real(self) -> str:
        problem = load_problem(self.task)
        tables = problem.space.apply(problem.space.start)
        trials = [TrialSpec(i, tables["design"], tables["controller"], problem.task, (i, i + 1)) for i in range(20)]
        with ExitStack() as stack:
            contestants = {}
            for workers in self.workers:
                pool = stack.enter_context(Pool(workers))
                list(pool.map(run_trial, trials[: 3 * workers]))  # imports, kernels, the policy
                contestants[str(workers)] = partial(_rate, pool, trials)
            seen = in_turn(contestants, self.rounds)
        first = seen[str(self.workers[0])]
        found = [row(name, rates, first, "trials/s") for name, rates in seen.items()]
        rows = [[r.name, r.ours, r.ratio, *r.spread] for r in found]
        return table(["workers", "trials/s", "over the first, median", "10 %", "90 %"], rows)

    def _sleep(self, trial: TrialSpec) -> TrialResult:
        time.sleep(self.seconds)
        return _told(trial.number)


def _rate(pool: Pool, trials: list[TrialSpec]) -> float:
    begun = time.perf_counter()
    list(pool.map(run_trial, trials))
    return len(trials) / (time.perf_counter() - begun)


class Threads(ThreadPoolExecutor):
    """An engine whose workers wait side by side."""

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:  # type: ignore[override]
        for done in as_completed([self.submit(function, item) for item in items]):
            yield done.result()


class Timed(Store):
    """A store that adds up the processor time its writes take."""

    spent = 0.0

    def add(self, *args: object) -> None:
        begun = time.thread_time()
        super().add(*args)  # type: ignore[arg-type]
        self.spent += time.thread_time() - begun


def _told(number: int) -> TrialResult:
    return TrialResult(number, {"speed_lps": (number * 0.618) % 1, "slip_share": 0.1, "sound": 1.0}, 1)


def _ask_and_tell(task: str, batch: int) -> float:
    """Mean processor time that the sampler takes for a trial of its second and third batch [s]."""
    asker = Asker(load_problem(task).with_settings(batch=batch))
    for repeat in range(4):
        if repeat == 2:
            begun = time.thread_time()
        asked = asker.ask()
        asker.tell([_told(i) for i in range(len(asked))])
    return (time.thread_time() - begun) / (2 * batch)


if __name__ == "__main__":
    print(tyro.cli(Scaling).run())
