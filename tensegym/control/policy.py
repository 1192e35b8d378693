"""Policies: what PPO learned, as a function of the observation, and as a controller."""

from __future__ import annotations

import os
import shlex
from functools import cached_property, lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.design.design_file import as_design
from tensegym.design.variation import parse_variation
from tensegym.errors import DesignError, InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import mapping, one_line, read_yaml, show

from .bearing import Bearing
from .made_for import MadeFor
from .observations import make_observation
from .policy_file import SETTINGS, WEIGHTS, SavedPolicy, read_policy

FILES = (WEIGHTS, SETTINGS, "config.yaml")
CONTROL_PERIOD = 0.4  # s, where a policy's environment says nothing else


class Policy:
    """A trained policy: an observation in, its deterministic action out, the running statistics included.

    Attributes:
        name: as it was asked for.
        env: arguments of the environment that it was trained in.
        observed: length of an observation.
        driven: length of an action.
    """

    def __init__(self, name: str, saved: SavedPolicy, env: dict[str, Any]) -> None:
        import torch

        torch.set_num_threads(1)
        self.name, self.env, self._saved = name, env, saved
        self.observed, self.driven = saved.observation_bounds.shape[1], saved.action_bounds.shape[1]
        self._layers = [tuple(map(torch.from_numpy, layer)) for layer in saved.layers("actor")]
        self._index, self._sign, self._back = (
            torch.from_numpy(saved.weights[f"mlp_extractor.{part}"]) for part in ("index", "sign", "back")
        )

    @cached_property
    def made_for(self) -> MadeFor | None:
        """The robot of its training; None where that was of a file that is gone."""
        try:
            return MadeFor.of(as_design(self.env.get("design", "six_rod")).standing)
        except FileNotFoundError:
            return None

    def __call__(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """Action (driven,) of an observation (observed,): the mean over the symmetries, turned back."""
        import torch

        with torch.no_grad():
            images = torch.from_numpy(self._saved.normalised(observation)[None])[:, self._index] * self._sign
            for number, (weight, bias) in enumerate(self._layers):
                images = torch.nn.functional.linear(torch.tanh(images) if number else images, weight, bias)
            mean = images.gather(2, self._back.expand(1, -1, -1)).mean(dim=1)
        return np.clip(mean.numpy()[0], *self._saved.action_bounds)


def shipped(name: str) -> Path:
    """Folder of a policy that comes with the package."""
    return Path(str(resources.files("tensegym.train") / "policies" / name))


def shipped_names() -> list[str]:
    """Every policy that comes with the package."""
    return sorted(folder.name for folder in shipped("").iterdir() if (folder / FILES[0]).is_file())


def policy_folder(name: str | Path) -> Path:
    """Folder of a shipped policy by its name, or of a run by its path, which has a separator in it if it is text.

    Raises:
        FileNotFoundError: there is no policy.
        InputError: there is one that could run code.
    """
    names, folder = ", ".join(shipped_names()), Path(name)
    if isinstance(name, str) and not {"/", os.sep} & set(name) and not (name.endswith(".zip") and folder.is_file()):
        if name not in shipped_names():
            raise FileNotFoundError(one_line(f"no policy {show(name)}: shipped are {names}; a run's folder is given as "
                                             f"a path, ./{name}"))  # fmt: skip
        return shipped(name)
    missing = [file for file in FILES if not (folder / file).is_file()]
    if missing and foreign_policy(folder):
        raise InputError(one_line(
            "a policy as Stable-Baselines3 writes it can run code when it is read: if you trust its maker, convert it "
            f"by `python -m tensegym.train.convert --folder {shlex.quote(str(name))} --trust`"
        ))  # fmt: skip
    if missing:
        raise FileNotFoundError(one_line(f"no policy in {show(str(name))}: {missing[0]} is missing; give a run's "
                                         f"folder, or one of {names}"))  # fmt: skip
    return folder


def foreign_policy(path: Path) -> Path | None:
    """The zip of a policy as Stable-Baselines3 writes it: at a path, or in the folder there; None without one."""
    if path.is_file():
        return path if path.suffix == ".zip" else None
    zips = [path / name for name in ("model.zip", "best_model.zip")] + sorted(path.glob("*.zip"))
    return next((each for each in zips if each.is_file()), None)


def policy_env(name: str | Path) -> dict[str, Any]:
    """Arguments of the environment that a policy was trained in; reads no network.

    Raises:
        FileNotFoundError, InputError: as `policy_folder`, or the policy's config.yaml is none.
    """
    config = read_yaml(policy_folder(name) / "config.yaml", "training config", InputError)
    return mapping(config.get("env"), f"env of the policy {str(name)!r}", InputError)


def load_policy(name: str | Path) -> Policy:
    """A shipped policy by its name, or one from a run's folder.

    Raises:
        FileNotFoundError, InputError: as `policy_folder`, or the policy's files are none.
    """
    folder = policy_folder(name)
    return _read_once(str(name), folder, tuple((folder / file).stat().st_mtime_ns for file in FILES))


@lru_cache(maxsize=16)
def _read_once(name: str, folder: Path, changed: tuple[int, ...]) -> Policy:
    """One policy for all episodes of a process, until one of its files is changed."""
    return Policy(name, read_policy(folder), policy_env(folder))


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
        """As `Controller` has it. Raises DesignError where rods, drives or observation are not the policy's."""
        if self.policy.made_for:
            self.policy.made_for.check(robot, f"policy {self.policy.name}", "take one of a robot like it, or train one")
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

    def action(self, robot: TensegrityRobot, bearing: Bearing) -> NDArray[np.float32]:
        """(w,) commands from -1, let out, to 1, the deepest pull."""
        return np.clip(self.policy(self._observation.see(robot, bearing)), -1, 1)

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        """As `Controller` has it."""
        return robot.angles_of(self.action(robot, bearing).astype(float))
