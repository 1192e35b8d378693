"""The steepest incline that a design climbs: the default design beside the one a search found, slope by slope.

    tensegym design run --task climb --budget 401 --jobs 2 --out runs/climb
    python benchmarks/inclines.py --folder runs/climb

Prints mean uphill speeds [L/s] with their standard errors over starts that no search draws, at the environments' time
step, the same starts for both designs. The default design has the controller that the search began with. A slope is
climbed at a mean of 0.05 L/s or more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from tensegym.commands.design import open_search
from tensegym.report import table
from tensegym.search.confirm import FIRST_SEED, TIME_STEP, pick
from tensegym.search.engine import JoblibEngine
from tensegym.search.evaluate import Trial, try_all
from tensegym.search.task import Task

CLIMBED = 0.05  # L/s


@dataclass(frozen=True)
class Inclines:
    """Uphill speed over slopes of the default design and of a search's best trial on new starts."""

    folder: Path
    """Folder of the search."""
    slopes: tuple[float, ...] = (0.0, 4.0, 8.0, 10.0, 12.0, 14.0, 16.0)
    """Slopes [deg]."""
    episodes: int = 24
    """Starts a slope."""
    candidates: int = 10
    """The best so many trials as searched, of which the best on other starts is taken."""

    def run(self) -> str:
        problem, store = open_search(self.folder)
        finished = store.finished()
        best = pick(problem, finished, JoblibEngine(1), self.episodes, self.candidates, skip=self.episodes)
        found = problem.space.apply(finished[best][0])
        plain = {"design": {}, "controller": problem.space.apply(problem.space.start)["controller"]}
        rows, steepest = [], {"default": "none", "found": "none"}
        for slope in self.slopes:
            task = replace(problem.task, slope=slope, dt=TIME_STEP, patience=problem.task.seconds)
            both = {"default": self._speeds(plain, task), "found": self._speeds(found, task)}
            for who, (mean, _, _) in both.items():
                steepest[who] = f"{slope:g} deg" if mean >= CLIMBED else steepest[who]
            apart = (both["found"][0] - both["default"][0]) / np.hypot(both["found"][1], both["default"][1])
            rows.append([slope, *both["default"], *both["found"], float(apart)])
        header = ["slope deg", "default L/s", "its error", "sound", f"trial {best} L/s", "its error", "sound",
                  "difference over its error"]  # fmt: skip
        reached = ", ".join(f"{who} {slope}" for who, slope in steepest.items())
        return f"{table(header, rows)}\nsteepest at {CLIMBED:g} L/s or more: {reached}"

    def _speeds(self, tables: dict[str, Any], task: Task) -> tuple[float, float, str]:
        """Mean uphill speed [L/s], its standard error, and how many of the episodes were sound."""
        seeds = tuple(FIRST_SEED + i for i in range(self.episodes))
        episodes = try_all(Trial(0, tables["design"], tables["controller"], task, seeds)).episodes
        speeds = np.array([e["speed_lps"] for e in episodes])
        error = speeds.std(ddof=1) / np.sqrt(len(speeds))
        return float(speeds.mean()), float(error), f"{sum(e['sound'] for e in episodes):.0f} of {len(episodes)}"


if __name__ == "__main__":
    print(tyro.cli(Inclines).run())
