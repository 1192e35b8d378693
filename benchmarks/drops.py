"""From what height a robot may fall and still roll afterwards.

    python benchmarks/drops.py --policies rolling --heights 1 2 4 8

It falls while it settles, for 5 s, and is then to roll for 20 s. It still rolls where it makes half of the speed that
the policy makes by the median on level ground, has not diverged and does not lie flat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import tyro

from tensegym.report import table
from tensegym.tasks.motions import as_task
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.trials import run_trials


@dataclass(frozen=True)
class Drops:
    """Share of episodes that still roll after a fall."""

    policies: tuple[str, ...] = ("rolling",)
    """Shipped policies or runs' folders."""
    heights: tuple[float, ...] = (0.0, 1.0, 2.0, 4.0, 8.0)
    """Fallen from [m]; the first is what the others are measured by."""
    episodes: int = 40
    """Starts a height."""
    jobs: int = 0
    """Processes; 0 for one a core."""

    def run(self) -> str:
        rows, seeds = [], range(FIRST_SEED, FIRST_SEED + self.episodes)
        for policy in self.policies:
            level = None
            for height in self.heights:
                setup = policy_setup(policy, task=as_task({"motion": "drop", "drop": height}))
                results = run_trials(setup, seeds, jobs=self.jobs, quiet=True)
                speeds = np.array([result.gait.speed_lps * result.sound for result in results])
                level = float(np.median(speeds)) if level is None else level
                rows.append([policy, height, float((speeds > level / 2).mean()), float(np.median(speeds)),
                             sum(result.diverged for result in results), sum(result.fallen for result in results),
                             sum(not result.gait.audit_passed for result in results)])  # fmt: skip
        return table(["policy", "height m", "still roll", "median L/s", "diverged", "flat", "audit"], rows)


if __name__ == "__main__":
    print(tyro.cli(Drops).run())
