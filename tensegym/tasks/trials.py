"""Trials: many seeded episodes of a controller at a task, over processes; the same results from any number of them."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from tensegym.control.controller import Controller
from tensegym.control.table import OWN, make_controller
from tensegym.design.design import RobotDesign
from tensegym.design.variation import Variation
from tensegym.processes import process_map
from tensegym.robot.robot import TensegrityRobot

from .episode import Episode, Watcher
from .rollout import Result, rollout, whole_steps
from .task import Task

CHUNK = 4  # episodes that go to a worker at a time


@dataclass(frozen=True)
class Setup:
    """What is tried, as plain data that worker processes build from.

    name: what to call it. controller: its table, see `tensegym.control.table`. vary: designs are drawn anew for each
    episode, about ``design``.
    """

    name: str
    task: Task
    controller: dict[str, Any]
    design: RobotDesign = field(default_factory=RobotDesign)
    vary: Variation | None = None

    def at(self, dt: float) -> Setup:
        """The same at another physics time step [s]."""
        return replace(self, task=self.task.changed(dt=dt))

    def robot(self, design: RobotDesign | None = None, gui: bool = False) -> TensegrityRobot:
        """A robot on the task's ground, in its engine."""
        return self.task.robot(design or self.design, gui)


def check_setup(setup: Setup) -> None:
    """Raise what building it, or putting its controller on its robot, raises; nothing is simulated but the start.

    A controller that first makes its robot's own table of tips, which takes minutes, is not put on it.
    """
    setup.task.disturb.check(setup.design)
    with closing(setup.robot()) as robot:
        controller = make_controller(setup.controller)
        whole_steps(controller.period, setup.task.dt)
        if setup.controller.get("tips") != OWN:
            episode = Episode(robot, setup.task, np.random.default_rng(0))
            controller.begin(robot, 0)
            if not episode.diverged:
                controller.angles(robot, episode.bearing)


def run_trials(setup: Setup, seeds: Sequence[int], *, jobs: int = 0, quiet: bool = False) -> list[Result]:
    """One result a seed, in their order.

    Args:
        setup: what is tried.
        seeds: one an episode; equal seeds give equal episodes.
        jobs: processes; 0 for one a core, 1 for this process alone.
        quiet: no progress bar on standard error.

    Raises:
        DesignError, FileNotFoundError: the setup does not fit together.
        WorkerDied: a worker process died again and again.
    """
    seeds = list(seeds)
    chunks = [tuple(seeds[i : i + CHUNK]) for i in range(0, len(seeds), CHUNK)]
    done: dict[int, Result] = {}
    bar = None if quiet else setup.name
    for results in process_map(partial(_episodes, setup), chunks, jobs, bar=bar, unit=f"{CHUNK} episodes"):
        done |= {result.seed: result for result in results}
    return [done[seed] for seed in seeds]


def _episodes(setup: Setup, seeds: tuple[int, ...]) -> list[Result]:
    return list(iterate(setup, make_controller(setup.controller), seeds))


def iterate(
    setup: Setup, controller: Controller, seeds: Sequence[int], watcher: Watcher | None = None
) -> Generator[Result, None, None]:
    """Episodes in turn, in this process; on one robot where it stays the same and none has diverged."""
    robot: TensegrityRobot | None = None
    disturb = setup.task.disturb
    disturb.check(setup.design)
    try:
        for seed in seeds:
            rng = np.random.default_rng(seed)
            design = setup.vary.draw(setup.design, rng) if setup.vary else setup.design
            if disturb.rebuilds:
                design, _ = disturb.draw(design, rng)
            if robot is None or setup.vary or disturb.rebuilds:
                if robot:
                    robot.close()
                robot = setup.robot(design)
            result = rollout(robot, controller, setup.task, seed, rng=rng, watcher=watcher)
            if result.diverged:  # what is left in the engine's caches may be no numbers either
                robot.close()
                robot = None
            yield result
    finally:
        if robot:
            robot.close()


def summarise(results: Sequence[Result]) -> dict[str, Any]:
    """Median, mean with its 95 % interval (normal; None of one trial), and the counts a gait is judged by.

    The way of a trial that diverged, fell flat or broke the energy audit does not count: its speed, and what the task
    measures, is taken as 0, or the worst.
    """
    gaits = [result.gait for result in results]
    sound = np.array([result.sound for result in results])
    speed = np.where(sound, [gait.speed_lps for gait in gaits], 0.0)
    costs = [gait.cost_of_transport for gait in gaits if math.isfinite(gait.cost_of_transport)]
    half_width = 1.96 * speed.std(ddof=1) / math.sqrt(len(speed)) if len(speed) > 1 else None
    return {
        "episodes": len(results),
        "speed_lps_median": float(np.median(speed)),
        "speed_lps_mean": float(speed.mean()),
        "speed_lps_mean_ci95": None if half_width is None else [
            float(speed.mean() - half_width), float(speed.mean() + half_width)
        ],
        "speed_mps_median": float(np.median(np.where(sound, [gait.speed for gait in gaits], 0.0))),
        "share_over_half_median": float((speed > np.median(speed) / 2).mean()),
        "slip_share_median": float(np.median([gait.slip_share for gait in gaits])),
        "slip_share_sum_median": float(np.median([gait.slip_share_sum for gait in gaits])),
        "stride_median": float(np.median([result.measures["stride"] for result in results])),
        "drive_load_max": float(max(result.measures["drive_load"] for result in results)),
        "peak_tension_max": float(max(gait.peak_tension for gait in gaits)),
        "tips_median": float(np.median([gait.tips for gait in gaits])),
        "cost_of_transport_median": float(np.median(costs)) if costs else None,
        "audit_failures": sum(not gait.audit_passed for gait in gaits),
        "audit_fault": next((result.fault for result in results if result.fault), None),
        "audit_excess_max": float(max(gait.audit_excess for gait in gaits)),
        "terminated": sum(result.diverged for result in results),
        "measures": {name: _spread([result.measures[name] for result in results])
                     for name in results[0].measures},
        "fallen": sum(result.fallen for result in results),
    }


def _spread(values: list[float]) -> dict[str, float]:
    return {"mean": float(np.mean(values)), "median": float(np.median(values)), "least": min(values),
            "most": max(values)}  # fmt: skip
