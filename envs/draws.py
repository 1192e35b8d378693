"""Which design an episode is on: the one given, one drawn from a variation, and what disturbances make of either."""

from __future__ import annotations

from numpy.random import Generator

from tensegym.design.design import RobotDesign
from tensegym.design.variation import Variation
from tensegym.errors import DesignError
from tensegym.tasks.disturbance import Disturbance


class Draws:
    """The designs of an environment's episodes.

    Args:
        base: the design given.
        variation: of the base, or None.
        episodes: played on a drawn design before the next one; with 0 none is drawn.
        disturb: what is built otherwise than designed.

    Raises:
        DesignError: ``episodes`` is no count, or the base has not what is disturbed.
    """

    def __init__(self, base: RobotDesign, variation: Variation | None, episodes: int, disturb: Disturbance) -> None:
        if type(episodes) is not int or episodes < 0:
            raise DesignError(f"episodes_per_design = {episodes!r} must be a whole number, 0 or more")
        self.variation, self._base, self._episodes, self._left = variation, base, episodes, 0
        disturb.check(base)
        self._disturb = disturb
        self.nominal = base
        """The design as such, which disturbances change."""
        self.factors = dict[str, float]()
        """By which the robot last built is off."""

    @property
    def varies(self) -> bool:
        """Whether designs are drawn."""
        return bool(self.variation and self._episodes)

    @property
    def rebuilds(self) -> bool:
        """Whether every episode has a robot of its own."""
        return self._disturb.rebuilds

    def due(self, seeded: bool) -> bool:
        """Whether the episode that begins is on another design: after so many of them, and at a seeded reset."""
        due = self.varies and (seeded or not self._left)
        self._left = (self._episodes if due else self._left) - 1
        return due

    def draw(self, rng: Generator) -> RobotDesign:
        """Another design of the variation."""
        assert self.variation is not None
        return self.variation.draw(self._base, rng)

    def build(self, rng: Generator) -> RobotDesign:
        """A robot as it was built after the nominal design, with its `factors`."""
        built, self.factors = self._disturb.draw(self.nominal, rng)
        return built
