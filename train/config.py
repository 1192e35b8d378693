"""Hyperparameters as data: YAML files under train/configs, checked where they are read."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from importlib import resources
from pathlib import Path
from typing import Any

import yaml

from tensegym.errors import InputError


@dataclass(frozen=True)
class TrainConfig:
    """One training: the environment's arguments, PPO's and the policy's.

    steps: environment steps in all. rollout: steps of each environment between two updates. chunk: updates between
    two checkpoints; environments and random generators start afresh from (seed, steps done) at each, which is what
    makes a resumed training equal one that was never killed.
    """

    env_id: str = "tensegym/SixRodRolling-v0"
    env: dict[str, Any] = field(default_factory=dict)
    episode_seconds: float = 20.0
    n_envs: int = 8
    steps: int = 320_000
    rollout: int = 100
    chunk: int = 8
    batch_size: int = 200
    n_epochs: int = 10
    learning_rate: float = 4e-4
    final_learning_rate: float = 5e-5
    gamma: float = 0.95
    gae_lambda: float = 0.95
    clip_range: float = 0.2
    ent_coef: float = 0.0
    target_kl: float | None = None
    hidden: tuple[int, ...] = (256, 256)
    log_std_init: float = 0.0

    def __post_init__(self) -> None:
        for name in ("n_envs", "steps", "rollout", "chunk", "batch_size", "n_epochs"):
            value = getattr(self, name)
            if not (isinstance(value, int) and value >= 1):
                raise InputError(f"training config: {name} = {value!r} must be a whole number, 1 or more")
        for name in ("learning_rate", "final_learning_rate", "episode_seconds"):
            if not 0 < getattr(self, name) < 1e3:
                raise InputError(f"training config: {name} = {getattr(self, name)!r} must be above 0")
        for name in ("gamma", "gae_lambda", "clip_range"):
            if not 0 < getattr(self, name) <= 1:
                raise InputError(f"training config: {name} = {getattr(self, name)!r} is outside (0, 1]")

    @property
    def rollout_steps(self) -> int:
        """Environment steps an update."""
        return self.n_envs * self.rollout

    def as_dict(self) -> dict[str, Any]:
        return asdict(self) | {"hidden": list(self.hidden)}


def load_config(name: str) -> TrainConfig:
    """A committed config by name (`rolling`, `onboard`), or a YAML file by path."""
    path = Path(name) if name.endswith((".yaml", ".yml")) else None
    if path is None:
        shipped = resources.files("tensegym.train") / "configs"
        names = sorted(p.name.removesuffix(".yaml") for p in shipped.iterdir() if p.name.endswith(".yaml"))
        if name not in names:
            raise InputError(f"unknown training config {name!r}; one of {', '.join(names)}, or a path to a YAML file")
        text = (shipped / f"{name}.yaml").read_text()
    elif not path.is_file():
        raise FileNotFoundError(f"no training config {path}")
    else:
        text = path.read_text()
    try:
        data = yaml.safe_load(text) or {}
    except yaml.YAMLError as error:
        raise InputError(f"training config {name} is not YAML: {error}") from error
    if not isinstance(data, dict):
        raise InputError(f"training config {name} must be a mapping of fields")
    unknown = set(data) - {f.name for f in fields(TrainConfig)}
    if unknown:
        allowed = ", ".join(f.name for f in fields(TrainConfig))
        raise InputError(f"training config {name}: unknown field {sorted(unknown)[0]!r}; allowed: {allowed}")
    if "hidden" in data:
        data["hidden"] = tuple(data["hidden"])
    return TrainConfig(**data)
