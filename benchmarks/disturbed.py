"""What is left of a gait when the robot, its sensors and its drives are not as designed, beside other policies.

    python benchmarks/disturbed.py --policies onboard robust --out benchmarks/results/disturbed.json

A success is an episode that makes half of the policy's own undisturbed median speed. Episodes that diverge or break the
energy audit are none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from tensegym.files import write_text
from tensegym.report import table, to_json
from tensegym.tasks.disturbance import Disturbance
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.trials import Setup, run_trials

PARTS = ("stiffness", "pretension", "mass", "friction", "drive", "voltage")
NOISE = {"attitude_noise": 0.02, "attitude_bias": 0.02, "rate_noise": 0.1, "rate_bias": 0.05, "encoder_noise": 0.5,
         "encoder_bias": 0.5}  # fmt: skip
"""Of an inexpensive inertial unit, and of a spool whose cable stretches: 1.5 mm."""
FAULTS: dict[str, dict[str, Any]] = {
    "noise": NOISE,
    "one control step late": {"seen_late": 1},
    "all at 20 %, noise, late": {**dict.fromkeys(PARTS, 0.2), **NOISE, "seen_late": 1},
    "10 pushes a minute of 0.3 m/s": {"pushes": 10.0, "push": 0.3},
    "one weak drive": {"weak": 1},
    "one stuck drive": {"stuck": 1},
    "one dead drive": {"dead": 1},
    "one snapped cable": {"snapped": 1},
}


def disturbances(shares: tuple[float, ...]) -> Iterator[tuple[str, dict[str, Any]]]:
    """By name, the fields of `tensegym.tasks.disturbance.Disturbance` that are not off."""
    for what in (*PARTS, "all"):
        for share in shares:
            yield f"{what} +-{share:.0%}", dict.fromkeys(PARTS if what == "all" else [what], share)
    yield from FAULTS.items()


@dataclass(frozen=True)
class Disturbed:
    """Success of policies under each disturbance by itself, and under all together."""

    policies: tuple[str, ...] = ("onboard",)
    """Shipped policies or runs' folders, which see what sensors give."""
    shares: tuple[float, ...] = (0.1, 0.2, 0.3)
    """Of the designed values, up to which they are off."""
    only: tuple[str, ...] = ()
    """Of the rows, those whose names begin so; default: all."""
    episodes: int = 100
    """Starts a row."""
    seconds: float = 20.0
    """Length of an episode [s]."""
    jobs: int = 0
    """Processes; 0 for one a core."""
    out: Path = Path("disturbed.json")
    """File to write."""

    def run(self) -> str:
        setups = {policy: self._plain(policy) for policy in self.policies}
        plain = {policy: np.median(self._speeds(setup)) for policy, setup in setups.items()}
        data: dict[str, Any] = {"nothing": {policy: float(speed) for policy, speed in plain.items()}}
        rows = [["nothing", *(f"{speed:.3f}" for speed in plain.values())]]
        for name, fields in disturbances(self.shares):
            if not name.startswith(self.only or ""):
                continue
            data[name], row = {}, [name]
            for policy, setup in setups.items():
                task = setup.task.changed(disturb=fields)
                speeds = self._speeds(replace(setup, task=task))
                success = float((speeds >= plain[policy] / 2).mean())
                data[name][policy] = {"speed_lps_median": float(np.median(speeds)), "success": success}
                row.append(f"{np.median(speeds):.3f}, {success:.0%}")
            rows.append(row)
            write_text(self.out, to_json(data, indent=1) + "\n")
        return "median L/s and the share of episodes over half of the first row's\n" + table(
            ["off by", *self.policies], rows)  # fmt: skip

    def _plain(self, policy: str) -> Setup:
        setup = policy_setup(policy, seconds=self.seconds)
        return replace(setup, task=replace(setup.task, disturb=Disturbance()))

    def _speeds(self, setup: Setup) -> np.ndarray:
        results = run_trials(setup, range(FIRST_SEED, FIRST_SEED + self.episodes), jobs=self.jobs)
        return np.array([result.gait.speed_lps if result.sound else 0.0 for result in results])


if __name__ == "__main__":
    print(tyro.cli(Disturbed).run())
