"""The search space: which fields of the design and the controller vary, and how far.

    [space]
    design = "payload_body"                                 # ranges by name
    "design.elastic_cable.stiffness" = {low = 200.0, high = 800.0, log = true}
    "controller.feedback" = {spread = 1.0}                  # every entry, this far about its start
    "design.payload.two_way" = {choices = [false, true]}
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tensegym.design.variation import named_ranges
from tensegym.errors import InputError
from tensegym.tables import Range, as_number, known, one_line, show

Value = float | int
Tables = dict[str, Any]  # {"design": as in a design file, "controller": as in a task file}


@dataclass(frozen=True)
class Dimension:
    """One number, or one entry of a vector field, or one of several choices.

    path: table and fields down to the value. range: what the number may be. entry: its place in a vector, or None.
    choices: what the number is an index into, for fields that take one of a few values.
    """

    path: tuple[str, ...]
    range: Range
    entry: int | None = None
    choices: tuple[Any, ...] = ()

    @property
    def name(self) -> str:
        """As in a task file; [i] behind it where it is an entry of a vector."""
        return ".".join(self.path) + ("" if self.entry is None else f"[{self.entry}]")

    def check(self, value: Any) -> None:
        """Raises InputError for a value, stored with a trial, that is none of this dimension's."""
        number = as_number(value, self.name, InputError)
        low, high = (0, len(self.choices) - 1) if self.choices else (self.range.low, self.range.high)
        room = 0 if self.choices else 1e-9 * (high - low)
        if not low - room <= number <= high + room or (self.choices and number % 1):
            raise InputError(one_line(f"{self.name} = {show(value)} is outside [{low:g}, {high:g}]"))

    def put(self, tables: Tables, value: Any) -> None:
        """Write a value into nested tables, making those on the way."""
        if self.entry is None:
            _put(tables, self.path, self.choices[int(value)] if self.choices else value)
            return
        table: Any = tables
        for key in self.path:
            table = table[key]
        table[self.entry] = value


@dataclass(frozen=True)
class Space:
    """All dimensions, and the tables that they change. start: where the search begins, by dimension name."""

    dimensions: tuple[Dimension, ...]
    tables: Tables
    start: dict[str, Value]

    def apply(self, values: Mapping[str, Value]) -> Tables:
        """The tables with the values of all dimensions, by name, written in."""
        tables = copy.deepcopy(self.tables)
        for dimension in self.dimensions:
            dimension.put(tables, values[dimension.name])
        return tables


def written_out(data: Any) -> dict[str, Any]:
    """The [space] table of a task file with ranges that it names put in place of the name. Raises InputError."""
    if not isinstance(data, dict) or not data:
        raise InputError("[space] is empty; give at least one field with its range, as in "
                         '"design.elastic_cable.stiffness" = {low = 200.0, high = 800.0}')  # fmt: skip
    dimensions: dict[str, Any] = {}
    for name, spec in data.items():
        if name == "design":
            named = named_ranges(spec, "[space] design", InputError)
            dimensions |= {f"design.{field}": limits for field, limits in named.items()}
        else:
            dimensions[name] = spec
    return dimensions


def space_from(data: dict[str, Any], tables: Tables, whole: Tables) -> Space:
    """From the [space] table of a task file, written out.

    tables: the start design and controller as given; whole: the same with every default in it. Raises InputError
    naming the dimension that is empty, unknown or without a start inside it.
    """
    tables, dimensions, start = copy.deepcopy(tables), [], {}
    for name, spec in data.items():
        path = tuple(str(name).split("."))
        if len(path) < 2 or path[0] not in ("design", "controller"):
            raise InputError(one_line(f"[space] {show(name)}: a dimension is a field under design. or controller."))
        known(spec, ("low", "high", "log", "spread", "choices"), f"[space] {name!r}", InputError)
        value = _value(name, path, whole)
        entries: list[tuple[int | None, Any]] = [(None, value)]
        if isinstance(value, list | tuple) and "choices" not in spec:
            _put(tables, path, list(value))
            entries = list(enumerate(value))
        for entry, number in entries:
            dimension, first = _dimension(name, path, spec, entry, number)
            dimensions.append(dimension)
            start[dimension.name] = first
    return Space(tuple(dimensions), tables, start)


def _put(tables: Tables, path: tuple[str, ...], value: Any) -> None:
    """Write a value into nested tables, making those on the way."""
    for key in path[:-1]:
        tables = tables.setdefault(key, {})
    tables[path[-1]] = value


def _value(name: str, path: tuple[str, ...], whole: Tables) -> Any:
    value: Any = whole
    for key in path:
        if not isinstance(value, dict) or key not in value:
            known = ", ".join(sorted(value)) if isinstance(value, dict) else "none below it"
            raise InputError(f"[space] {name!r}: unknown field {key!r} in the start; known there: {known}")
        value = value[key]
    return value


def _dimension(
    name: str, path: tuple[str, ...], spec: dict[str, Any], entry: int | None, value: Any
) -> tuple[Dimension, Value]:
    """A dimension and where it starts."""
    where = f"[space] {name!r}"
    if "choices" in spec:
        choices = spec["choices"]
        if not isinstance(choices, list) or len(choices) < 2 or len(spec) > 1:
            raise InputError(one_line(f"{where}: choices = {show(choices)} must be a list of two or more, by itself"))
        first = choices.index(value) if value in choices else 0
        return Dimension(path, Range(0, len(choices) - 1), choices=tuple(choices)), first
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(one_line(f"{where} is {show(value)} in the start, no number; give choices"))
    if isinstance(value, int) and entry is None:  # such as a builder's number of rods
        raise InputError(f"{where} takes whole numbers; give them as choices = [{value}, {value + 1}]")
    if "spread" in spec:
        known(spec, ("spread", "log"), where, InputError)
        spread = as_number(spec["spread"], f"{where}: spread", InputError)
        spec = {**spec, "low": value - spread, "high": value + spread}
        del spec["spread"]
    limits = Range.parse(spec, where, InputError)
    return Dimension(path, limits, entry), float(min(max(value, limits.low), limits.high))
