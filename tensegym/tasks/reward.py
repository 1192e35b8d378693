"""Reward of rolling: way made along the wanted direction, less foot slip, less energy, and places reached."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tensegym.errors import DesignError
from tensegym.tables import Checked, bounded, fill


@dataclass(frozen=True)
class RewardWeights(Checked, error=DesignError):
    """What counts how much."""

    progress: float = bounded(0, 1e3, 1.0, "", "per rod length of the centre of mass along the wanted direction")
    slip: float = bounded(0, 1e3, 0.15, "", "per rod length of the path of the grounded feet's centres, their mean")
    energy: float = bounded(0, 1e3, 2e-4, "1/J", "of what the drives draw")
    arrive: float = bounded(0, 1e3, 0.0, "", "per place reached, where there are places")

    def changed(self, weights: Mapping[str, Any]) -> RewardWeights:
        """A copy with some weights replaced. Raises DesignError naming one that there is not, or its range."""
        return fill(RewardWeights, weights, "reward", DesignError, self)
