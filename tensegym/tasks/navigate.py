"""Navigate: follow a direction that changes, or go to places one after another."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar, cast

import numpy as np

from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import bounded, parsed

from .bound import Bound
from .progress import Progress
from .start import Start
from .targets import Target, Targets
from .task import Task

STALLED = 0.05  # L/s: a leg below it got nowhere


@dataclass(frozen=True, kw_only=True)
class Navigate(Task):
    """Targets one after another, each drawn: a direction for some seconds, or a place some way from the last one.

    Of its metrics ``leg_speed`` is the median over the episode's directions, or over its places where there are only
    those, of the way made towards it over the time it took [rod lengths/s]; ``stalled`` the share of these legs below
    0.05; ``stayed`` the share of the time for which it was to stay at a place that it was near enough, 0 where it was
    to stay nowhere.
    """

    goal: Bound = parsed(Bound.parse, Bound("places", True, 6.0))
    headings: float = bounded(0, 1, 0.0, "", "share of the targets that are a direction alone")
    leg_least: float = bounded(0.1, 3600, 2.0, "s", "least time of a direction, or of a stay at a place")
    leg_most: float = bounded(0.1, 3600, 16.0, "s", "most")
    turn_least: float = bounded(0, 180, 0.0, "deg", "least turn from one target to the next, either way")
    turn_most: float = bounded(0, 180, 180.0, "deg", "most")
    drift: float = bounded(0, 90, 0.0, "deg/s", "most that a direction turns slowly, either way")
    near: float = bounded(0.1, 1000, 2.0, "L", "least distance from one place to the next, in rod lengths")
    far: float = bounded(0.1, 1000, 2.0, "L", "most")
    reach: float = bounded(0.05, 100, 0.5, "L", "nearer than this a place is reached")
    stays: float = bounded(0, 1, 0.0, "", "share of the places at which it is to stay")
    within: float = bounded(0.05, 100, 0.3, "L", "nearer than this it stays at a place")

    MEASURES: ClassVar[tuple[str, ...]] = ("places", "places_a_minute", "leg_speed", "stalled", "stayed")
    WORST: ClassVar[Mapping[str, float]] = {"stalled": 1.0}

    def __post_init__(self) -> None:
        super().__post_init__()
        for least, most in (("leg_least", "leg_most"), ("turn_least", "turn_most"), ("near", "far")):
            if getattr(self, least) > getattr(self, most):
                raise DesignError(f"Navigate.{least} = {getattr(self, least):g} is above {most} = "
                                  f"{getattr(self, most):g}; give both, the lesser one first")  # fmt: skip

    def aim(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Targets:
        length, own = robot.design.length, np.random.default_rng(rng.integers(2**63))
        return Targets(robot, self._targets(start.direction, length, own), self.reach * length, self.within * length)

    def _targets(self, angle: float, length: float, rng: np.random.Generator) -> Iterator[Target]:
        """The first in the start's direction; every one takes as many draws."""
        while True:
            alone, time, drift, way, stay, side, turn = rng.random(7)
            seconds = self.leg_least + time * (self.leg_most - self.leg_least)
            if alone < self.headings:
                target = Target(angle, math.inf, seconds, math.radians(self.drift) * (2 * drift - 1))
                yield target
                angle += target.drift * seconds  # the next one turns from where this one has come to
            else:
                distance = (self.near + way * (self.far - self.near)) * length
                yield Target(angle, distance, seconds if stay < self.stays else 0.0, 0.0)
            turn = math.radians(self.turn_least + turn * (self.turn_most - self.turn_least))
            angle += math.copysign(turn, side - 0.5)

    def rewards(self, episode: Progress, progress: float, slip: float, energy: float) -> dict[str, float]:
        goal = cast(Targets, episode.goal)
        return super().rewards(episode, progress, slip, energy) | {"arrive": self.reward.arrive * goal.arrived}

    def measures(self, episode: Progress) -> dict[str, float]:
        goal, length = cast(Targets, episode.goal), episode.robot.design.length
        legs = goal.all_legs()
        legs = [leg for leg in legs if not leg.place] or legs
        speeds = np.array([leg.way / leg.seconds / length for leg in legs])
        return {
            "places": float(goal.places), "places_a_minute": 60 * goal.places / max(episode.gait.duration, 1e-9),
            "leg_speed": float(np.median(speeds)), "stalled": float((speeds < STALLED).mean()),
            "stayed": goal.stayed / goal.stays if goal.stays else 0.0,
        }  # fmt: skip
