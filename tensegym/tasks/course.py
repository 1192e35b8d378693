"""Course: past an obstacle, or past all of them in a row."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, cast

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError
from tensegym.physics.terrain import Ground
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import bounded, choice, parsed, show

from .bound import Bound
from .follow import WORST_OFF
from .lane import Lane, Layout
from .obstacles import OBSTACLES, Sizes
from .progress import Progress
from .start import Start
from .task import Task

ALL = "all"


@dataclass(frozen=True, kw_only=True)
class Course(Sizes, Task):
    """Pass an obstacle: the whole robot beyond its far end, in the time there is, and never out of the lane.

    The lane lies along the world's x from the start on; the robot's face and heading are drawn. Of its metrics
    ``success`` is 1 where all obstacles were passed, ``passed`` how many were, in their order, ``passing_time`` how
    long that took [s] (the whole time where it was not done), ``cross_track`` the root mean square distance from the
    lane's middle [rod lengths].
    """

    goal: Bound = parsed(Bound.parse, Bound("success", True, 0.7))
    seconds: float = bounded(0.1, 3600, 180.0, "s", "length of an episode; it ends when all is passed")
    stuck: float = bounded(0.1, 3600, 40.0, "s", "given up where it has come no further for so long")
    obstacle: str = choice(*OBSTACLES, ALL, what="that is to be passed; all of them in a row")
    ahead: float = bounded(0.1, 10, 1.0, "L", "the wanted direction points to where the lane's middle is so far ahead")

    MEASURES: ClassVar[tuple[str, ...]] = ("success", "passed", "passing_time", "cross_track")
    WORST: ClassVar[Mapping[str, float]] = {"passing_time": 3600.0, "cross_track": WORST_OFF}

    def __post_init__(self) -> None:
        if self.roughness:
            raise DesignError(f"{type(self).__name__}.roughness = {show(self.roughness)}: a course is rough by its "
                              "bumps, in rod lengths; give obstacle = 'rough' and bumps")  # fmt: skip
        super().__post_init__()
        if self.corridor > self.lane:
            raise DesignError(f"{type(self).__name__}.corridor = {self.corridor:g} is wider than lane = {self.lane:g}; "
                              "give a wider lane")  # fmt: skip

    @property
    def names(self) -> tuple[str, ...]:
        """Of its obstacles, in their order."""
        return tuple(OBSTACLES) if self.obstacle == ALL else (self.obstacle,)

    def layout(self, length: float) -> Layout:
        """Where they lie, for rods of a length [m]."""
        return Layout([OBSTACLES[name](self) for name in self.names], self.before, length)

    def ground(self, design: RobotDesign) -> Ground:
        """With the obstacles on it."""
        return self.layout(design.length).ground(self.lane, self.bumps, self.bump_length)

    def aim(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Lane:
        length = robot.design.length
        here = robot.centre_of_mass_in_world()[:2]
        return Lane(here, self.layout(length).ends, 0.5 * self.lane * length, self.ahead * length)

    def over(self, episode: Progress) -> str | None:
        goal = cast(Lane, episode.goal)
        if goal.left:
            return "left the lane"
        return "passed" if goal.done else "stuck" if goal.idle > self.stuck else None

    def measures(self, episode: Progress) -> dict[str, float]:
        goal, length = cast(Lane, episode.goal), episode.robot.design.length
        return {"success": float(goal.done), "passed": float(goal.passed),
                "passing_time": goal.seconds if goal.done else self.seconds,
                "cross_track": goal.off / length}  # fmt: skip
