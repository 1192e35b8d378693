"""A training as data: a YAML file, checked where it is read. What is left out keeps its default.

    env_id: tensegym/SixRodRolling-v0
    env:                            # arguments of the environment, as gym.make takes them
      observation: onboard
      design: robot.toml            # or its fields here, as in a design file
      reward: {slip: 0.15}
    start: onboard                  # begin as this policy: a shipped one, or a run's folder
    episode_seconds: 20.0
    n_envs: 8
    steps: 160000
    hidden: [256, 256]
"""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass, field
from importlib import resources
from typing import Any

from tensegym.design.variation import named_ranges
from tensegym.errors import InputError
from tensegym.files import without_version
from tensegym.tables import Checked, bounded, fill, hint, in_file, noted, one_line, parse_yaml, read_text, show


@dataclass(frozen=True)
class TrainConfig(Checked, error=InputError):
    """One training: the environment's arguments, PPO's and the policy's.

    steps: environment steps in all, rounded up to whole updates of n_envs x rollout. rollout: steps of each
    environment between two updates. chunk: updates between two checkpoints; environments and random generators start
    afresh from (seed, steps done) at each, which is what makes a resumed training equal one that was never killed.
    start: a policy, shipped or a run's folder, whose networks and running statistics the training begins with; see
    start_policy.
    """

    env_id: str = noted("tensegym/SixRodRolling-v0", "the environment's name in Gymnasium's registry")
    env: dict[str, Any] = field(default_factory=dict, metadata={"what": "arguments of the environment"})
    start: str | None = noted(None, "a policy to begin with")
    episode_seconds: float = bounded(0, 3600, 20.0, "s", "length of an episode", open_low=True)
    n_envs: int = bounded(1, 4096, 8, "", "environments side by side")
    steps: int = bounded(1, 10**12, 320_000, "", "environment steps in all, rounded up to whole updates")
    rollout: int = bounded(1, 10**6, 100, "", "steps of each environment between two updates")
    chunk: int = bounded(1, 10**6, 8, "", "updates between two checkpoints")
    batch_size: int = bounded(1, 10**9, 200, "", "steps of a gradient step")
    n_epochs: int = bounded(1, 10**4, 10, "", "passes over the steps of an update")
    learning_rate: float = bounded(0, 1, 4e-4, "", "Adam's, at the start", open_low=True)
    final_learning_rate: float = bounded(0, 1, 5e-5, "", "Adam's, at the end", open_low=True)
    schedule: int | None = bounded(1, 10**12, None, "", "environment steps over which it falls; none: the steps")
    gamma: float = bounded(0, 1, 0.95, "", "discount a step", open_low=True)
    gae_lambda: float = bounded(0, 1, 0.95, "", "weight of later steps in the advantage", open_low=True)
    clip_range: float = bounded(0, 1, 0.2, "", "of the policy's ratio", open_low=True)
    ent_coef: float = bounded(0, 10, 0.0, "", "weight of the policy's entropy in the loss")
    target_kl: float | None = bounded(0, 10, None, "", "divergence at which an update stops", open_low=True)
    hidden: tuple[int, ...] = bounded(1, 10**5, (256, 256), "", "widths of the hidden layers")
    log_std_init: float = bounded(-10, 3, 0.0, "", "logarithm of the actions' first standard deviation", open_low=True)
    start_std: float | None = bounded(0, 10, None, "", "the same where there is a start, in place of that policy's own",
                                      open_low=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not re.fullmatch(r"tensegym/\w+-v\d+", self.env_id):  # "module:id" would import the module
            raise InputError(one_line(f"TrainConfig.env_id = {show(self.env_id)} must be as tensegym/NAME-v0"))
        if not self.hidden:
            raise InputError("TrainConfig.hidden = [] must hold one width or more")
        if self.batch_size > self.rollout_steps:
            raise InputError(
                f"TrainConfig.batch_size = {self.batch_size} is more than the {self.rollout_steps} steps of an update "
                "(n_envs x rollout)"
            )
        if self.schedule is not None and self.schedule < self.steps:
            raise InputError(f"TrainConfig.schedule = {self.schedule} must be at least the {self.steps} steps of the "
                             "training; leave it out, or give that many or more")  # fmt: skip

    def learning_rate_at(self, steps: int) -> float:
        """Adam's after so many environment steps: it falls evenly."""
        left = 1 - steps / (self.schedule or self.steps)
        return self.final_learning_rate + left * (self.learning_rate - self.final_learning_rate)

    @property
    def rollout_steps(self) -> int:
        """Environment steps an update."""
        return self.n_envs * self.rollout

    @property
    def whole_steps(self) -> int:
        """Environment steps that are done for the ``steps`` asked for: whole updates."""
        return -(-self.steps // self.rollout_steps) * self.rollout_steps

    def as_dict(self) -> dict[str, Any]:
        return asdict(self) | {"hidden": list(self.hidden)}


def load_config(name: str) -> TrainConfig:
    """A committed config by name (`rolling`, `onboard`), or a YAML file by path."""
    what = "training config"
    if name.endswith((".yaml", ".yml")):
        text = read_text(name, what, InputError)
    else:
        shipped = resources.files("tensegym.train") / "configs"
        names = sorted(p.name.removesuffix(".yaml") for p in shipped.iterdir() if p.name.endswith(".yaml"))
        if name not in names:
            raise InputError(one_line(
                f"unknown {what} {show(name)}: give a path to a YAML file, or a shipped one's name; {hint(name, names)}"
            ))  # fmt: skip
        text = (shipped / f"{name}.yaml").read_text(encoding="utf-8")
    data = without_version(parse_yaml(text, f"{what} {name}", InputError), f"{what} {name}")
    with in_file(f"{what} {name}"):
        env = data.get("env")
        if isinstance(env, dict) and isinstance(env.get("vary"), str):  # in full, so that a run's copy stands alone
            data["env"] = {**env, "vary": named_ranges(env["vary"], "env.vary", InputError)}
        return fill(TrainConfig, data, "", InputError)
