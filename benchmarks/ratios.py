"""Measured ratios against the peers in this folder, as a table and as JSON: `make bench`. Needs the extra dev."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import timing
import tyro

from tensegym.cli.options import Within, check_ranges
from tensegym.errors import InputError
from tensegym.files import replace_file
from tensegym.report import Report, table, to_json

PARTS = ("substep", "flexible_rods", "environment", "processes", "startup")


@dataclass(frozen=True)
class Ratios:
    """Time what matters beside its peers, in turn in one run."""

    part: Literal["all", "substep", "flexible_rods", "environment", "processes", "startup"] = "all"
    """Which ratios; those of processes are of wall time and need a machine at rest."""
    rounds: Annotated[int, Within(1, 10_000)] = 40
    """Blocks of each contestant: the medians' and spreads' samples."""
    out: Path | None = None
    """JSON file for the rows, the machine and the versions."""

    def run(self) -> Report:
        check_ranges(self)
        if self.out and not self.out.parent.is_dir():
            raise InputError(f"--out {self.out}: there is no folder {self.out.parent}")
        machine = timing.machine()
        rows: list[Any] = []
        for part in PARTS if self.part == "all" else (self.part,):
            rows += importlib.import_module(part).rows(self.rounds)
        data = {"machine": machine, "rows": [row.as_dict() for row in rows]}
        if self.out:
            with replace_file(self.out) as file:
                file.write(to_json(data, indent=1) + "\n")
        header = ["ours / peer", "ours", "peer", "unit", "ratio", "10 to 90 %", "bound", ""]
        text = table(header, [_cells(row) for row in rows]) + f"\n{machine['substeps']}"
        return Report(text, data, passed=all(row.passed for row in rows))


def _cells(row: timing.Row) -> list[str]:
    bound = ["", ""]
    if row.target is not None:
        bound = [f"{'>=' if row.at_least else '<='} {row.target:g}", "kept" if row.passed else "missed"]
    numbers = [f"{value:.4g}" for value in (row.ours, row.peer)]
    return [row.name, *numbers, row.unit, f"{row.ratio:.3g}", "{:.3g} to {:.3g}".format(*row.spread), *bound]


if __name__ == "__main__":
    report = tyro.cli(Ratios).run()
    print(report.text)
    raise SystemExit(not report.passed)
