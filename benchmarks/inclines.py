"""The steepest incline that a design climbs, from a search's folder: its start and its winner, slope by slope.

    tensegym design run --task climb --budget 301 --jobs 2 --out runs/climb
    python benchmarks/inclines.py --folder runs/climb

Prints the mean uphill speed [L/s] and its standard error over fresh starts, at the environments' time step. Reached
is a slope with a mean of 0.05 L/s or more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tyro

from tensegym.commands.design import open_search
from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP, pick
from tensegym.search.engine import JoblibEngine
from tensegym.search.evaluate import Trial, try_all

REACHED = 0.05  # L/s


@dataclass(frozen=True)
class Inclines:
    """Uphill speed over slopes of a search's start and of its best trial on new starts."""

    folder: Path
    """Folder of the search."""
    slopes: tuple[float, ...] = (0.0, 4.0, 8.0, 12.0, 16.0)
    """Slopes [deg]."""
    episodes: int = 12
    """Starts a slope."""

    def run(self) -> str:
        problem, store = open_search(self.folder)
        finished = store.finished()
        best = pick(problem, finished, JoblibEngine(1), 2 * self.episodes, candidates=10, skip=self.episodes)
        rows = []
        seeds = tuple(FIRST_SEED + i for i in range(self.episodes))
        for who, values in (("start", problem.space.start), (f"trial {best}", finished[best][0])):
            tables, reached = problem.space.apply(values), None
            for slope in self.slopes:
                task = replace(problem.task, slope=slope, dt=TIME_STEP, patience=problem.task.seconds)
                episodes = try_all(Trial(0, tables["design"], tables["controller"], task, seeds)).episodes
                speeds = [e["speed_lps"] for e in episodes]
                error = np.std(speeds, ddof=1) / np.sqrt(len(speeds))
                sound = sum(e["sound"] for e in episodes)
                rows.append([who, slope, float(np.mean(speeds)), float(error), f"{sound:.0f} of {len(speeds)}"])
                reached = slope if np.mean(speeds) >= REACHED else reached
            rows.append([who, "steepest reached", "-" if reached is None else reached, "", ""])
        return table(["design", "slope deg", "mean L/s uphill", "standard error", "sound"], rows)


if __name__ == "__main__":
    print(tyro.cli(Inclines).run())
