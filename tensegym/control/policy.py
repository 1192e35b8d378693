"""Policies: what PPO learned, as a function of the observation, and as a controller."""

from __future__ import annotations

import pickle
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.design.variation import parse_variation
from tensegym.errors import DesignError, InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import mapping, read_yaml

from .observation import make_observation

FILES = ("model.zip", "vecnormalize.pkl", "config.yaml")
CONTROL_PERIOD = 0.4  # s, where a policy's environment says nothing else


class Policy:
    """A trained policy: an observation in, its deterministic action out, the running statistics included.

    Attributes:
        name: as it was asked for.
        env: arguments of the environment that it was trained in.
        observed: length of an observation.
        driven: length of an action.
    """

    def __init__(self, name: str, folder: Path, env: dict[str, Any]) -> None:
        import torch
        from stable_baselines3 import PPO

        torch.set_num_threads(1)
        self.name, self.env = name, env
        self._model = PPO.load(folder / "model.zip", device="cpu")
        with (folder / "vecnormalize.pkl").open("rb") as file:
            self._normalise = pickle.load(file)
        self._normalise.training, self._normalise.norm_reward = False, False
        self.observed, self.driven = self._model.observation_space.shape[0], self._model.action_space.shape[0]

    def __call__(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """Action (driven,) of an observation (observed,)."""
        return self._model.predict(self._normalise.normalize_obs(observation[None]), deterministic=True)[0][0]


def shipped(name: str) -> Path:
    """Folder of a policy that comes with the package."""
    return Path(str(resources.files("tensegym.train") / "policies" / name))


def shipped_names() -> list[str]:
    """Every policy that comes with the package."""
    return sorted(folder.name for folder in shipped("").iterdir() if (folder / FILES[0]).is_file())


def policy_folder(name: str) -> Path:
    """Folder of a shipped policy by its name, or of a run by its path.

    Raises:
        FileNotFoundError: there is no policy.
    """
    folder = shipped(name) if name in shipped_names() else Path(name)
    for file in FILES:
        if not (folder / file).is_file():
            raise FileNotFoundError(f"no policy in {name!r}: {file} is missing; give a run's folder or one of "
                                    f"{', '.join(shipped_names())}")  # fmt: skip
    return folder


def policy_env(name: str) -> dict[str, Any]:
    """Arguments of the environment that a policy was trained in; reads no network. Raises as `policy_folder`."""
    config = read_yaml(policy_folder(name) / "config.yaml", "training config", InputError)
    return mapping(config.get("env"), f"env of the policy {name!r}", InputError)


def load_policy(name: str | Path) -> Policy:
    """A shipped policy by its name, or one from a run's folder. Raises as `policy_folder`."""
    folder = policy_folder(str(name))
    return _read_once(str(name), folder, (folder / FILES[0]).stat().st_mtime_ns)


@lru_cache(maxsize=16)
def _read_once(name: str, folder: Path, changed: int) -> Policy:
    """One policy for all episodes of a process, until its file is changed."""
    return Policy(name, folder, policy_env(name))


class PolicyController:
    """A policy that drives a robot, which it sees as it did in its training.

    Args:
        name: a shipped policy, or the path of a run's folder.
        observation: kind of observation, in place of the policy's own.
        period: of its commands [s], in place of the policy's own.
    """

    def __init__(self, name: str, observation: str | None = None, period: float | None = None) -> None:
        self.policy = load_policy(name)
        env = self.policy.env
        self.period: float = period or env.get("control_period", CONTROL_PERIOD)
        self._kind = observation or env.get("observation", "full")

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        """As `Controller` has it. Raises DesignError where the robot's observation or drives are not the policy's."""
        vary = self.policy.env.get("vary")
        seen = parse_variation(vary, robot.design) if vary else None
        self._observation = make_observation(self._kind, robot, seen)
        for what, own, here in (("observations", self.policy.observed, len(self._observation.bound)),
                                ("actions", self.policy.driven, len(robot.drives))):  # fmt: skip
            if own != here:
                raise DesignError(
                    f"policy {self.policy.name} was trained on {what} of shape ({own},), here they are ({here},); "
                    "evaluate it on a robot of the same kind, with the observation it was trained with"
                )

    def action(self, robot: TensegrityRobot, direction: FloatArray) -> NDArray[np.float32]:
        """(w,) commands from -1, let out, to 1, the deepest pull."""
        return np.clip(self.policy(self._observation.see(robot, direction)), -1, 1)

    def angles(self, robot: TensegrityRobot, direction: FloatArray) -> FloatArray:
        """As `Controller` has it."""
        return robot.angles_of(self.action(robot, direction).astype(float))
