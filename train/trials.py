"""Trials of a controller: many seeded episodes, headless, over processes; the same results from any number of them."""

from __future__ import annotations

import math
import multiprocessing
import os
import sys
from collections.abc import Sequence
from queue import Empty
from typing import Any

import numpy as np
from tqdm import tqdm

from tensegym.envs.rolling import RollingEnv
from tensegym.errors import SimulationError

from .controllers import Controller

EPISODE_SECONDS = 20.0


def run_trials(
    controller: Controller, seeds: Sequence[int], *, seconds: float = EPISODE_SECONDS, jobs: int = 0,
    env: dict[str, Any] | None = None, quiet: bool = False,
) -> list[dict[str, Any]]:
    """One row of gait metrics a seed, in their order; ``env`` overrides environment arguments (dt, design)."""
    jobs = min(jobs or os.cpu_count() or 1, len(seeds))
    arguments = {**controller.env, **(env or {})}
    parts = [list(seeds)[i::jobs] for i in range(jobs)]
    with tqdm(total=len(seeds), desc=controller.name, unit="episode", file=sys.stderr, disable=quiet) as bar:
        if jobs == 1:
            rows = list(_tick(bar, _episodes(controller, arguments, parts[0], seconds)))
        else:
            context = multiprocessing.get_context("spawn")
            queue = context.Queue()
            workers = [context.Process(target=_work, args=(queue, controller, arguments, p, seconds)) for p in parts]
            for worker in workers:
                worker.start()
            try:
                rows = list(_tick(bar, (_received(queue, workers) for _ in seeds)))
            finally:
                for worker in workers:
                    worker.terminate()
                    worker.join()
    order = {seed: place for place, seed in enumerate(seeds)}
    return sorted(rows, key=lambda row: order[row["seed"]])


def _tick(bar: tqdm, rows: Any) -> Any:
    for row in rows:
        bar.update()
        yield row


def _received(queue: Any, workers: Sequence[Any]) -> Any:
    """The next row; raises what a worker raised, and SimulationError when one died without a word."""
    while True:
        dead = [worker for worker in workers if worker.exitcode]
        try:
            row = queue.get(timeout=1.0)
        except Empty:
            if dead:
                raise SimulationError(f"a trial process ended with status {dead[0].exitcode}") from None
            continue
        if isinstance(row, Exception):
            raise row
        return row


def _work(queue: Any, *args: Any) -> None:
    try:
        for row in _episodes(*args):
            queue.put(row)
    except Exception as error:
        queue.put(error)


def _episodes(controller: Controller, arguments: dict[str, Any], seeds: list[int], seconds: float) -> Any:
    env = RollingEnv(**arguments)
    try:
        episode = controller.start(env)
        for seed in seeds:
            yield run_episode(env, episode(seed), seed, seconds)
    finally:
        env.close()


def run_episode(env: RollingEnv, act: Any, seed: int, seconds: float, watch: Any = None) -> dict[str, Any]:
    """One episode from a random face and heading; returns its metrics, seed and how it ended."""
    observation, start = env.reset(seed=seed)
    info: dict[str, Any] = {}
    terminated = False
    for _ in range(math.floor(seconds / (env.substeps * env.dt) + 1e-9)):
        observation, _, terminated, _, info = env.step(act(observation))
        if watch:
            watch(env)
        if terminated:
            break
    ended = info.get("termination", "time limit")
    return {"seed": seed, "face": start["face"], "terminated": terminated, "ended": ended, **info["gait"]}


def summarise(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Median, mean with its 95 % interval (normal; None of one trial), and the counts a gait is judged by.

    The way of a trial that diverged or broke the energy audit does not count: its speed is taken as 0.
    """
    sound = np.array([row["audit_passed"] and not row["terminated"] for row in rows])
    speed = np.where(sound, [row["speed_lps"] for row in rows], 0.0)
    costs = [row["cost_of_transport"] for row in rows if row["cost_of_transport"] is not None]
    half_width = 1.96 * speed.std(ddof=1) / math.sqrt(len(speed)) if len(speed) > 1 else None
    return {
        "episodes": len(rows),
        "speed_lps_median": float(np.median(speed)),
        "speed_lps_mean": float(speed.mean()),
        "speed_lps_mean_ci95": None if half_width is None else [
            float(speed.mean() - half_width), float(speed.mean() + half_width)
        ],
        "speed_mps_median": float(np.median(np.where(sound, [row["speed"] for row in rows], 0.0))),
        "share_over_half_median": float((speed > np.median(speed) / 2).mean()),
        "slip_share_median": float(np.median([row["slip_share"] for row in rows])),
        "slip_share_sum_median": float(np.median([row["slip_share_sum"] for row in rows])),
        "tips_median": float(np.median([row["tips"] for row in rows])),
        "cost_of_transport_median": float(np.median(costs)) if costs else None,
        "audit_failures": int(sum(not row["audit_passed"] for row in rows)),
        "audit_excess_max": float(max(row["audit_excess"] for row in rows)),
        "terminated": int(sum(row["terminated"] for row in rows)),
    }
