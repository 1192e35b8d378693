"""`tensegym import`: a model of another tool becomes a design file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from tensegym.design.design_file import design_from_dict, save_design
from tensegym.errors import InputError
from tensegym.exchange import Imported, read_matrices, read_ntrt
from tensegym.files import check_file
from tensegym.report import Report
from tensegym.tables import in_file

from .build import described
from .options import Within


@dataclass(frozen=True)
class Import:
    """Read a model of another tool, say what it became and whether it stands, and write it as a design file.

    An NTRT model is one YAML file, which may name others. Matrices are three CSV files, without headers: nodes (3, n),
    and rods and cables each with -1 and 1 where its members begin and end (m, n), or as pairs of node numbers.
    """

    file: Annotated[Path, tyro.conf.Positional]
    """NTRT's YAML, or the CSV of the nodes."""
    units: str | None = None
    """Unit of length in the file: m, dm, cm, mm, in, or a number of metres. It must be given: no such file says it."""
    out: Path | None = None
    """TOML file to write."""
    rods: Path | None = None
    """CSV of the rods, with nodes in a CSV."""
    cables: Path | None = None
    """CSV of the cables, with nodes in a CSV."""
    base: Annotated[int, Within(0, 1)] | None = None
    """Number of the first node, 0 or 1, where members are pairs of numbers."""
    pretension: Annotated[float, Within(0.0, 1e4, "N")] | None = None
    """Of cables to which the file gives none [N]."""

    def run(self) -> Report:
        if self.out is not None:
            if self.out.suffix != ".toml":
                raise InputError(f"out = {str(self.out)!r} must end in .toml, as a design file does")
            check_file(self.out)
        found = self._read()
        with in_file(str(self.file)):
            design = design_from_dict(found.table)
        report = described(design)
        if self.out is not None:
            save_design(design, self.out)
        text = "\n".join([report.text, *found.notes])
        return Report(text, {**report.data, "notes": list(found.notes)})

    def _read(self) -> Imported:
        if self.file.suffix in (".yaml", ".yml"):
            return read_ntrt(self.file, self.units, self.pretension)
        if self.file.suffix != ".csv":
            raise InputError(f"file = {str(self.file)!r} ends neither in .yaml, as NTRT's models do, nor in .csv")
        if self.rods is None or self.cables is None:
            raise InputError("nodes in a CSV want --rods and --cables, the CSV files of the members")
        found = read_matrices(self.file, self.rods, self.cables, self.units, self.base)
        if self.pretension is None:
            return found
        table: dict[str, Any] = {**found.table, "elastic_cable": {"pretension": self.pretension}}
        return found._replace(table=table)
