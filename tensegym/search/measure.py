"""What a search may ask for: objectives as written in a task file, and the metrics of several episodes as one set."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from tensegym.errors import InputError
from tensegym.tasks.rollout import WORST_COST


@dataclass(frozen=True)
class Objective:
    """A metric to make large or small."""

    metric: str
    maximise: bool

    @classmethod
    def parse(cls, text: object) -> Objective:
        """From ``max speed_lps`` or ``min mass``. Raises InputError; whether there is such a metric the task knows."""
        words = text.split() if isinstance(text, str) else []
        if len(words) != 2 or words[0] not in ("max", "min"):
            raise InputError(f"{text!r} is no objective; write max METRIC or min METRIC")
        return cls(words[1], words[0] == "max")

    @property
    def direction(self) -> Literal["maximize", "minimize"]:
        """As Optuna calls it."""
        return "maximize" if self.maximise else "minimize"

    def __str__(self) -> str:
        return f"{'max' if self.maximise else 'min'} {self.metric}"


def aggregate(episodes: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """One set of metrics from those of several episodes: means, but the largest audit excess.

    The cost of transport is the energy of all over the weight times the way of all, at most WORST_COST. An episode
    that diverged, ended flat on the ground or broke the audit (``sound`` 0) counts as no way at all.
    """
    count = len(episodes)
    metrics = {name: math.fsum(e[name] for e in episodes) / count for name in episodes[0]}
    metrics["audit_excess"] = max(e["audit_excess"] for e in episodes)
    way = math.fsum(e["speed"] * e["duration"] for e in episodes)
    weight = episodes[0]["weight"]
    cost = math.fsum(e["energy"] for e in episodes) / (weight * way) if way > 0 else WORST_COST
    metrics["cost_of_transport"] = min(cost, WORST_COST)
    return metrics
