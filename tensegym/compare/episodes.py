"""A policy's episodes in both engines, from the same starts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.rollout import Result
from tensegym.tasks.trials import run_trials

from .part import ENGINES, Part

SPEED, SLIP = 0.1, 0.05  # the median's relative difference, the slip share's difference that count as agreement
DRAWS = 2000  # of the bootstrap


def episodes(policy: str, count: int, seconds: float, jobs: int = 0) -> Part:
    """Median speed with its 95 % interval (bootstrap), slip share and tips of each engine.

    Raises as `policy_setup` and `run_trials`.
    """
    results = {}
    for engine in ENGINES:
        setup = policy_setup(policy, seconds=seconds, engine=engine)
        results[engine] = run_trials(setup, range(FIRST_SEED, FIRST_SEED + count), jobs=jobs)
    speeds = {engine: np.array([r.gait.speed_lps if r.sound else 0.0 for r in found])
              for engine, found in results.items()}  # fmt: skip
    slips = {engine: float(np.median([r.gait.slip_share for r in found])) for engine, found in results.items()}
    one, other = (float(np.median(speeds[engine])) for engine in ENGINES)
    ratio, low, high = _ratio(*speeds.values())
    agrees = abs(ratio - 1) <= SPEED and abs(slips[ENGINES[1]] - slips[ENGINES[0]]) <= SLIP
    within = "holds 1: what differs is the draw of episodes" if low <= 1 <= high else "leaves 1 out: it is the engines"
    verdict = (f"{policy}: median {other:.3f} L/s in MuJoCo, {one:.3f} in PyBullet, a ratio of {ratio:.3f} whose 95 % "
               f"interval [{low:.2f}, {high:.2f}] {within}.")  # fmt: skip
    rows = [[policy, engine, *_row(speeds[engine], results[engine], slips[engine])] for engine in ENGINES]
    header = ["policy", "engine", "median L/s", "95 %", "mean L/s", "slip share", "tips", "sound"]
    curves = {"ratio": [ratio, low, high], **{f"{engine}_lps": s.tolist() for engine, s in speeds.items()}}
    return Part("episodes", header, rows, agrees, verdict, curves)


def _row(speeds: Any, results: Sequence[Result], slip: float) -> list[Any]:
    low, high = np.quantile(_medians(speeds), [0.025, 0.975])
    tips = float(np.median([result.gait.tips for result in results]))
    sound = f"{sum(result.sound for result in results)} of {len(results)}"
    return [float(np.median(speeds)), f"[{low:.3f}, {high:.3f}]", float(speeds.mean()), slip, tips, sound]


def _medians(speeds: Any, seed: int = 0) -> Any:
    rng = np.random.default_rng(seed)
    return np.median(speeds[rng.integers(len(speeds), size=(DRAWS, len(speeds)))], axis=1)


def _ratio(one: Any, other: Any) -> tuple[float, float, float]:
    """Of the medians, the second over the first, and its 95 % interval."""
    base = _medians(one, 0)
    low, high = np.quantile(_medians(other, 1) / np.where(base == 0, np.nan, base), [0.025, 0.975])
    median = float(np.median(one))
    return float(np.median(other)) / median if median else float("nan"), float(low), float(high)
