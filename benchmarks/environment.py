"""The environment on one core: its step beside the substeps in it, batches of them beside DummyVecEnv.

Seconds are of this thread's processor time, which other programs do not add to.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import gymnasium as gym
import numpy as np
from stable_baselines3.common.vec_env import DummyVecEnv, VecEnv
from timing import OneCore, Row, in_turn, row

from tensegym.envs.rolling import RollingEnv
from tensegym.train.vec_env import RollingVecEnv

ROBOTS, EPISODE = 8, 50
ARGUMENTS: dict[str, Any] = {"settle": 0.0}


def make_single(compiled: bool = True) -> gym.Env:
    """What a user without a vector environment makes; ``compiled=False`` is how substeps were made before."""
    from tensegym.bullet import c_interface as direct_calls

    direct_calls.AVAILABLE = direct_calls.AVAILABLE and compiled
    return gym.make("tensegym/SixRodRolling-v0", max_episode_steps=EPISODE, **ARGUMENTS)


def step_costs(observation: str) -> tuple[Callable[[], float], Callable[[], float]]:
    """Measure an environment step, and what of that very step its substeps took; microseconds."""
    env = RollingEnv(observation=observation)
    env.reset(seed=0)
    rng, advance, spent = np.random.default_rng(0), env._advance, [0.0]

    def timed() -> None:
        began = time.thread_time()
        advance()
        spent[0] = time.thread_time() - began

    def step() -> float:
        action = rng.uniform(-1, 1, env.action_space.shape)
        began = time.thread_time()
        env.step(action)
        return (time.thread_time() - began) * 1e6

    env._advance = timed  # type: ignore[method-assign]
    return step, lambda: spent[0] * 1e6


def stepper(env: VecEnv, clock: Callable[[], float]) -> Callable[[], float]:
    """Robot steps a second of a vector environment, by this clock."""
    env.reset()
    actions = np.random.default_rng(0).uniform(-1, 1, (1000, env.num_envs, 6)).astype(np.float32)
    turn = iter(actions)

    def measure() -> float:
        began = clock()
        for _ in range(3):
            env.step(next(turn))
        return 3 * env.num_envs / (clock() - began)

    return measure


def rows(rounds: int) -> Iterator[Row]:
    """Environment step, and batches in one process."""
    with OneCore():
        yield from _steps(rounds)
        yield from _batches(rounds)


def _steps(rounds: int) -> Iterator[Row]:
    for observation in ("full", "onboard"):
        step, substeps = step_costs(observation)
        seen = in_turn({"step": step, "substeps": substeps}, 3 * rounds)
        yield row(f"environment step, {observation} / its substeps", seen["step"], seen["substeps"], "us", 1.12)


def _batches(rounds: int) -> Iterator[Row]:
    sizes = {f"{n} robots": RollingVecEnv(n, EPISODE, ARGUMENTS, processes=1) for n in (1, 2, 4, 8, 16)}
    dummy = DummyVecEnv([make_single] * ROBOTS)
    seen = in_turn({name: stepper(env, time.thread_time) for name, env in [*sizes.items(), ("dummy", dummy)]}, rounds)
    for env in (*sizes.values(), dummy):
        env.close()
    for name in sizes:
        yield row(f"{name} in a process / 1 robot", seen[name], seen["1 robots"], "robot steps/s")
    best = max(sizes, key=lambda name: np.median(seen[name]))
    name, unit = f"best, {best}, / DummyVecEnv of {ROBOTS}", "robot steps/s"
    yield row(name, seen[best], seen["dummy"], unit, 1.0, at_least=True)
