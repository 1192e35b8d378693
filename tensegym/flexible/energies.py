"""Energies: the mechanical energy of a robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Energies:
    """[J]; the weight's is zero with every link's centre at the world's origin."""

    kinetic: float
    weight: float
    elastic: float

    @property
    def total(self) -> float:
        return self.kinetic + self.weight + self.elastic
