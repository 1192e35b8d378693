"""Many rolling environments as one: stepped in turn in this process, or in several processes at a time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, pairwise
from typing import Any

import numpy as np
from gymnasium import spaces

from tensegym.errors import DesignError
from tensegym.processes import Worker, call_all, cores

from .actions import as_actions
from .rolling import RollingEnv

Steps = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]


class Batch:
    """Environments of this process, each with its time limit; one that has ended starts anew in the same step.

    The info of a step that ends an episode is that of the new one's start, with ``final_obs`` and ``final_info`` of the
    old one's end. No limit with ``max_episode_steps=None``.
    """

    def __init__(self, count: int, max_episode_steps: int | None, arguments: dict[str, Any]) -> None:
        self.envs = [RollingEnv(**arguments) for _ in range(count)]
        self.limit = np.inf if max_episode_steps is None else max_episode_steps
        self._steps = np.zeros(count, dtype=int)

    @property
    def spaces(self) -> tuple[spaces.Box, spaces.Box]:
        """Observation and action space of one environment."""
        return self.envs[0].observation_space, self.envs[0].action_space

    def reset(
        self, seeds: Sequence[int | None], options: dict[str, Any] | None
    ) -> tuple[np.ndarray, list[dict[str, Any]]]:
        """Observations (n, o) and infos of fresh episodes."""
        starts = [env.reset(seed=seed, options=options) for env, seed in zip(self.envs, seeds, strict=True)]
        self._steps[:] = 0
        return np.stack([observation for observation, _ in starts]), [info for _, info in starts]

    def step(self, actions: np.ndarray) -> Steps:
        """Actions (n, w) in; observations (n, o), rewards, terminated, truncated (n,) and infos out."""
        count = len(self.envs)
        actions = as_actions(actions, (count, *self.spaces[1].shape))
        rewards, terminated, truncated = np.zeros(count), np.zeros(count, bool), np.zeros(count, bool)
        observations, infos = [], []
        self._steps += 1
        for i, (env, action) in enumerate(zip(self.envs, actions, strict=True)):
            observation, rewards[i], terminated[i], _, info = env.step(action)
            truncated[i] = self._steps[i] >= self.limit
            if terminated[i] or truncated[i]:
                final = {"final_obs": observation, "final_info": info}
                observation, info = env.reset()
                info |= final
                self._steps[i] = 0
            observations.append(observation)
            infos.append(info)
        return np.stack(observations), rewards, terminated, truncated, infos

    def render(self) -> list[np.ndarray | None]:
        """A picture of every robot."""
        return [env.render() for env in self.envs]

    def attributes(self, name: str) -> list[Any]:
        """An attribute of every environment."""
        return [getattr(env, name) for env in self.envs]

    def close(self) -> None:
        for env in self.envs:
            env.close()


class Processes:
    """A batch whose environments are dealt over worker processes; what they do does not depend on how many there are.

    Raises in this process what a worker raised, and WorkerDied when one ended without a word.
    """

    def __init__(self, count: int, processes: int, max_episode_steps: int | None, arguments: dict[str, Any]) -> None:
        ends = np.linspace(0, count, processes + 1).round().astype(int).tolist()
        self.rows = [slice(first, last) for first, last in pairwise(ends)]
        self.workers = [Worker(Batch, rows.stop - rows.start, max_episode_steps, arguments) for rows in self.rows]
        try:
            for worker in self.workers:
                worker.started()
        except BaseException:
            self.close()
            raise
        self.spaces: tuple[spaces.Box, spaces.Box] = (
            self.attributes("observation_space")[0], self.attributes("action_space")[0],
        )  # fmt: skip

    def _ask(self, method: str, *by_row: Any, options: tuple[Any, ...] = ()) -> list[Any]:
        """Call a method of all workers' batches at a time: with its rows of each of ``by_row``, and ``options``."""
        return call_all(self.workers, method, [(*(part[rows] for part in by_row), *options) for rows in self.rows])

    def reset(
        self, seeds: Sequence[int | None], options: dict[str, Any] | None
    ) -> tuple[np.ndarray, list[dict[str, Any]]]:
        """As Batch.reset."""
        observations, infos = zip(*self._ask("reset", list(seeds), options=(options,)), strict=True)
        return np.concatenate(observations), list(chain(*infos))

    def step(self, actions: np.ndarray) -> Steps:
        """As Batch.step."""
        actions = as_actions(actions, (self.rows[-1].stop, *self.spaces[1].shape))
        *arrays, infos = zip(*self._ask("step", actions), strict=True)
        observations, rewards, terminated, truncated = (np.concatenate(array) for array in arrays)
        return observations, rewards, terminated, truncated, list(chain(*infos))

    def render(self) -> list[np.ndarray | None]:
        """As Batch.render."""
        return list(chain(*self._ask("render")))

    def attributes(self, name: str) -> list[Any]:
        """As Batch.attributes."""
        return list(chain(*self._ask("attributes", options=(name,))))

    def close(self) -> None:
        for worker in self.workers:
            worker.pipe.close()  # they end side by side
        for worker in self.workers:
            worker.close()


def make_batch(
    count: int, processes: int | None, max_episode_steps: int | None, arguments: dict[str, Any]
) -> Batch | Processes:
    """``count`` environments over ``processes``: by default one a core, and this process itself where one is enough.

    Raises DesignError for counts below 1.
    """
    for name, value in (("num_envs", count), ("processes", processes), ("max_episode_steps", max_episode_steps)):
        if value is not None and not (isinstance(value, int | np.integer) and value >= 1):
            raise DesignError(f"{name} = {value!r} must be a whole number, 1 or more")
    processes = min(count, cores() if processes is None else processes)
    if processes == 1:
        return Batch(count, max_episode_steps, arguments)
    return Processes(count, processes, max_episode_steps, arguments)
