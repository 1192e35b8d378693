"""`tensegym design run`, `resume` and `status`: search for a design and a gait with which a motion can be made."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Any

from tensegym.design.design_file import design_from_dict
from tensegym.errors import InputError
from tensegym.files import lock_folder, write_text
from tensegym.progress import progress_bar
from tensegym.report import Report, table
from tensegym.robot.engines import check_engine
from tensegym.search.evaluate import TrialResult
from tensegym.search.loop import run_search
from tensegym.search.problem import Problem, load_problem, problem_from
from tensegym.search.store import Finished, Store, masked
from tensegym.search.winner import best_number
from tensegym.search.workers import Workers, check_workers, open_workers
from tensegym.tables import in_file, read_text
from tensegym.tasks.trials import Setup, check_setup

from .options import Count, Jobs, Seed
from .standing import tell_unless_standing

COMMANDS: dict[str, tuple[str, str]] = {
    "run": ("tensegym.cli.design:Run", "search for a design that makes a motion"),
    "resume": ("tensegym.cli.design:Resume", "go on with a search that was stopped or killed, or further"),
    "status": ("tensegym.cli.design:Status", "how far a search is, while it runs or after"),
    "report": ("tensegym.cli.design_report:DesignReport", "report.md, figures, the best design's URDF and TOML"),
}


@dataclass(frozen=True)
class _Search:
    jobs: Jobs = 1
    """Processes, or workers of a Ray cluster started here."""
    workers: str = "local"
    """Where trials run: local (processes of this machine), ray."""
    address: str | None = None
    """Address of a running Ray cluster."""
    storage: str | None = None
    """Database URL; default: study.db in the folder."""

    def _check(self) -> None:
        check_workers(self.workers, self.address)

    def _go(self, problem: Problem, store: Store, pool: Workers, budget: int, out: Path) -> Report:
        store.note("budget", budget)
        done = store.finished()
        with progress_bar(total=budget, initial=len(done), unit="trial", smoothing=0.05) as bar:
            best = max((_score(problem, o) for _, o in done.values()), default=float("-inf"))

            def progress(outcome: TrialResult) -> None:
                nonlocal best
                best = max(best, _score(problem, outcome))
                if math.isfinite(best):
                    bar.set_postfix_str(f"{problem.settings.objectives[0]}: {abs(best):.4g}", refresh=False)
                bar.update()

            run_search(problem, store, pool, budget, progress)
        return _status(problem, store, out)


@dataclass(frozen=True)
class Run(_Search):
    """Search for a design and a controller with which a task's goal is reached. A killed search goes on with resume."""

    task: str = "carry"
    """A task file by path, or a shipped one by name."""
    budget: Count = 400
    """Trials in all."""
    seed: Seed | None = None
    """Seed of the search in place of the task file's."""
    sampler: str | None = None
    """Sampler in place of the task file's: cmaes, tpe, nsga2, random."""
    engine: str | None = None
    """Physics engine in place of the task file's: pybullet, or mujoco (extra mujoco)."""
    out: Path = Path("design")
    """Folder for the study; must not hold another one."""

    def run(self) -> Report:
        self._check()
        problem = load_problem(self.task).with_settings(self.engine, seed=self.seed, sampler=self.sampler)
        check_engine(problem.task.engine)
        start = problem.space.apply(problem.space.start)
        design = design_from_dict(start["design"])
        with in_file(f"the start of {self.task}"):
            check_setup(Setup("the start", problem.task, start["controller"], design))
        with open_workers(self.workers, self.jobs, self.address) as pool, lock_folder(self.out):
            store = Store(self.out, problem, self.storage)
            write_text(self.out / "storage.txt", masked(self.storage or ""))
            tell_unless_standing(design, problem.task.engine)
            return self._go(problem, store, pool, self.budget, self.out)


@dataclass(frozen=True)
class Resume(_Search):
    """Go on with the search in a folder: what is finished is not run again, what was in flight is."""

    folder: Path = Path("design")
    """Folder of the search."""
    budget: Count | None = None
    """Trials in all; default: as before."""

    def run(self) -> Report:
        self._check()
        found, _ = open_search(self.folder, self.storage)  # where there is none, nothing is started
        check_engine(found.task.engine)
        with open_workers(self.workers, self.jobs, self.address) as pool, lock_folder(self.folder):
            problem, store = open_search(self.folder, self.storage)
            return self._go(problem, store, pool, self.budget or store.budget, self.folder)


@dataclass(frozen=True)
class Status:
    """How far a search is: trials, best so far, rate and time left."""

    folder: Path = Path("design")
    """Folder of the search."""
    storage: str | None = None
    """Database URL; default: the one it was started with."""

    def run(self) -> Report:
        problem, store = open_search(self.folder, self.storage)
        return _status(problem, store, self.folder)


def open_search(folder: Path, storage: str | None = None) -> tuple[Problem, Store]:
    """The problem and the store of a search's folder. Raises InputError or FileNotFoundError."""
    note = folder / "storage.txt"
    if folder.is_file():
        where = folder.parent if (folder.parent / "storage.txt").is_file() else "the one of `tensegym design run --out`"
        raise InputError(f"{folder} is a file, and a search is a folder; give {where}")
    if not note.is_file():
        raise FileNotFoundError(f"no search in {folder}; start one with `tensegym design run --out {folder}`")
    kept = read_text(note, "note of a search's storage", InputError)
    if storage is None and "***" in kept:
        raise InputError(f"the search in {folder} is kept at {kept}, and passwords are not: give --storage URL again")
    store = Store(folder, None, storage or kept or None)
    problem = problem_from(store.problem_text, str(folder), kept=True)
    for number, (values, outcome) in store.finished().items():
        with in_file(f"{folder}: trial {number}"):
            problem.check(values, None if outcome.refused is not None else outcome.metrics)
    return problem, store


def _score(problem: Problem, outcome: TrialResult) -> float:
    objective = problem.settings.objectives[0]
    if outcome.refused is not None or max(problem.losses(outcome.metrics)) > 0:
        return float("-inf")
    return outcome.metrics[objective.metric] * (1 if objective.maximise else -1)


def _status(problem: Problem, store: Store, folder: Path) -> Report:
    finished: Finished = store.finished()
    budget = store.budget
    data: dict[str, Any] = {
        "folder": str(folder), "trials": len(finished), "budget": budget,
        "refused": sum(o.refused is not None for _, o in finished.values()),
        "stopped_early": sum(o.stopped for _, o in finished.values()),
        **store.pace(budget),
    }  # fmt: skip
    number = best_number(problem, finished)
    objectives = problem.settings.objectives
    if number is not None:
        metrics = finished[number][1].metrics
        data |= {"best_trial": number} | {f"best_{o.metric}": metrics[o.metric] for o in objectives}
    left = data["seconds_left"]
    rows = [[data["folder"], f"{data['trials']} of {budget}", data["refused"], data["stopped_early"],
             "-" if left is None else str(timedelta(seconds=round(left))),
             "-" if number is None else number,
             *("-" if number is None else data[f"best_{o.metric}"] for o in objectives)]]  # fmt: skip
    header = ["folder", "trials", "refused", "stopped early", "time left", "best trial", *map(str, objectives)]
    return Report(table(header, rows), data)
