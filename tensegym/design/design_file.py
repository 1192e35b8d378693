"""Designs in and out of TOML and plain dicts. Node numbers in files start at 1, as in the paper.

    preset = "six_rod"            # start from this design; every other line changes it
    [structure]                   # optional: rod_length and spacing [m] of the six rods, or nodes, rods, cables,
    rod_length = 0.8              # stiff_cables of any structure, or builder = "prism" (built.py)
    [elastic_cable]
    stiffness = 400.0             # SI units; `tensegym fields design` lists all fields
    [payload]                     # a section makes one; leave it out for none
    [flexure]                     # likewise: rods split by a flexure hinge
    [cables.vertical]             # a group of cables that differ; also [rods.NAME], [drives.NAME]
    pairs = [[1, 5], [2, 6]]
    stiffness = 500.0
"""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from tensegym.errors import DesignError, ShapeError
from tensegym.files import VERSION, without_version, write_text
from tensegym.structure.structure import PAPER_ROD_LENGTH, ROD_LENGTHS, WHAT_A_ROW_HOLDS, Structure, six_rod
from tensegym.tables import (
    Checked,
    as_rows,
    as_text,
    as_whole_rows,
    bounded,
    fill,
    in_file,
    known,
    mapping,
    one_line,
    read_fields,
    read_toml,
    show,
)

from .advice import advice
from .built import written_out
from .design import PRESETS, RobotDesign
from .groups import KINDS, MEMBERS, table_of

_MEMBERS = ("rods", "cables", "stiff_cables")


def as_design(value: str | Path | dict[str, Any] | RobotDesign) -> RobotDesign:
    """A design from itself, a preset's name, a TOML file's path, or a dict as a TOML file would give.

    Raises DesignError, StructureError, naming the field and its value, or FileNotFoundError.
    """
    if isinstance(value, RobotDesign):
        return value
    if isinstance(value, dict):
        return design_from_dict(value)
    if str(value).endswith(".toml"):
        return load_design(value)
    if str(value) not in PRESETS:
        names = ", ".join(PRESETS)
        raise DesignError(one_line(f"unknown preset {show(str(value))}; one of {names}, or a path that ends in .toml"))
    return PRESETS[str(value)]()


def load_design(path: str | Path) -> RobotDesign:
    """Read a TOML file. Raises as `as_design` does, naming the file."""
    data = read_toml(path, "design file", DesignError)
    with in_file(f"design file {path}"):
        try:
            return design_from_dict(data)
        except ShapeError as error:
            said = str(error).rpartition(". ")[0] or str(error)  # without what to do in general
            base = PRESETS[data.get("preset", "six_rod")]()
            data = written_out(data, base.elastic_cable)
            structure = _structure_table(_structure(data.get("structure", {}), base.structure))
            tried = advice({**data, "structure": structure}, design_from_dict)
            raise ShapeError(one_line(f"{said}; tried: {tried}")) from error


def design_from_dict(data: dict[str, Any]) -> RobotDesign:
    """Build a design from nested plain types; fields left out keep the preset's values. Raises as `as_design` does."""
    data = without_version(mapping(data, "the design", DesignError), "the design")
    data = dict(known(data, ("preset", *(f.name for f in fields(RobotDesign))), "the design", DesignError))
    preset = as_text(data.pop("preset", "six_rod"), "preset", DesignError)
    if preset not in PRESETS:
        raise DesignError(one_line(f"unknown preset {show(preset)}; one of {', '.join(PRESETS)}"))
    base, changes = PRESETS[preset](), dict[str, Any]()
    data = written_out(data, base.elastic_cable)
    if "structure" in data:
        changes["structure"] = _structure(data.pop("structure"), base.structure)
    return replace(base, **changes, **read_fields(RobotDesign, data, "", DesignError, base))


@dataclass(frozen=True)
class SixRods(Checked, error=DesignError):
    """The six-rod structure by its size."""

    rod_length: float = bounded(ROD_LENGTHS.low, ROD_LENGTHS.high, PAPER_ROD_LENGTH, "m", "of all six rods")
    spacing: float | None = bounded(ROD_LENGTHS.low, ROD_LENGTHS.high, None, "m", "of parallel rods; else half a rod")


def _structure(data: Any, base: Structure) -> Structure:
    if isinstance(data, dict) and {"rod_length", "spacing"} & data.keys():
        size = fill(SixRods, data, "structure", DesignError)
        return six_rod(size.rod_length, size.spacing)
    known(data, ("nodes", *_MEMBERS), "structure", DesignError)
    parts: dict[str, Any] = {name: getattr(base, name) for name in ("nodes", *_MEMBERS)}
    for name, value in data.items():
        where = f"structure.{name}"
        if name == "nodes":
            parts[name] = as_rows(value, 3, where, DesignError, "x, y, z in m")
        else:
            parts[name] = as_whole_rows(value, 2, where, DesignError, WHAT_A_ROW_HOLDS) - 1
    return Structure(**parts)


def _structure_table(structure: Structure) -> dict[str, Any]:
    return {"nodes": structure.nodes.tolist(), **{m: (getattr(structure, m) + 1).tolist() for m in _MEMBERS}}


def design_to_dict(design: RobotDesign) -> dict[str, Any]:
    """Plain types; `design_from_dict` gives the same design back."""
    data: dict[str, Any] = {}
    for f in fields(RobotDesign):
        value = getattr(design, f.name)
        if isinstance(value, Structure):
            data[f.name] = _structure_table(value)
        elif f.name in KINDS:
            if value:
                data[f.name] = {group.name: table_of(group) for group in value}
        elif is_dataclass(value):
            group = {g.name: getattr(value, g.name) for g in fields(value)}
            data[f.name] = {k: v for k, v in group.items() if v is not None}
        elif value is not None:
            data[f.name] = value
    return data


def every_value(design: RobotDesign) -> dict[str, Any]:
    """`design_to_dict` with what groups have of all members' values, and the lengths of rods, written out."""
    data = design_to_dict(design)
    for kind, groups in data.items():
        if kind in KINDS:
            for name, table in groups.items():
                groups[name] = {**_of_group(design, kind, table["pairs"][0]), **table}
    lengths = design.built.rod_lengths.tolist()
    passive = np.setdiff1d(np.arange(len(lengths)), design.active_rods)
    for kind, rows in (("active_rod", design.active_rods), ("passive_rod", passive)):
        if len(rows):
            data[kind].setdefault("length", lengths[rows[0]])
    return data


def _of_group(design: RobotDesign, kind: str, pair: list[int]) -> dict[str, Any]:
    """Values of the member that joins a pair of nodes, from 1."""
    rows = (getattr(design.structure, MEMBERS[kind]) + 1).tolist()
    row = next(row for row, members in enumerate(rows) if set(members) == set(pair))
    parts = {"cables": (design.each_cable,), "rods": (design.each_rod,),
             "drives": (design.each_drive, design.each_stiff_cable)}[kind]  # fmt: skip
    values = {name: value for of in parts for name, value in vars(of[row]).items() if value is not None}
    return {"length": float(design.built.rod_lengths[row]), **values} if kind == "rods" else values


def save_design(design: RobotDesign, path: str | Path) -> None:
    """Write a TOML file that `load_design` reads back to an equal design."""
    write_text(Path(path), tomli_w.dumps({"version": VERSION, **design_to_dict(design)}))
