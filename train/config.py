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
    makes a resumed training equal one that was never killed. start: a policy, shipped or a run's folder, whose networks
    and running statistics the training begins with; see start_policy.
    """

    env_id: str = "tensegym/SixRodRolling-v0"
    env: dict[str, Any] = field(default_factory=dict)
    start: str | None = None
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
            if not (isinstance(value, int) and not isinstance(value, bool) and value >= 1):
                raise InputError(f"training config: {name} = {value!r} must be a whole number, 1 or more")
        for name, low, high, ends in (
            ("learning_rate", 0, 1, "(0, 1]"), ("final_learning_rate", 0, 1, "(0, 1]"),
            ("episode_seconds", 0, 3600, "(0, 3600]"), ("gamma", 0, 1, "(0, 1]"), ("gae_lambda", 0, 1, "(0, 1]"),
            ("clip_range", 0, 1, "(0, 1]"), ("ent_coef", -1e-12, 10, "[0, 10]"), ("target_kl", 0, 10, "(0, 10]"),
            ("log_std_init", -10, 3, "(-10, 3]"),
        ):  # fmt: skip
            value = getattr(self, name)
            if name == "target_kl" and value is None:
                continue
            if not (isinstance(value, int | float) and low < value <= high):
                hint = "; YAML reads 1e-4 as a text, write 1.0e-4" if isinstance(value, str) else ""
                raise InputError(f"training config: {name} = {value!r} must be a number in {ends}{hint}")
        if not self.hidden or not all(isinstance(width, int) and width >= 1 for width in self.hidden):
            raise InputError(f"training config: hidden = {list(self.hidden)!r} must be whole numbers, 1 or more")
        if self.batch_size > self.rollout_steps:
            raise InputError(
                f"training config: batch_size = {self.batch_size} is more than the {self.rollout_steps} steps of an "
                "update (n_envs x rollout)"
            )
        if not isinstance(self.env, dict):
            raise InputError(f"training config: env = {self.env!r} must be a mapping of environment arguments")

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
        hidden = data["hidden"]
        data["hidden"] = tuple(hidden) if isinstance(hidden, list) else (hidden,)
    return TrainConfig(**data)
