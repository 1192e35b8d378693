"""Processes over cores beside one process and beside SubprocVecEnv, and a PPO training before and after.

Wall time: the machine has to be at rest, or other programs' share is measured.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from environment import ARGUMENTS, EPISODE, ROBOTS, make_single, stepper
from stable_baselines3.common.vec_env import SubprocVecEnv, VecEnv, VecMonitor, VecNormalize
from timing import Row, in_turn, row

from tensegym.envs.batch import cores
from tensegym.train.config import load_config
from tensegym.train.ppo import _new_model
from tensegym.train.vec_env import RollingVecEnv


def all_cores(rounds: int) -> Iterator[Row]:
    """Processes over cores, beside one process and beside SubprocVecEnv."""
    envs: dict[str, VecEnv] = {
        "all": RollingVecEnv(ROBOTS, EPISODE, ARGUMENTS),
        "one": RollingVecEnv(ROBOTS, EPISODE, ARGUMENTS, processes=1),
        "subproc": SubprocVecEnv([make_single] * ROBOTS, start_method="forkserver"),
    }
    seen = in_turn({name: stepper(env, time.perf_counter) for name, env in envs.items()}, rounds)
    for env in envs.values():
        env.close()
    unit, processes = "robot steps/s, wall", min(ROBOTS, cores())
    yield row(f"{processes} processes / 1", seen["all"], seen["one"], unit, 0.9 * processes, at_least=True)
    yield row(f"{processes} processes / SubprocVecEnv of {ROBOTS}", seen["all"], seen["subproc"], unit, 1.0,
              at_least=True)  # fmt: skip


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
