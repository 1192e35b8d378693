"""RollingVecEnv: a batch of environments behind the interface that stable-baselines3 trains with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from stable_baselines3.common.vec_env import VecEnv

from tensegym.engine import Uncopied
from tensegym.envs.batch import make_batch


class RollingVecEnv(Uncopied, VecEnv):
    """N environments in as many processes as there are cores (or ``processes``), whatever N.

    Seeds, episode ends and infos are as those of stable-baselines3's own vector environments, and so are the numbers:
    `seed` takes effect at the next reset; ``terminal_observation`` and ``TimeLimit.truncated`` stand in the info of a
    step that ends an episode.
    """

    def __init__(
        self, num_envs: int, max_episode_steps: int | None, arguments: dict[str, Any], processes: int | None = None
    ) -> None:
        self.batch = make_batch(num_envs, processes, max_episode_steps, arguments)
        self.actions = np.zeros(0)
        super().__init__(num_envs, *self.batch.spaces)

    def reset(self) -> np.ndarray:
        options = self._options[0] or None  # one for all: the environments of a training are alike
        observations, self.reset_infos = self.batch.reset(self._seeds, options)
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        self.actions = actions

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, infos = self.batch.step(self.actions)
        done = terminated | truncated
        for i in np.flatnonzero(done):
            start = infos[i]
            end, observation = start.pop("final_info"), start.pop("final_obs")
            self.reset_infos[i] = start
            infos[i] = {**end, "terminal_observation": observation,
                        "TimeLimit.truncated": bool(truncated[i] and not terminated[i])}  # fmt: skip
        return observations, rewards, done, infos

    def close(self) -> None:
        self.batch.close()

    def get_images(self) -> Sequence[np.ndarray | None]:
        return self.batch.render()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        values = self.batch.attributes(attr_name)
        return [values[i] for i in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: type, indices: Any = None) -> list[bool]:
        return [False for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise NotImplementedError("make the environments with the arguments wanted")

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> list[Any]:
        raise NotImplementedError("make the environments with the arguments wanted")
