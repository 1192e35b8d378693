"""How policies, the planner and the walker go where they are told: places, turns, paths, and how long they take to get
into stride.

    python benchmarks/steering.py --policies rolling steer --out benchmarks/results/steering.json
    python benchmarks/steering.py --policies agile --tasks places --dt 0.001 --no-tables --strides 0

A row is one controller at one task over the same starts, which no training draws: the median with its 95 % interval by
bootstrap, the least and the most. Trials that break the energy audit or diverge count as having done nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from tensegym.arrays import FloatArray
from tensegym.control.table import make_controller
from tensegym.files import write_text
from tensegym.report import table, to_json
from tensegym.tasks.episode import Episode
from tensegym.tasks.motions import as_task
from tensegym.tasks.policy_trials import FIRST_SEED, baseline_setups, policy_setup
from tensegym.tasks.rollout import Result, rollout
from tensegym.tasks.stride import time_to_stride
from tensegym.tasks.trials import Setup, run_trials

COLUMNS = ("median", "low", "high", "least", "most", "speed_lps", "stalled", "slip_share", "audit_failures")
TURN = {"motion": "steer", "leg_least": 5.0, "leg_most": 5.0, "seconds": 60.0}
TASKS: dict[str, tuple[dict[str, Any], str]] = {  # name: its table, and the measure that it is judged by
    "places 2 L apart, 60 s": ({"motion": "places"}, "places"),
    "places 6 L apart, 120 s": ({"motion": "places", "near": 6.0, "far": 6.0, "seconds": 120.0}, "places"),
    "turns of 90 deg every 5 s": ({**TURN, "turn_least": 90.0, "turn_most": 90.0}, "leg_speed"),
    "turns of 180 deg every 5 s": ({**TURN, "turn_least": 180.0, "turn_most": 180.0}, "leg_speed"),
    **{f"path, {shape}": ({"motion": "path", "shape": shape}, "cross_track")
       for shape in ("line", "arc", "triangle", "eight")},
}  # fmt: skip


class Way:
    """A watcher that keeps the way made along what was wanted [rod lengths], once a control step."""

    def __init__(self, period: float) -> None:
        self.period, self.way = period, [0.0]

    def __call__(self, episode: Episode) -> None:
        step = episode.robot.centre_of_mass_in_world() - episode.reading.centre
        self.way.append(self.way[-1] + float(episode.bearing.direction @ step[:2]) / episode.robot.design.length)


@dataclass(frozen=True)
class Steering:
    """Places, turns, paths and strides of policies, the planner and the walker."""

    policies: tuple[str, ...] = ("rolling",)
    """Shipped policies or runs' folders."""
    episodes: int = 100
    """Starts a task."""
    tasks: tuple[str, ...] = ()
    """Of the tasks, those whose names begin so; default: all."""
    dt: float | None = None
    """Physics time step [s], in place of the tasks' own."""
    engine: str | None = None
    """Physics engine, in place of the tasks' own."""
    tables: bool = True
    """Also the planner and the walker."""
    strides: int = 20
    """Starts from which strides are timed."""
    out: Path = Path("steering.json")
    """File to write."""

    def run(self) -> str:
        rows, strides, data = [], [], {}
        for name, (fields, measure) in TASKS.items():
            if not name.startswith(self.tasks or ""):
                continue
            for who, setup in self._setups(fields).items():
                results = run_trials(setup, range(FIRST_SEED, FIRST_SEED + self.episodes))
                row = judged(results, measure)
                data[f"{name}: {who}"] = row
                rows.append([name, who, measure, *(f"{row[key]:.3g}" for key in COLUMNS)])
                write_text(self.out, to_json(data, indent=1) + "\n")
        turn = {"motion": "steer", "leg_least": 30.0, "leg_most": 30.0, "turn_least": 90.0, "seconds": 60.0}
        for who, setup in self._setups(turn).items() if self.strides else ():
            after = np.array([stride(setup, FIRST_SEED + number) for number in range(self.strides)])
            data[f"stride: {who}"] = after.tolist()
            strides.append([who, *(f"{value:.3g}" for value in np.median(after, axis=0))])
        write_text(self.out, to_json(data, indent=1) + "\n")
        first = ["task", "who", "measure", *COLUMNS]
        second = ["who", "s after a start", "its L/s", "s after a turn", "its L/s"]
        return table(first, rows) + "\n\nmedian time to 90 % of the steady speed\n" + table(second, strides)

    def _setups(self, fields: dict[str, Any]) -> dict[str, Setup]:
        task = as_task(fields)
        setups = {policy: policy_setup(policy, task=task, dt=self.dt, engine=self.engine) for policy in self.policies}
        if self.tables:
            found = baseline_setups(policy_setup("rolling", task=task, dt=self.dt, engine=self.engine))
            setups |= {name: found[name] for name in ("planner", "open-loop walker")}
        return setups


def judged(results: Sequence[Result], measure: str) -> dict[str, float]:
    """Median of a measure with its 95 % interval, least and most; speed and stalled legs beside it."""
    values = np.array([result.measures[measure] for result in results])
    drawn = np.random.default_rng(0).choice(values, (2000, len(values)))
    low, high = np.quantile(np.median(drawn, axis=1), [0.025, 0.975])
    speeds = [result.measures.get("path_speed", result.gait.speed_lps) for result in results if result.sound]
    return {
        "median": float(np.median(values)), "low": float(low), "high": float(high), "least": float(values.min()),
        "most": float(values.max()), "speed_lps": float(np.median(speeds)) if speeds else 0.0,
        "stalled": float(np.mean([result.measures.get("stalled", 0.0) for result in results])),
        "slip_share": float(np.median([result.gait.slip_share for result in results])),
        "audit_failures": float(sum(not result.sound for result in results)),
    }  # fmt: skip


def stride(setup: Setup, seed: int) -> FloatArray:
    """(4,) seconds to stride and steady speed [L/s], after the start and after the turn at half time."""
    controller = make_controller(setup.controller)
    watcher = Way(controller.period)
    with closing(setup.robot()) as robot:
        rollout(robot, controller, setup.task, seed, watcher=watcher)
    way = np.array(watcher.way)
    half = round(30.0 / controller.period)
    if len(way) < 2 * half:  # it diverged
        return np.array([np.inf, 0.0, np.inf, 0.0])
    parts = way[: half + 1], way[half:]
    return np.concatenate([time_to_stride(part, controller.period) for part in parts])


if __name__ == "__main__":
    print(tyro.cli(Steering).run())
