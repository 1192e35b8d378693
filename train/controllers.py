"""What can drive the environment in an evaluation: a trained policy, random commands, the open-loop walker."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tensegym.control.tipping import tip_table
from tensegym.control.walker import Walker, load_table
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError

Act = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Controller:
    """Plain data, so that worker processes can build what acts from it.

    kind: policy, random or walker. path: the policy's folder or the walker's table. env: environment arguments that
    the policy was trained with.
    """

    kind: str
    name: str
    path: str | None
    env: dict[str, Any]

    def start(self, env: RollingEnv) -> Callable[[int], Act]:
        """Returns a function of an episode's seed that returns what acts in that episode."""
        if self.kind == "random":
            return lambda seed: _random(np.random.default_rng(seed), env.action_space.shape)
        if self.kind == "walker":
            table = load_table(Path(self.path)) if self.path else tip_table(env.robot)
            walker = Walker(table)

            def episode(seed: int) -> Act:
                walker.restart()
                return lambda _: 2 * walker.angles(env.robot, env.direction) / env.robot.command_limit - 1

            return episode
        act = load_policy(Path(self.path or ""), env)
        return lambda seed: act


def _random(rng: np.random.Generator, shape: tuple[int, ...]) -> Act:
    return lambda _: rng.uniform(-1, 1, shape)


def shipped(name: str) -> Path:
    """Folder of a policy that comes with the package."""
    return Path(str(resources.files("tensegym.train") / "policies" / name))


def policy_controller(spec: str) -> Controller:
    """From the folder of a run, or the name of a shipped policy. Raises FileNotFoundError or InputError."""
    folder = Path(spec) if Path(spec).is_dir() else shipped(spec)
    for name in ("model.zip", "vecnormalize.pkl", "config.yaml"):
        if not (folder / name).is_file():
            raise FileNotFoundError(f"no policy in {spec!r}: {name} is missing; give a run's folder or a shipped name")
    config = yaml.safe_load((folder / "config.yaml").read_text())
    return Controller("policy", spec, str(folder), config["env"])


def load_policy(folder: Path, env: RollingEnv) -> Act:
    """Deterministic actions of a saved policy, observations normalised as in its training, statistics frozen.

    Raises InputError when it was trained on another observation or action space than ``env`` has.
    """
    import torch
    from stable_baselines3 import PPO

    torch.set_num_threads(1)
    model = PPO.load(folder / "model.zip", device="cpu")
    for what, own, given in (("observation", model.observation_space, env.observation_space),
                             ("action", model.action_space, env.action_space)):  # fmt: skip
        if own.shape != given.shape:
            raise InputError(
                f"policy {folder.name} was trained on {what}s of shape {own.shape}, here they are {given.shape}; "
                "evaluate it with the observation it was trained with"
            )
    with (folder / "vecnormalize.pkl").open("rb") as file:
        normalise = pickle.load(file)
    normalise.training, normalise.norm_reward = False, False

    def act(observation: np.ndarray) -> np.ndarray:
        return model.predict(normalise.normalize_obs(observation[None]), deterministic=True)[0][0]

    return act
