"""A range of numbers: what a field may be, or what a design varies over."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .values import Error, as_number, known, one_line, show


@dataclass(frozen=True)
class Range:
    """From low to high, in equal or (``log``) in equal relative steps; an open end is not part of it."""

    low: float
    high: float
    log: bool = False
    open_low: bool = False
    open_high: bool = False

    @classmethod
    def parse(cls, table: Any, where: str, error: Error) -> Range:
        """From a table with low, high and, where wanted, log. Raises ``error``, naming it by ``where``."""
        known(table, ("low", "high", "log"), where, error)
        for end in ("low", "high"):
            if end not in table:
                raise error(one_line(f"{where} = {show(table)} must give low and high, and log or not"))
        low, high = (as_number(table[end], f"{where}.{end}", error) for end in ("low", "high"))
        log = table.get("log", False)
        if not isinstance(log, bool):
            raise error(one_line(f"{where}.log = {show(log)} must be true or false"))
        if low >= high or (log and low <= 0):
            above = ", and above 0 with log" if log else ""
            raise error(one_line(f"{where} from {low:g} to {high:g} is no range; low must be below high{above}"))
        return cls(low, high, log)

    def __contains__(self, value: float) -> bool:
        above = self.low < value if self.open_low else self.low <= value
        return above and (value < self.high if self.open_high else value <= self.high)

    def __str__(self) -> str:
        ends = "("[not self.open_low :] or "[", ")"[not self.open_high :] or "]"
        return f"{ends[0]}{self.low:g}, {self.high:g}{ends[1]}"

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
