"""Designs in and out of TOML and plain dicts. Node numbers in files start at 1, as in the paper.

    preset = "six_rod"            # start from this design; every other line changes it
    [structure]                   # optional: rod_length and spacing [m] of the six rods, or nodes, rods, cables,
    rod_length = 0.8              # stiff_cables of any class-1 structure
    [elastic_cable]
    stiffness = 400.0             # SI units, named as the fields of tensegym.design.design
    [payload]                     # a section makes one; leave it out for none
    [flexure]                     # likewise: rods split by a flexure hinge
"""

from __future__ import annotations

import difflib
import tomllib
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from tensegym.errors import DesignError
from tensegym.files import VERSION, without_version, write_text
from tensegym.structure.structure import Structure, six_rod

from .design import PRESETS, RobotDesign
from .parameters import Drive, ElasticCable, Payload, Rod, RodFlexure, StiffCable

_GROUPS = {
    "passive_rod": Rod,
    "active_rod": Rod,
    "elastic_cable": ElasticCable,
    "stiff_cable": StiffCable,
    "drive": Drive,
    "payload": Payload,
    "flexure": RodFlexure,
}
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
    if value not in PRESETS:
        raise DesignError(f"unknown preset {str(value)!r}; one of {', '.join(PRESETS)}, or a path that ends in .toml")
    return PRESETS[str(value)]()


def load_design(path: str | Path) -> RobotDesign:
    """Read a TOML file."""
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"no design file {path}")
    try:
        data = tomllib.loads(path.read_text())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise DesignError(f"{path} is not TOML: {error}") from error
    return design_from_dict(without_version(data, path))


def design_from_dict(data: dict[str, Any]) -> RobotDesign:
    """Build a design from nested plain types; fields left out keep the preset's values."""
    data = dict(data)
    preset = data.pop("preset", "six_rod")
    if preset not in PRESETS:
        raise DesignError(f"unknown preset {preset!r}; one of {', '.join(PRESETS)}")
    base = PRESETS[preset]()
    allowed = {f.name for f in fields(RobotDesign)}
    _known("the design", data, allowed)
    changes: dict[str, Any] = {}
    for name, value in data.items():
        if name == "structure":
            changes[name] = _structure(value, base.structure)
        elif name in _GROUPS:
            changes[name] = _group(name, value, getattr(base, name))
        else:
            changes[name] = _scalar(name, value, getattr(base, name))
    return replace(base, **changes)


def _known(where: str, data: Any, allowed: set[str]) -> None:
    if not isinstance(data, dict):
        raise DesignError(f"{where} = {data!r} must be a table of fields")
    for name in data:
        if name not in allowed:
            close = difflib.get_close_matches(name, allowed, 1)
            hint = f"did you mean {close[0]!r}?" if close else f"one of {', '.join(sorted(allowed))}"
            raise DesignError(f"unknown field {name!r} in {where}; {hint}")


def _scalar(where: str, value: Any, like: Any) -> Any:
    if isinstance(like, bool) and not isinstance(value, bool):
        raise DesignError(f"{where} = {value!r} must be true or false")
    if isinstance(like, str) and not isinstance(value, str):
        raise DesignError(f"{where} = {value!r} must be a text")
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _group(name: str, data: Any, base: Any) -> Any:
    kind = _GROUPS[name]
    _known(f"[{name}]", data, {f.name for f in fields(kind)})
    base = kind() if base is None else base
    return replace(base, **{k: _scalar(f"{name}.{k}", v, getattr(base, k)) for k, v in data.items()})


def _structure(data: Any, base: Structure) -> Structure:
    if isinstance(data, dict) and set(data) & {"rod_length", "spacing"}:
        _known("[structure] with rod_length or spacing", data, {"rod_length", "spacing"})
        for name, value in data.items():
            if not (isinstance(value, int | float) and 0.01 <= value <= 100):
                raise DesignError(f"structure.{name} = {value!r} is outside [0.01, 100] m")
        return six_rod(**data)
    _known("[structure]", data, {"nodes", *_MEMBERS})
    parts = {"nodes": base.nodes, **{m: getattr(base, m) for m in _MEMBERS}}
    for name, value in data.items():
        try:
            parts[name] = np.array(value, dtype=float if name == "nodes" else np.int64) - (name != "nodes")
        except (TypeError, ValueError) as error:
            raise DesignError(f"structure.{name} must be rows of numbers: {error}") from error
    return Structure(**parts)


def design_to_dict(design: RobotDesign) -> dict[str, Any]:
    """Plain types; `design_from_dict` gives the same design back."""
    data: dict[str, Any] = {}
    for f in fields(RobotDesign):
        value = getattr(design, f.name)
        if isinstance(value, Structure):
            members = {m: (getattr(value, m) + 1).tolist() for m in _MEMBERS}
            data[f.name] = {"nodes": value.nodes.tolist(), **members}
        elif is_dataclass(value):
            group = {g.name: getattr(value, g.name) for g in fields(value)}
            data[f.name] = {k: v for k, v in group.items() if v is not None}
        elif value is not None:
            data[f.name] = value
    return data


def save_design(design: RobotDesign, path: str | Path) -> None:
    """Write a TOML file that `load_design` reads back to an equal design."""
    write_text(Path(path), tomli_w.dumps({"version": VERSION, **design_to_dict(design)}))
