"""Bound: a metric kept on one side of a limit, as a goal or a constraint."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from tensegym.errors import InputError


@dataclass(frozen=True)
class Bound:
    """A metric kept on one side of a limit."""

    metric: str
    at_least: bool
    limit: float

    @classmethod
    def parse(cls, text: object) -> Bound:
        """From ``speed_lps >= 0.2`` or ``slip_share <= 0.3``.

        Raises:
            InputError: the text is no bound. Whether there is such a metric is the task's to say.
        """
        match = re.fullmatch(r"\s*(\w+)\s*(>=|<=)\s*(\S+)\s*", text) if isinstance(text, str) else None
        try:
            limit = float(match[3]) if match else math.nan
        except ValueError:
            limit = math.nan
        if not match or not math.isfinite(limit):
            raise InputError(f"{str(text)[:100]!r} is no bound; write METRIC >= NUMBER or METRIC <= NUMBER")
        return cls(match[1], match[2] == ">=", limit)

    def violation(self, metrics: Mapping[str, float]) -> float:
        """How far on the wrong side, in units of the limit (of 1 where the limit is 0); 0 or less is kept."""
        short = self.limit - metrics[self.metric] if self.at_least else metrics[self.metric] - self.limit
        return short / max(abs(self.limit), 1e-9) if self.limit else short

    def __str__(self) -> str:
        return f"{self.metric} {'>=' if self.at_least else '<='} {self.limit:g}"
