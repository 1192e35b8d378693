"""Robots of a kind: designs drawn at random over ranges of some of their fields, and where a design lies in those."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib import resources
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError, TensegymError
from tensegym.tables import Error, Range, as_text, mapping, one_line, parse_toml, show

from .design import RobotDesign
from .design_file import every_value
from .groups import check_own

TRIES = 100  # draws in a row that may all be refused before there is taken to be no sound design in the ranges


@dataclass(frozen=True)
class Variation:
    """Ranges over which designs vary about one of them, each under its field's name, ``group.field``."""

    ranges: Mapping[str, Range]

    def normalised(self, design: RobotDesign) -> FloatArray:
        """(v,) where a design lies in each range, -1 at low to 1 at high: what a policy sees of its robot."""
        return np.array([2 * r.part(_value(design, name)) - 1 for name, r in self.ranges.items()])

    def at(self, design: RobotDesign, parts: FloatArray) -> RobotDesign:
        """``design`` with its varied fields at parts (v,), 0 to 1, of their ranges. Raises as RobotDesign does."""
        changes: dict[str, Any] = {}
        for (name, r), part in zip(self.ranges.items(), parts, strict=True):
            _put(design, changes, name, r.value(float(part)))
        return design.with_(**changes)

    def draw(self, design: RobotDesign, rng: np.random.Generator) -> RobotDesign:
        """A random one; again where a combination of values makes no robot. Raises DesignError where none does."""
        for _ in range(TRIES):
            try:
                return self.at(design, rng.uniform(size=len(self.ranges)))
            except TensegymError as error:
                refused = error
        raise DesignError(
            one_line(f"vary: {TRIES} designs drawn from the ranges were all refused, the last one: {refused}")
        )


def parse_variation(data: Any, design: RobotDesign) -> Variation:
    """Ranges about a design, from a table or by the name of one that ships with the package.

    Args:
        data: ``{"elastic_cable.stiffness": {"low": 200.0, "high": 1000.0, "log": True}, ...}``, or "payload_body".
        design: the design that the others vary about.

    Raises:
        DesignError: a field that the design does not have, or a range that is none, by name.
    """
    table = named_ranges(data, "vary", DesignError) if isinstance(data, str) else data
    if not isinstance(table, dict) or not table:
        raise DesignError(one_line(f"vary = {show(data)} must map fields to ranges, as in "
                          '{"elastic_cable.stiffness": {"low": 200.0, "high": 800.0}}, or name some'))  # fmt: skip
    ranges = {name: Range.parse(spec, f"vary: {name}", DesignError) for name, spec in table.items()}
    for name, r in ranges.items():  # each end by itself: what only a combination breaks is found when it is drawn
        _value(design, name)
        for end in (r.low, r.high):
            changes: dict[str, Any] = {}
            _put(design, changes, name, end)
            if "." not in name:
                design.with_(**changes)
    return Variation(ranges)


def named_ranges(name: Any, where: str, error: Error) -> dict[str, Any]:
    """The table of ranges, ``group.field`` to low, high and log, that ships under a name.

    Raises ``error`` with the names there are; ``where`` says what names it.
    """
    text = (resources.files("tensegym.design") / "ranges.toml").read_text(encoding="utf-8")
    shipped = parse_toml(text, "ranges.toml", error)
    if as_text(name, where, error) not in shipped:
        raise error(one_line(f"{where} = {show(name)} names no ranges; there are {', '.join(shipped)}"))
    return mapping(shipped[name], where, error)


def _put(design: RobotDesign, changes: dict[str, Any], name: str, value: float) -> None:
    """Write a value of a field, or of a group's, into the changes of a design."""
    first, *rest = name.split(".")
    held = changes.get(first, getattr(design, first))
    if len(rest) == 2:
        changes[first] = tuple(
            replace(group, own={**group.own, rest[1]: value}) if group.name == rest[0] else group for group in held
        )
        check_own(first, next(group for group in changes[first] if group.name == rest[0]))
    else:
        changes[first] = replace(held, **{rest[0]: value}) if rest else value


def _value(design: RobotDesign, name: str) -> float:
    """Of a field by its path. Raises DesignError where a design has no such number."""
    value: Any = every_value(design)
    for key in str(name).split("."):
        value = value.get(key) if isinstance(value, dict) else None
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise DesignError(one_line(f"vary: {show(name)} is no number of the design {design.name!r}; give group.field "
                          "of one it has, such as elastic_cable.stiffness"))  # fmt: skip
    return float(value)
