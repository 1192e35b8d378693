"""`tensegym design report`: confirm the best trials of a search and write what there is to know about it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tensegym.errors import InputError
from tensegym.report import Report, table
from tensegym.search.confirm import confirm
from tensegym.search.problem import Problem
from tensegym.search.report import goal_row, write_report
from tensegym.search.winner import ranked
from tensegym.search.workers import open_workers

from .design import open_search
from .options import MOST, Jobs, Within

_SHOWN = {"speed_lps_median": "median L/s", "speed_lps_mean": "mean L/s", "slip_share_median": "slip share",
          "drive_load_largest": "drive load", "audit_failures": "audit failures"}  # fmt: skip


@dataclass(frozen=True)
class DesignReport:
    """Confirm a search's best trials on new starts, and write report.md with figures, the best URDF and TOML."""

    folder: Path = Path("design")
    """Folder of the search."""
    episodes: Annotated[int, Within(2, MOST)] = 50
    """New starts that start and winner are tried from, at the default time step and at half of it."""
    against: tuple[Path, ...] = ()
    """Folders of other searches to compare with, such as a random one."""
    jobs: Jobs = 1
    """Processes."""
    workers: str = "local"
    """Where episodes run: local (processes of this machine), ray."""
    address: str | None = None
    """Address of a running Ray cluster."""
    storage: str | None = None
    """Database URL; default: the one it was started with."""

    def run(self) -> Report:
        problem, store = open_search(self.folder, self.storage)
        others = {}
        for folder in self.against:
            other, kept = open_search(folder)
            _check_comparable(folder, problem, other)
            others[f"{other.settings.sampler}, {folder.name}"] = (other, kept.finished())
        finished = store.finished()
        if not ranked(problem, finished):
            raise InputError(f"{self.folder} has no finished trial to report; resume it first")
        with open_workers(self.workers, self.jobs, self.address) as pool:
            confirmed = confirm(problem, finished, pool, self.episodes)
        data = write_report(self.folder, problem, store, confirmed, others)
        shown = goal_row(problem) | _SHOWN
        rows = [[name, *(column[key] for key in shown)] for name, column in data["confirmed"].items()]
        header = ["", *shown.values()]
        gains = "".join(f"\n{each['text']}" for each in data["gains"])
        bounds = "".join(f"\n{each['text']}" for each in data["constraints"])
        reached = "reached" if data["goal_met"] else "not reached"
        text = table(header, rows) + f"{gains}{bounds}\nthe goal {data['goal']} is {reached}: {data['goal_mean']:.4g}"
        return Report(f"{text}\n{self.folder / 'report.md'}", data)


def _check_comparable(folder: Path, problem: Problem, other: Problem) -> None:
    """Raise InputError for a search whose trials do something else, or are better by something else."""
    own, others = ((p.task.motion, str(p.settings.objectives[0])) for p in (problem, other))
    if own != others:
        raise InputError(f"--against {folder} is a search of the task {others[0]} for {others[1]}, this one of "
                         f"{own[0]} for {own[1]}; compare searches of one task and objective")  # fmt: skip
