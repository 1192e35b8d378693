"""The steepest incline climbed on starts that nobody has drawn: by a search's design, or by policies with their robots.

    tensegym design run --task climb --budget 113 --out runs/climb
    python benchmarks/inclines.py --folder runs/climb                    # the default design, the search's start, found
    python benchmarks/inclines.py --policies onboard climb steep         # each with the body it was trained on

Prints mean uphill speeds [L/s] with their standard errors. A slope is climbed at a mean of 0.05 L/s or more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import tyro
from grounds import Tried, side_by_side, tried

from tensegym.control.policy import policy_env
from tensegym.errors import InputError
from tensegym.report import table
from tensegym.search.confirm import TIME_STEP
from tensegym.search.problem import load_problem

CLIMBED = 0.05  # L/s


@dataclass(frozen=True)
class Inclines:
    """Uphill speed over slopes of the default design, a search's start and its best trial, or of policies."""

    folder: Path | None = None
    """Folder of the search."""
    policies: tuple[str, ...] = ()
    """Shipped policies or runs' folders, instead."""
    slopes: tuple[float, ...] = (0.0, 4.0, 8.0, 10.0, 12.0, 14.0, 16.0)
    """Slopes [deg]."""
    episodes: int = 24
    """Starts a slope."""
    candidates: int = 10
    """The best so many trials as searched, of which the best on other starts is taken."""

    def run(self) -> str:
        if (self.folder is None) == (not self.policies):
            raise InputError("give --folder of a search, or --policies such as onboard climb steep")
        if self.folder is not None:
            text, rows = side_by_side(self.folder, "slope", self.slopes, self.episodes, self.candidates)
            return text + "".join(
                self._steepest(who, [row[place] for row in rows])
                for place, who in enumerate(("default", "start", "found"))
            )
        climbs = {policy: [self._climb(policy, slope) for slope in self.slopes] for policy in self.policies}
        lines = [[policy, slope, *one.row] for policy, all_of in climbs.items()
                 for slope, one in zip(self.slopes, all_of, strict=True)]  # fmt: skip
        text = table(["policy", "slope deg", "L/s", "its error", "slip share", "sound"], lines)
        return text + "".join(self._steepest(policy, all_of) for policy, all_of in climbs.items())

    def _climb(self, policy: str, slope: float) -> Tried:
        """A policy up a slope, with the body, the command period and the gain that it was trained with."""
        env, task = policy_env(policy), load_problem("climb").task
        task = replace(task, slope=slope, dt=TIME_STEP, patience=task.seconds)
        controller = {"policy": policy, "gain": 1.0, "amplitudes": [0.0, 0.0], "period": env["control_period"]}
        return tried({"design": env.get("design", {}), "controller": controller}, task, self.episodes)

    def _steepest(self, who: str, speeds: list[Tried]) -> str:
        climbed = [f"{s:g} deg" for s, one in zip(self.slopes, speeds, strict=True) if one.speed >= CLIMBED]
        return f"\nsteepest at {CLIMBED:g} L/s or more, {who}: {climbed[-1] if climbed else 'none'}"


if __name__ == "__main__":
    print(tyro.cli(Inclines).run())
