"""RollingVectorEnv: many rolling environments behind Gymnasium's vector interface."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from tensegym.engine import Uncopied
from tensegym.errors import DesignError

from . import CONTROL_PERIOD
from .batch import make_batch
from .rolling import RollingEnv


class RollingVectorEnv(Uncopied, VectorEnv):
    """`RollingEnv` times ``num_envs``, over ``processes`` (by default one a core); one env's arguments otherwise.

    `gymnasium.make_vec("tensegym/SixRodRolling-v0", num_envs=8)` makes one. An episode that ends, by itself or after
    ``max_episode_steps``, starts anew in the same step: its end is in ``infos["final_obs"]`` and ``"final_info"``.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]  # the base class annotates an instance variable
        **RollingEnv.metadata, "render_modes": ["rgb_array"], "autoreset_mode": AutoresetMode.SAME_STEP,
    }  # fmt: skip

    def __init__(
        self, num_envs: int = 1, processes: int | None = None, max_episode_steps: int | None = None, **arguments: Any
    ) -> None:
        if arguments.get("render_mode") == "human":
            raise DesignError("render_mode = 'human' is for one environment; take rgb_array or None here")
        self.num_envs, self.render_mode = num_envs, arguments.get("render_mode")
        self.batch = make_batch(num_envs, processes, max_episode_steps, arguments)
        pictures = 1 / arguments.get("control_period", CONTROL_PERIOD)
        self.metadata = {**type(self).metadata, "render_fps": pictures}  # type: ignore[misc]
        self.single_observation_space, self.single_action_space = self.batch.spaces
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start every environment: seed s gives s, s + 1, ...; options as RollingEnv takes them."""
        if seed is None or isinstance(seed, int):
            seed = [None if seed is None else seed + i for i in range(self.num_envs)]
        if len(seed) != self.num_envs:
            raise DesignError(f"seed has {len(seed)} entries; give one an environment, {self.num_envs}, or one number")
        observations, infos = self.batch.reset(seed, options)
        return observations, self._joined(infos)

    def step(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        observations, rewards, terminated, truncated, infos = self.batch.step(actions)
        return observations, rewards, terminated, truncated, self._joined(infos)

    def _joined(self, infos: list[dict[str, Any]]) -> dict[str, Any]:
        joined: dict[str, Any] = {}
        for i, info in enumerate(infos):
            joined = self._add_info(joined, info, i)
        return joined

    def render(self) -> tuple[Any, ...]:
        """A picture of every robot."""
        return tuple(self.batch.render())

    def close_extras(self, **kwargs: Any) -> None:
        self.batch.close()
