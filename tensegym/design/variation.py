"""Robots of a kind: designs drawn at random over ranges of some of their fields, and where a design lies in those."""

from __future__ import annotations

import math
from dataclasses import dataclass, is_dataclass, replace
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError, StructureError

from .design import RobotDesign

TRIES = 100  # draws in a row that may all be refused before there is taken to be no sound design in the ranges


@dataclass(frozen=True)
class Range:
    """Of one field of a design: ``group.field``, from low to high, in equal or (``log``) in equal relative steps."""

    field: str
    low: float
    high: float
    log: bool = False

    def value(self, part: float) -> float:
        """At a part, 0 to 1, of the way from low to high."""
        if self.log:
            return float(self.low * (self.high / self.low) ** part)
        return float(self.low + part * (self.high - self.low))

    def part(self, value: float) -> float:
        """Where a value lies, 0 to 1; outside the range, at its nearer end."""
        value = min(max(value, self.low), self.high)
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


@dataclass(frozen=True)
class Variation:
    """Ranges over which designs vary about one of them."""

    ranges: tuple[Range, ...]

    def place(self, design: RobotDesign) -> FloatArray:
        """(v,) where a design lies in each range, -1 at low to 1 at high: what a policy sees of its robot."""
        return np.array([2 * r.part(_value(design, r.field)) - 1 for r in self.ranges])

    def put(self, design: RobotDesign, parts: FloatArray) -> RobotDesign:
        """``design`` with its varied fields at parts (v,), 0 to 1, of their ranges. Raises as RobotDesign does."""
        changes: dict[str, Any] = {}
        for r, part in zip(self.ranges, parts, strict=True):
            group, name = r.field.split(".")
            changes[group] = replace(changes.get(group, getattr(design, group)), **{name: r.value(float(part))})
        return design.with_(**changes)

    def draw(self, design: RobotDesign, rng: np.random.Generator) -> RobotDesign:
        """A random one; again where a combination of values makes no robot. Raises DesignError where none does."""
        for _ in range(TRIES):
            try:
                return self.put(design, rng.uniform(size=len(self.ranges)))
            except (DesignError, StructureError) as error:
                refused = error
        raise DesignError(f"vary: {TRIES} designs drawn from the ranges were all refused, the last one: {refused}")


def variation(data: Any, design: RobotDesign) -> Variation:
    """From ``{"elastic_cable.stiffness": {"low": 200.0, "high": 1000.0, "log": True}, ...}``, about a design.

    Raises DesignError naming the field that the design does not have, or the range that is none.
    """
    if not isinstance(data, dict) or not data:
        raise DesignError(f"vary = {data!r} must map fields to ranges, as in "
                          '{"elastic_cable.stiffness": {"low": 200.0, "high": 800.0}}')  # fmt: skip
    ranges = []
    for name, spec in data.items():
        if not isinstance(spec, dict) or not {"low", "high"} <= set(spec) <= {"low", "high", "log"}:
            raise DesignError(f"vary: {name} = {spec!r} must give low and high, and log or not")
        low, high, log = spec["low"], spec["high"], spec.get("log", False)
        numbers = all(isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v) for v in (low, high))
        if not numbers or low >= high or (log and low <= 0):
            raise DesignError(f"vary: {name} from {low!r} to {high!r} is no range; low must be a number below high"
                              + (", and above 0 with log" if log else ""))  # fmt: skip
        ranges.append(Range(name, float(low), float(high), bool(log)))
        _value(design, name)
    found = Variation(tuple(ranges))
    for r in found.ranges:  # each end by itself: what only a combination breaks is found when it is drawn
        for end in (r.low, r.high):
            group, field = r.field.split(".")
            replace(getattr(design, group), **{field: end})
    return found


def _value(design: RobotDesign, name: str) -> float:
    """Of ``group.field``. Raises DesignError where a design has no such number."""
    group, _, field = name.partition(".")
    held = getattr(design, group, None)
    value = getattr(held, field, None) if is_dataclass(held) and field else None
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise DesignError(f"vary: {name!r} is no number of the design {design.name!r}; give group.field of one it has, "
                          "such as elastic_cable.stiffness")  # fmt: skip
    return float(value)
