"""Begin a training from a trained policy: to fine-tune it, or to let it see more than it did.

What the new observation has behind the old one's end begins with weights of zero: at first the policy acts as before.
"""

from __future__ import annotations

import math
from typing import Any

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecNormalize

from tensegym.control.policy import policy_env, policy_folder
from tensegym.control.policy_file import read_policy
from tensegym.errors import InputError

from .checkpoint import put_statistics
from .config import TrainConfig


def check_start(config: TrainConfig, observed: Any, driven: Any) -> None:
    """Refuse a start that an environment of these shapes cannot go on from. Raises InputError, FileNotFoundError."""
    assert config.start is not None
    kinds = policy_env(config.start).get("observation", "full"), config.env.get("observation", "full")
    saved = read_policy(policy_folder(config.start))
    own, hidden = (saved.observation_bounds.shape[1:], saved.action_bounds.shape[1:]), saved.hidden
    goes_on = f"{kinds[1]}-".startswith(f"{kinds[0]}-") and own[0] <= observed
    if not goes_on or own[1] != driven or hidden != list(config.hidden):
        raise InputError(
            f"training config: start = {config.start!r} has observation {kinds[0]} {own[0]}, actions {own[1]} and "
            f"hidden {hidden}; this training has {kinds[1]} {observed}, {driven} and {list(config.hidden)}. Only the "
            "observation may be longer, such as onboard-memory for onboard"
        )


def begin_from(start: str, model: PPO, env: VecNormalize, std: float | None = None) -> None:
    """Give a fresh model the networks of a policy, and its environments that policy's running statistics.

    std: of the actions, in place of the policy's, which may have settled on its ways.
    """
    saved = read_policy(policy_folder(start))
    new = model.policy.state_dict()
    for name, value in new.items():
        if name.endswith((".index", ".sign", ".back")):  # how the robot's rotations permute the new observation
            continue
        known = torch.from_numpy(saved.weights[name])
        value.zero_()
        value[tuple(slice(n) for n in known.shape)] = known
    if std is not None:
        new["log_std"].fill_(math.log(std))
    model.policy.load_state_dict(new)
    put_statistics(env.obs_rms, saved.observations)
    put_statistics(env.ret_rms, saved.returns)
