"""How many steps the stepper makes in closed loop: onto a chosen neighbour, and to rest there; by the kinds of faces.

    python benchmarks/stands.py --out benchmarks/results/stands.json

Starts are those of `tensegym evaluate`. A direct step rests on no third face on its way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro
from course import wilson
from steps import kinds_of

from tensegym.design.design import RobotDesign
from tensegym.files import write_text
from tensegym.report import table, to_json
from tensegym.tasks.motions import as_task
from tensegym.tasks.policy_trials import FIRST_SEED
from tensegym.tasks.rollout import Result
from tensegym.tasks.trials import Setup, run_trials

SETTINGS = ((2e-3, "pybullet"), (1e-3, "pybullet"), (2e-3, "mujoco"))  # time step [s], engine
ALL = "all"


@dataclass(frozen=True)
class Stands:
    """Share of steps that arrive and rest, by the kinds of the two faces, in both engines and at half the time step."""

    episodes: int = 100
    """Steps tried in each setting."""
    around: bool = True
    """Whether the stepper may go by a third face."""
    jobs: int = 0
    """Processes; 0 for one a core."""
    out: Path = Path("stands.json")
    """File to write."""

    def run(self) -> str:
        rows, data = [], {}
        for dt, engine in SETTINGS:
            task = as_task({"motion": "stand", "dt": dt, "engine": engine})
            setup = Setup("stepper", task, {"kind": "stepper", "around": self.around})
            seeds = range(FIRST_SEED, FIRST_SEED + self.episodes)
            results = run_trials(setup, seeds, jobs=self.jobs, quiet=True)
            kinds = kinds_of(RobotDesign(), task, seeds)
            for kind in (ALL, *sorted(set(kinds))):
                some = [result for result, own in zip(results, kinds, strict=True) if kind in (ALL, own)]
                found = judged(some)
                where = f"{engine}, {1e3 * dt:g} ms"
                data[f"{where}: {kind}"] = found
                interval = "{:.2f} to {:.2f}".format(*found["interval"])
                rows.append([where, kind, found["steps"], found["arrived"], interval, found["direct"],
                             found["seconds"], found["unsound"]])  # fmt: skip
        write_text(self.out, to_json(data, indent=1) + "\n")
        return table(["engine", "step", "tried", "arrived", "95 %", "directly", "s, median", "unsound"], rows)


def judged(results: Sequence[Result]) -> dict[str, Any]:
    """Shares that arrived, with its interval (Wilson), and directly; median time of those that arrived [s]."""
    arrived = np.array([result.measures["arrived"] for result in results])
    seconds = [result.gait.duration for result in results if result.measures["arrived"]]
    return {
        "steps": len(results), "arrived": float(arrived.mean()), "interval": wilson(int(arrived.sum()), len(arrived)),
        "direct": float(np.mean([result.measures["direct"] for result in results])),
        "seconds": round(float(np.median(seconds)), 1) if seconds else float("nan"),
        "unsound": sum(not result.sound for result in results),
    }  # fmt: skip


if __name__ == "__main__":
    print(tyro.cli(Stands).run())
