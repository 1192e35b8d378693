"""Processes over cores beside one process and beside SubprocVecEnv, and a PPO training before and after.

Wall time: the machine has to be at rest, or other programs' share is measured.
"""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from environment import ARGUMENTS, EPISODE, ROBOTS, make_single, stepper
from stable_baselines3.common.vec_env import SubprocVecEnv, VecMonitor, VecNormalize
from timing import Row, in_turn, row

from tensegym.envs.batch import Processes
from tensegym.processes import cores
from tensegym.train.config import load_config
from tensegym.train.ppo import _new_model
from tensegym.train.vec_env import RollingVecEnv


def worker_seconds(env: RollingVecEnv) -> float:
    """Processor time that the workers of a batch have taken (proc(5): fields utime and stime)."""
    batch, ticks = env.batch, 0
    assert isinstance(batch, Processes)
    for worker in batch.workers:
        fields = Path(f"/proc/{worker.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def cores_busy(env: RollingVecEnv, seconds: float = 10.0) -> float:
    """Processor seconds of the workers a wall second while they step: the speed-up if no core slowed another down."""
    measure = stepper(env, time.perf_counter)
    measure()
    began, spent = time.perf_counter(), worker_seconds(env)
    while time.perf_counter() - began < seconds:
        measure()
    return (worker_seconds(env) - spent) / (time.perf_counter() - began)


def independent(seconds: float, ready: Any, out: Any) -> None:
    """Step one robot for so long, with nobody to wait for."""
    env = RollingVecEnv(1, EPISODE, ARGUMENTS, processes=1)
    measure = stepper(env, time.perf_counter)
    measure()
    ready.wait()
    began, steps = time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        measure()
        steps += 3
    out.put(steps / (time.perf_counter() - began))
    env.close()


def unhindered(robots: int, seconds: float = 3.0) -> float:
    """Steps a second of ``robots`` processes that have nothing to do with each other, summed."""
    context = multiprocessing.get_context("spawn")
    ready, out = context.Barrier(robots), context.Queue()
    workers = [context.Process(target=independent, args=(seconds, ready, out)) for _ in range(robots)]
    for worker in workers:
        worker.start()
    total = sum(out.get() for _ in workers)
    for worker in workers:
        worker.join()
    return total


def all_cores(rounds: int) -> Iterator[Row]:
    """Processes over cores, beside one process and beside SubprocVecEnv; and what the machine's cores give at all."""
    envs: dict[str, Any] = {
        "all": RollingVecEnv(ROBOTS, EPISODE, ARGUMENTS),
        "one": RollingVecEnv(ROBOTS, EPISODE, ARGUMENTS, processes=1),
        "subproc": SubprocVecEnv([make_single] * ROBOTS, start_method="forkserver"),
    }
    seen = in_turn({name: stepper(env, time.perf_counter) for name, env in envs.items()}, rounds)
    busy = [cores_busy(envs["all"]) for _ in range(3)]
    for env in envs.values():
        env.close()
    alone = in_turn({"two": lambda: unhindered(2), "one": lambda: unhindered(1)}, 3)
    unit, processes = "robot steps/s, wall", min(ROBOTS, cores())
    yield row(f"{processes} processes / 1", seen["all"], seen["one"], unit, 0.9 * processes, at_least=True)
    yield row(f"{processes} processes / SubprocVecEnv of {ROBOTS}", seen["all"], seen["subproc"], unit, 1.0,
              at_least=True)  # fmt: skip
    yield row(f"cores that {processes} processes keep busy / 1", busy, [1.0] * len(busy), "processor s a wall s",
              0.9 * processes, at_least=True)  # fmt: skip
    yield row("2 unrelated processes / 1: the machine's own", alone["two"], alone["one"], unit)


def training(updates: int) -> Iterator[Row]:
    """PPO with the `rolling` config: the environments' share of its time, and steps a second before and now."""
    config = load_config("rolling")
    seen: dict[str, list[tuple[float, float]]] = {"now": [], "before": []}
    for _ in range(updates):
        for name, make in (
            ("now", lambda: RollingVecEnv(config.n_envs, EPISODE, ARGUMENTS)),
            ("before", lambda: SubprocVecEnv([partial(make_single, False)] * config.n_envs, start_method="forkserver")),
        ):
            inner = make()
            waiting, step_wait = [0.0], inner.step_wait

            def timed(waiting: list[float] = waiting, step_wait: Callable = step_wait) -> Any:
                began = time.perf_counter()
                result = step_wait()
                waiting[0] += time.perf_counter() - began
                return result

            inner.step_wait = timed  # type: ignore[method-assign]
            env = VecNormalize(VecMonitor(inner), gamma=config.gamma)
            model = _new_model(config, env, 0)
            inner.reset()
            began = time.perf_counter()
            model.learn(config.rollout_steps)
            took = time.perf_counter() - began
            seen[name].append((config.rollout_steps / took, waiting[0] / took))
            inner.close()
    speed = {name: [steps for steps, _ in values] for name, values in seen.items()}
    share = [part for _, part in seen["now"]]
    yield row("PPO training now / before", speed["now"], speed["before"], "steps/s, wall")
    yield row("environments' share of a training's time", share, [1.0] * len(share), "of 1, wall", 0.6, at_least=True)


def rows(rounds: int) -> Iterator[Row]:
    """All cores, and a training."""
    yield from all_cores(rounds)
    yield from training(max(1, rounds // 10))
