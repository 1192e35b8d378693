"""Can the paper's robot roll with its payload? Its own nodes and two-way springs, and the form-found start of `carry`.

    python benchmarks/paper_payload.py

Speeds over new starts under the controller that `carry` starts with, at the environments' time step and half of it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import tyro

from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP, summary
from tensegym.search.evaluate import TrialSpec, try_all
from tensegym.search.problem import load_problem

COLUMNS = ("speed_lps_median", "speed_lps_mean", "tips_median", "slip_share_median", "drive_load_largest",
           "audit_failures")  # fmt: skip


@dataclass(frozen=True)
class PaperPayload:
    """The paper's robot with its payload, as printed and form-found."""

    episodes: int = 20
    """New starts."""

    def run(self) -> str:
        carry = load_problem("carry")
        start = carry.space.apply(carry.space.start)
        printed: dict[str, Any] = {"preset": "paper", "payload": {**start["design"]["payload"], "two_way": True}}
        rows = []
        for name, design in (("as printed", printed), ("form-found", start["design"])):
            for dt in (TIME_STEP, TIME_STEP / 2):
                task = replace(carry.task, dt=dt, patience=carry.task.seconds)
                seeds = tuple(FIRST_SEED + i for i in range(self.episodes))
                found = summary(try_all(TrialSpec(0, design, start["controller"], task, seeds)).episodes)
                rows.append([name, 1e3 * dt, *(found[column] for column in COLUMNS)])
        header = ["robot", "dt ms", "median L/s", "mean L/s", "tips", "slip share", "drive load", "audit failures"]
        return table(header, rows)


if __name__ == "__main__":
    print(tyro.cli(PaperPayload).run())
