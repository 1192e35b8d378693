"""An actor-critic that respects the robot's rotations exactly: what it does turns with the robot.

For a group of symmetries g the mean action is the average over g of P_g^-1 f(P_g s), the value the average of
v(P_g s), with f and v plain networks. Every sample teaches all its mirror images.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from stable_baselines3.common.policies import ActorCriticPolicy
from torch import nn

from tensegym.design.symmetry import symmetries
from tensegym.envs.rolling import RollingEnv


def symmetry_arguments(env: RollingEnv) -> dict[str, list[list[int]]]:
    """Policy arguments: how each symmetry of the env's robot permutes observations and actions.

    Row g of observation_index picks P_g s = sign * s[index]; row g of action_index picks P_g^-1 a = a[index].
    """
    observation_index, observation_sign, action_index = [], [], []
    for g in symmetries(env.robot.design):
        source = {"node": np.argsort(g.nodes), "drive": np.argsort(g.drives),
                  "cable": np.argsort(g.cables), "rod": np.argsort(g.rods)}  # fmt: skip
        index, sign, start = [], [], 0
        for part in env.observation.parts:
            rows = source.get(part.kind, np.arange(part.rows))  # what is the whole robot's stays
            index.append(start + (rows[:, None] * part.width + np.arange(part.width)).ravel())
            flip = g.rod_flips[rows] if part.name == "rod axis" else np.ones(part.rows, dtype=int)
            sign.append(np.repeat(flip, part.width))
            start += part.size
        observation_index.append(np.concatenate(index).tolist())
        observation_sign.append(np.concatenate(sign).tolist())
        action_index.append(g.drives.tolist())
    return {
        "observation_index": observation_index,
        "observation_sign": observation_sign,
        "action_index": action_index,
    }


class _SymmetricNetworks(nn.Module):
    """Mean action and value, each averaged over the group."""

    index: torch.Tensor
    sign: torch.Tensor
    back: torch.Tensor

    def __init__(
        self, size: int, hidden: list[int], index: torch.Tensor, sign: torch.Tensor, back: torch.Tensor
    ) -> None:
        super().__init__()
        self.register_buffer("index", index)
        self.register_buffer("sign", sign)
        self.register_buffer("back", back)
        self.latent_dim_pi, self.latent_dim_vf = back.shape[1], 1
        self.actor = _mlp(size, hidden, self.latent_dim_pi, 0.01)
        self.critic = _mlp(size, hidden, 1, 1.0)

    def _images(self, features: torch.Tensor) -> torch.Tensor:
        return features[:, self.index] * self.sign  # (batch, group, size)

    def forward_actor(self, features: torch.Tensor) -> torch.Tensor:
        means = self.actor(self._images(features))
        return means.gather(2, self.back.expand(len(means), -1, -1)).mean(dim=1)

    def forward_critic(self, features: torch.Tensor) -> torch.Tensor:
        return self.critic(self._images(features)).mean(dim=1)

    def forward(self, features: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        return self.forward_actor(features), self.forward_critic(features)


def _mlp(inputs: int, hidden: list[int], outputs: int, gain: float) -> nn.Sequential:
    layers: list[nn.Module] = []
    for width in hidden:
        layers += [_orthogonal(nn.Linear(inputs, width), np.sqrt(2)), nn.Tanh()]
        inputs = width
    return nn.Sequential(*layers, _orthogonal(nn.Linear(inputs, outputs), gain))


def _orthogonal(layer: nn.Linear, gain: float) -> nn.Linear:
    nn.init.orthogonal_(layer.weight, gain)
    nn.init.zeros_(layer.bias)
    return layer


class SymmetricPolicy(ActorCriticPolicy):
    """For `PPO(SymmetricPolicy, env, policy_kwargs={"hidden": [256, 256], **symmetry_arguments(env)})`."""

    def __init__(
        self, *args: Any, hidden: list[int], observation_index: list[list[int]], observation_sign: list[list[int]],
        action_index: list[list[int]], **kwargs: Any,
    ) -> None:  # fmt: skip
        self._group = (torch.tensor(observation_index), torch.tensor(observation_sign, dtype=torch.float32),
                       torch.tensor(action_index))  # fmt: skip
        self._hidden = list(hidden)
        super().__init__(*args, ortho_init=False, **kwargs)

    def _build_mlp_extractor(self) -> None:
        self.mlp_extractor = _SymmetricNetworks(self.features_dim, self._hidden, *self._group).to(self.device)

    def _build(self, lr_schedule: Any) -> None:
        super()._build(lr_schedule)
        # the networks above end in actions and values already
        self.action_net, self.value_net = nn.Identity(), nn.Identity()
        self.optimizer = self.optimizer_class(self.parameters(), lr=lr_schedule(1), **self.optimizer_kwargs)
