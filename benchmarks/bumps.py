"""How fast a task's start design crosses bumps of growing height.

    python benchmarks/bumps.py

Episodes are as in the task, on seeds no search draws, and none is given up early.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import tyro

from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP
from tensegym.search.evaluate import Trial, try_all
from tensegym.search.problem import load_problem


@dataclass(frozen=True)
class Bumps:
    """Speed over root mean square heights of the ground."""

    task: str = "cross"
    """Task by name or file."""
    roughness: tuple[float, ...] = (0.0, 0.02, 0.05, 0.08)
    """Heights [m]."""
    episodes: int = 12
    """Starts a height."""

    def run(self) -> str:
        problem, rows = load_problem(self.task), []
        tables = problem.space.apply(problem.space.start)
        seeds = tuple(FIRST_SEED + i for i in range(self.episodes))
        for height in self.roughness:
            task = replace(problem.task, roughness=height, dt=TIME_STEP, patience=problem.task.seconds)
            tried = try_all(Trial(0, tables["design"], tables["controller"], task, seeds)).episodes
            speeds = [e["speed_lps"] for e in tried]
            rows.append([height, float(np.mean(speeds)), float(np.std(speeds, ddof=1) / np.sqrt(len(speeds))),
                         float(np.median([e["slip_share"] for e in tried])), float(np.mean([e["tips"] for e in tried])),
                         f"{sum(e['sound'] for e in tried):.0f} of {len(tried)}"])  # fmt: skip
        return table(["roughness m", "mean L/s", "standard error", "slip share, median", "tips, mean", "sound"], rows)


if __name__ == "__main__":
    print(tyro.cli(Bumps).run())
