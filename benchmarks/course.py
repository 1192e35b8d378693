"""Which obstacles policies pass, by name, and all in a row.

    python benchmarks/course.py --policies rolling onboard carry climb --out benchmarks/results/course.json
    python benchmarks/course.py --policies climb --obstacles incline --field incline --values 5 10 15 20

A row is one policy, with the body it was trained on, at one obstacle over starts that no training draws: the share that
passed with its 95 % interval (Wilson), how long that took, how far off the lane's middle it went, and how the others
ended. Of all in a row the table says how many got past each.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import tyro

from tensegym.files import write_text
from tensegym.report import table, to_json
from tensegym.tasks.course import ALL, Course
from tensegym.tasks.motions import as_task
from tensegym.tasks.obstacles import OBSTACLES
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.rollout import Result
from tensegym.tasks.trials import run_trials


@dataclass(frozen=True)
class Courses:
    """Shares of episodes that pass each obstacle."""

    policies: tuple[str, ...] = ("rolling", "onboard", "carry", "climb")
    """Shipped policies or runs' folders."""
    obstacles: tuple[str, ...] = (*OBSTACLES, ALL)
    """By name."""
    episodes: int = 100
    """Starts an obstacle."""
    field: str = "incline"
    """Field of the course that --values are for."""
    values: tuple[float, ...] = ()
    """Each obstacle at each of these; default: as it comes."""
    engine: str | None = None
    """Physics engine."""
    dt: float | None = None
    """Physics time step [s]."""
    jobs: int = 0
    """Processes; 0 for one a core."""
    out: Path = Path("course.json")
    """File to write."""

    def run(self) -> str:
        rows, data = [], {}
        for policy in self.policies:
            for obstacle in self.obstacles:
                for value in self.values or (None,):
                    fields = {"obstacle": obstacle} | ({} if value is None else {self.field: value})
                    task = cast(Course, as_task({"motion": "course", **fields}))
                    setup = policy_setup(policy, task=task, engine=self.engine, dt=self.dt)
                    seeds = range(FIRST_SEED, FIRST_SEED + self.episodes)
                    found = judged(run_trials(setup, seeds, jobs=self.jobs, quiet=True), task)
                    name = obstacle if value is None else f"{obstacle}, {self.field} {value:g}"
                    data[f"{Path(policy).name}: {name}"] = found
                    write_text(self.out, to_json(data, indent=1) + "\n")
                    rows.append([Path(policy).name, name, f"{found['success']:.0%}",
                                 "{:.0%} to {:.0%}".format(*found["interval"]), found["seconds"], found["cross_track"],
                                 found["unsound"], found["ends"], found["past"]])  # fmt: skip
                    print("\t".join(map(str, rows[-1])), flush=True)
        return table(["policy", "obstacle", "passed", "95 %", "s", "off L", "unsound", "ends", "past"], rows)


def judged(results: Sequence[Result], task: Course) -> dict[str, Any]:
    """Share that passed, its interval, median seconds of those, median cross-track [L], ends, shares past each."""
    passed = np.array([result.measures["passed"] for result in results])
    success = np.array([result.measures["success"] for result in results]) > 0
    seconds = [result.measures["passing_time"] for result, ok in zip(results, success, strict=True) if ok]
    off = [result.measures["cross_track"] for result in results if result.sound]
    ends = Counter("diverged" if result.diverged else result.ended for result in results)
    return {
        "success": float(success.mean()), "interval": wilson(int(success.sum()), len(success)),
        "seconds": round(float(np.median(seconds)), 1) if seconds else math.nan,
        "cross_track": round(float(np.median(off)), 2) if off else math.nan,
        "unsound": sum(not result.sound for result in results),
        "ends": ", ".join(f"{count} {end}" for end, count in ends.most_common()),
        "past": " ".join(f"{name} {(passed > number).mean():.0%}" for number, name in enumerate(task.names)),
    }  # fmt: skip


def wilson(count: int, of: int, z: float = 1.96) -> tuple[float, float]:
    """95 % interval of a share (E. B. Wilson, J. Am. Stat. Assoc. 22, 1927)."""
    share = count / of
    middle, half = share + z * z / (2 * of), z * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    return (middle - half) / (1 + z * z / of), (middle + half) / (1 + z * z / of)


if __name__ == "__main__":
    print(tyro.cli(Courses).run())
