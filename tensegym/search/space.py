"""The search space: which fields of the design and the controller vary, and how far."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tensegym.errors import InputError

Value = float | int
Tables = dict[str, Any]  # {"design": as in a design file, "controller": as in a task file}


@dataclass(frozen=True)
class Dimension:
    """One number, or one entry of a vector field, or one of several choices.

    path: table and fields down to the value. entry: its place in a vector, or None. choices: what the number is an
    index into, for fields that take one of a few values.
    """

    path: tuple[str, ...]
    low: float
    high: float
    log: bool = False
    entry: int | None = None
    choices: tuple[Any, ...] = ()

    @property
    def name(self) -> str:
        """As in a task file; [i] behind it where it is an entry of a vector."""
        return ".".join(self.path) + ("" if self.entry is None else f"[{self.entry}]")

    def put(self, tables: Tables, value: Any) -> None:
        """Write a value into nested tables, making those on the way."""
        table = tables
        for key in self.path[:-1]:
            table = table.setdefault(key, {})
        if self.entry is None:
            table[self.path[-1]] = self.choices[int(value)] if self.choices else value
        else:
            table[self.path[-1]][self.entry] = value


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


def space_from(data: Any, tables: Tables, whole: Tables) -> Space:
    """From the [space] table of a task file.

    tables: the start design and controller as given; whole: the same with every default in it. Raises InputError
    naming the dimension that is empty, unknown or without a start inside it.
    """
    if not isinstance(data, dict) or not data:
        raise InputError("[space] is empty; give at least one field with its range, as in "
                         '"design.elastic_cable.stiffness" = {low = 200.0, high = 800.0}')  # fmt: skip
    tables, dimensions, start = copy.deepcopy(tables), [], {}
    for name, spec in data.items():
        path = tuple(name.split("."))
        if len(path) < 2 or path[0] not in ("design", "controller"):
            raise InputError(f"[space] {name!r}: a dimension is a field under design. or controller.")
        if not isinstance(spec, dict) or set(spec) - {"low", "high", "log", "spread", "choices"}:
            raise InputError(f"[space] {name!r} = {spec!r}: give low and high (and log), or spread, or choices")
        value = _value(name, path, whole)
        if isinstance(value, list | tuple) and "choices" not in spec:
            Dimension(path, 0, 0).put(tables, list(value))
            entries: list[tuple[int | None, Any]] = list(enumerate(value))
        else:
            entries = [(None, value)]
        for entry, number in entries:
            dimension, first = _dimension(name, path, spec, entry, number)
            dimensions.append(dimension)
            start[dimension.name] = first
    return Space(tuple(dimensions), tables, start)


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
    if "choices" in spec:
        choices = spec["choices"]
        if not isinstance(choices, list) or len(choices) < 2:
            raise InputError(f"[space] {name!r}: choices = {choices!r} must be a list of two or more")
        return (Dimension(path, 0, len(choices) - 1, choices=tuple(choices)),
                choices.index(value) if value in choices else 0)  # fmt: skip
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"[space] {name!r} is {value!r} in the start, no number; give choices")
    spread = spec.get("spread")
    low: Any = value - spread if isinstance(spread, int | float) else spec.get("low")
    high: Any = value + spread if isinstance(spread, int | float) else spec.get("high")
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v) for v in (low, high))
    if not numbers or low >= high:
        raise InputError(f"[space] {name!r}: the range [{low}, {high}] is empty; low must be a number below high")
    log = spec.get("log", False)
    if log and low <= 0:
        raise InputError(f"[space] {name!r}: low = {low} must be above 0 with log = true")
    return Dimension(path, float(low), float(high), bool(log), entry), float(min(max(value, low), high))
