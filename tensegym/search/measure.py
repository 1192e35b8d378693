"""What a search may ask for: metrics by name, bounds on them and objectives, as written in a task file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Literal

from tensegym.errors import InputError
from tensegym.robot.gait import GaitMetrics

METRICS = (*(f.name for f in fields(GaitMetrics)), "arrived", "drive_load", "mass")
WORST_COST = 1e3  # what an infinite cost of transport counts as in a mean or an objective


def known_metric(name: str) -> str:
    """``name`` itself; raises InputError where no metric has it."""
    if name not in METRICS:
        raise InputError(f"no metric measures {name!r}; one of {', '.join(METRICS)}")
    return name


@dataclass(frozen=True)
class Bound:
    """A metric kept on one side of a limit: a goal or a constraint."""

    metric: str
    at_least: bool
    limit: float

    @classmethod
    def parse(cls, text: object) -> Bound:
        """From ``speed_lps >= 0.2`` or ``slip_share <= 0.3``. Raises InputError."""
        match = re.fullmatch(r"\s*(\w+)\s*(>=|<=)\s*(\S+)\s*", text) if isinstance(text, str) else None
        try:
            limit = float(match[3]) if match else math.nan
        except ValueError:
            limit = math.nan
        if not match or not math.isfinite(limit):
            raise InputError(f"{text!r} is no bound; write METRIC >= NUMBER or METRIC <= NUMBER")
        return cls(known_metric(match[1]), match[2] == ">=", limit)

    def violation(self, metrics: Mapping[str, float]) -> float:
        """How far on the wrong side, in units of the limit (of 1 where the limit is smaller); 0 or less is kept."""
        short = self.limit - metrics[self.metric] if self.at_least else metrics[self.metric] - self.limit
        return short / max(abs(self.limit), 1e-9) if self.limit else short

    def __str__(self) -> str:
        return f"{self.metric} {'>=' if self.at_least else '<='} {self.limit:g}"


@dataclass(frozen=True)
class Objective:
    """A metric to make large or small."""

    metric: str
    maximise: bool

    @classmethod
    def parse(cls, text: object) -> Objective:
        """From ``max speed_lps`` or ``min mass``. Raises InputError."""
        words = text.split() if isinstance(text, str) else []
        if len(words) != 2 or words[0] not in ("max", "min"):
            raise InputError(f"{text!r} is no objective; write max METRIC or min METRIC")
        return cls(known_metric(words[1]), words[0] == "max")

    @property
    def direction(self) -> Literal["maximize", "minimize"]:
        """As Optuna calls it."""
        return "maximize" if self.maximise else "minimize"

    def __str__(self) -> str:
        return f"{'max' if self.maximise else 'min'} {self.metric}"


def aggregate(episodes: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """One set of metrics from those of several episodes: means, but the largest audit excess.

    The cost of transport is the energy of all over the weight times the way of all, at most WORST_COST. An episode
    that diverged or broke the audit (``sound`` 0) counts as no way at all.
    """
    count = len(episodes)
    metrics = {name: math.fsum(e[name] for e in episodes) / count for name in episodes[0]}
    metrics["audit_excess"] = max(e["audit_excess"] for e in episodes)
    way = math.fsum(e["speed"] * e["duration"] for e in episodes)
    weight = episodes[0]["weight"]
    cost = math.fsum(e["energy"] for e in episodes) / (weight * way) if way > 0 else WORST_COST
    metrics["cost_of_transport"] = min(cost, WORST_COST)
    return metrics
