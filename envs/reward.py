"""Reward of rolling: way made along the wanted direction, less foot slip, less energy. Each term in rod lengths."""

from __future__ import annotations

from dataclasses import dataclass, fields

from tensegym.errors import DesignError


@dataclass(frozen=True)
class RewardWeights:
    """progress: per rod length of the centre of mass along the wanted direction.

    slip: per rod length of the path of the grounded feet's centres (mean over the grounded feet).
    energy: per joule drawn by the drives.
    """

    progress: float = 1.0
    slip: float = 0.3
    energy: float = 2e-4

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if not (isinstance(value, int | float) and 0 <= value <= 1e3):
                raise DesignError(f"RewardWeights.{f.name} = {value!r} is outside [0, 1000]")


def reward_terms(weights: RewardWeights, progress: float, slip: float, energy: float) -> dict[str, float]:
    """Signed terms of one step from progress and slip [rod lengths] and energy [J]; the reward is their sum."""
    return {
        "progress": weights.progress * progress,
        "slip": -weights.slip * slip,
        "energy": -weights.energy * energy,
    }
