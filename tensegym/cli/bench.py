"""`tensegym bench`: measured ratios against the peers in benchmarks/, as a table and as JSON."""

from __future__ import annotations

import importlib
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from tensegym.errors import InputError
from tensegym.report import Report, table

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"
PARTS = ("substep", "flexible_rods", "environment", "processes", "startup")


@dataclass(frozen=True)
class Bench:
    """Time what matters beside its peers, in turn in one run; needs a checkout and the extras train and dev."""

    part: Literal["all", "substep", "flexible_rods", "environment", "processes", "startup"] = "all"
    """Which ratios; those of processes are of wall time and need a machine at rest."""
    rounds: int = 40
    """Blocks of each contestant: the medians' and spreads' samples."""
    out: Path | None = None
    """JSON file for the rows, the machine and the versions."""

    def run(self) -> Report:
        if not (FOLDER / "timing.py").is_file():
            raise InputError(f"no benchmarks at {FOLDER}: tensegym bench runs from a checkout of the sources")
        if self.rounds < 1:
            raise InputError(f"rounds = {self.rounds} must be 1 or more")
        if self.out and not self.out.parent.is_dir():
            raise InputError(f"--out {self.out}: there is no folder {self.out.parent}")
        sys.path.insert(0, str(FOLDER))
        timing = importlib.import_module("timing")
        machine = timing.machine()
        rows: list[Any] = []
        for part in PARTS if self.part == "all" else (self.part,):
            rows += importlib.import_module(part).rows(self.rounds)
        data = {"machine": machine, "rows": [row.as_dict() for row in rows]}
        if self.out:
            self.out.write_text(json.dumps(data, indent=1) + "\n")
        header = ["ours / peer", "ours", "peer", "unit", "ratio", "10 to 90 %", "asked", ""]
        return Report(table(header, [_cells(row) for row in rows]), data, passed=all(row.passed for row in rows))


def _cells(row: Any) -> list[str]:
    asked = [] if row.target is None else [f"{'>=' if row.at_least else '<='} {row.target:g}",
                                           "met" if row.passed else "missed"]  # fmt: skip
    numbers = [f"{value:.4g}" for value in (row.ours, row.peer)]
    return [row.name, *numbers, row.unit, f"{row.ratio:.3g}", "{:.3g} to {:.3g}".format(*row.spread),
            *(asked or ["", ""])]  # fmt: skip
