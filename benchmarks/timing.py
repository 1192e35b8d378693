"""Timing side by side: blocks of each contestant in turn on one core, so that the machine's drift cancels in ratios."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.validation.setting import setting

PACKAGES = ("tensegym", "pybullet", "pybullet-arm64", "numba", "numpy", "mujoco", "gymnasium", "stable-baselines3",
            "torch", "exudyn")  # fmt: skip


@dataclass(frozen=True)
class Row:
    """Ours against a peer: medians in ``unit``, and median, 10th and 90th percentile of the ratio ours / peer.

    target is what the ratio is to stay under, or over where ``at_least``; None where nothing is asked.
    """

    name: str
    ours: float
    peer: float
    unit: str
    ratio: float
    spread: tuple[float, float]
    target: float | None = None
    at_least: bool = False

    @property
    def passed(self) -> bool:
        if self.target is None:
            return True
        return self.ratio >= self.target if self.at_least else self.ratio <= self.target

    def as_dict(self) -> dict[str, Any]:
        return vars(self) | {"spread": list(self.spread), "passed": self.passed}


def row(
    name: str, ours: Sequence[float], peer: Sequence[float], unit: str, target: float | None = None,
    at_least: bool = False,
) -> Row:  # fmt: skip
    """A row of paired measurements."""
    low, ratio, high = np.quantile(np.asarray(ours) / np.asarray(peer), [0.1, 0.5, 0.9]).tolist()
    return Row(name, float(np.median(ours)), float(np.median(peer)), unit, ratio, (low, high), target, at_least)


def in_turn(contestants: dict[str, Callable[[], float]], rounds: int) -> dict[str, list[float]]:
    """Call every contestant once a round; each returns what it measured."""
    seen: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(rounds):
        for name, measure in contestants.items():
            seen[name].append(measure())
    return seen


class OneCore:
    """Pins this process to the first of its cores for a while."""

    def __enter__(self) -> None:
        self.cores = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else None
        if self.cores:
            os.sched_setaffinity(0, {min(self.cores)})

    def __exit__(self, *_: object) -> None:
        if self.cores:
            os.sched_setaffinity(0, self.cores)


def machine() -> dict[str, Any]:
    """What the figures were measured on: processor, cores, load before the run, versions."""
    names = Path("/proc/cpuinfo").read_text().split("\n") if Path("/proc/cpuinfo").exists() else []
    model = next((line.split(": ")[1] for line in names if line.startswith("model name")), platform.processor())
    versions = {}
    for name in PACKAGES:
        try:
            versions[name] = version(name)
        except ModuleNotFoundError:
            continue
    return {"processor": model, "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity")
            else os.cpu_count(), "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
            "python": platform.python_version(), "versions": versions, "substeps": setting()}  # fmt: skip
