"""Task: what is to be done; one notion of it for environments, evaluations and the search."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, TypeVar

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.design.parameters import Payload
from tensegym.errors import DesignError, InputError
from tensegym.physics.terrain import Ground, Terrain, longest_reach
from tensegym.robot.engines import ENGINES
from tensegym.robot.gait import GaitMetrics
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.step_check import LARGEST_TIME_STEP, LEAST_TIME_STEP
from tensegym.tables import Checked, bounded, choice, fill, known, noted, parsed

from .bound import Bound
from .disturbance import Disturbance
from .goal import Goal, Heading
from .progress import Progress
from .reward import RewardWeights
from .start import Start

Own = TypeVar("Own", bound="Task")
_ROOM = 2.0  # m of bumps beyond what a robot makes at 1 m/s


@dataclass(frozen=True, kw_only=True)
class Task(Checked, error=DesignError):
    """Where an episode starts, what is wanted, on what ground, when it ends, what is rewarded and measured.

    A task of your own is a subclass: give ``goal`` a default and change what differs of `aim`, `over`, `rewards` and
    `measures`. docs/extend.md has an example. Every episode starts at rest on a random face, of ``faces`` where they
    are given, at a random heading.

    Raises:
        DesignError: a field is outside its range.
        InputError: the goal bounds a metric that the task does not measure.
    """

    goal: Bound = parsed(Bound.parse, what="bound on a metric, mean over the episodes, that says the task is done")
    motion: str = noted("", "name of the motion; default: that of the class")
    seconds: float = bounded(0.1, 3600, 10.0, "s", "length of an episode")
    settle: float = bounded(0, 60, 0.3, "s", "standing still before it")
    faces: tuple[int, ...] = bounded(0, 9999, (), "", "that it may begin on, more likely the more often one is named; "
                                     "none: any")
    patience: float = bounded(0, 3600, 4.0, "s", "given up without a tip in this time; environments never give up")
    dt: float = bounded(LEAST_TIME_STEP, LARGEST_TIME_STEP, 2e-3, "s", "physics time step")
    engine: str = choice(*ENGINES, what="that steps the robot")
    drop: float = bounded(0, 100, 0.0, "m", "fallen from this height while it settles")
    slope: float = bounded(0, 60, 0.0, "deg", "of the ground, uphill along the wanted direction")
    roughness: float = bounded(0, 0.2, 0.0, "m", "root mean square height of the ground's bumps")
    correlation_length: float = bounded(0.1, 5, 0.3, "m", "of the bumps")
    payload: float = bounded(0, 100, 0.0, "kg", "mass of the payload a design must carry; 0 asks for none")
    disturb: Disturbance = noted(Disturbance(), "what goes otherwise than designed, drawn anew each episode")
    reward: RewardWeights = noted(RewardWeights(), "weights of the reward's terms")

    MEASURES: ClassVar[tuple[str, ...]] = ()
    """Names of the metrics of its own."""
    WORST: ClassVar[Mapping[str, float]] = {}
    """What they are taken as in an episode that cannot be believed; 0 where nothing is said."""

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "motion", self.motion or type(self).__name__)
        if self.goal.metric not in self.metrics():
            raise InputError(f"goal {self.goal}: no metric measures {self.goal.metric!r}; one of "
                             f"{', '.join(self.metrics())}")  # fmt: skip
        longest = longest_reach(self.correlation_length) - _ROOM
        if self.roughness and self.seconds > longest:
            raise DesignError(f"{type(self).__name__}.seconds = {self.seconds!r} is too long for rough ground: over "
                              f"{longest:g} s; give less, or a longer correlation_length")  # fmt: skip

    @classmethod
    def metrics(cls) -> tuple[str, ...]:
        """Names of all metrics that an episode of it has."""
        return (*(f.name for f in fields(GaitMetrics)), "drive_load", "stride", "mass", *cls.MEASURES)

    def ground(self, design: RobotDesign) -> bool | Terrain | Ground:
        """What a robot of a design is put on: the plane, or bumps further than a robot gets at 1 m/s, some twice what
        the fastest ones make."""
        if not self.roughness:
            return True
        return Terrain(self.roughness, self.correlation_length, reach=_ROOM + self.seconds)

    def equipped(self, design: RobotDesign) -> RobotDesign:
        """The design with the payload that the task asks for."""
        if not self.payload:
            return design
        return design.with_(payload=replace(design.payload or Payload(), mass=self.payload))

    def robot(self, design: RobotDesign, gui: bool = False) -> TensegrityRobot:
        """A robot on its ground, in its engine. Raises as TensegrityRobot, and DesignError where it lacks one of the
        faces to begin on."""
        robot = TensegrityRobot(design, dt=self.dt, ground=self.ground(design), gui=gui, engine=self.engine)
        last = len(robot.faces.triangles) - 1
        if self.faces and max(self.faces) > last:
            robot.close()
            raise DesignError(f"{type(self).__name__}.faces: {max(self.faces)} is outside 0..{last}, the faces of "
                              f"{design.name!r}")  # fmt: skip
        return robot

    def changed(self: Own, **changes: Any) -> Own:
        """A copy with the fields that are not None replaced; ``reward`` may be a dict of weights to change,
        ``disturb`` one of ranges."""
        given = {name: value for name, value in changes.items() if value is not None}
        known(given, [f.name for f in fields(self)], f"the task {self.motion!r}", DesignError)
        if isinstance(given.get("disturb"), dict):
            given["disturb"] = fill(Disturbance, given["disturb"], "disturb", DesignError, self.disturb)
        if isinstance(given.get("reward"), dict):
            given["reward"] = self.reward.changed(given["reward"])
        return replace(self, **given)

    # -- what a task may change ---------------------------------------------------------------------------------------

    def aim(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Goal:
        """What an episode wants of the robot, which stands as it starts but has not settled yet."""
        return Heading.at(start.direction)

    def over(self, episode: Progress) -> str | None:
        """Why an episode has ended after a control step; None while it goes on."""
        return None

    def rewards(self, episode: Progress, progress: float, slip: float, energy: float) -> dict[str, float]:
        """Signed reward terms of one control step; the reward is their sum.

        Args:
            progress: of the centre of mass along the wanted direction [rod lengths].
            slip: path of the grounded feet's centres, mean over the feet [rod lengths].
            energy: drawn by the drives [J].
        """
        w = self.reward
        return {"progress": w.progress * progress, "slip": -w.slip * slip, "energy": -w.energy * energy}

    def measures(self, episode: Progress) -> dict[str, float]:
        """The metrics named in MEASURES, of an episode that has ended."""
        return {}

    # -- what all tasks share -----------------------------------------------------------------------------------------

    def begin(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Goal:
        """Stand the robot as an episode begins, settled. Raises SimulationError where that diverges."""
        robot.reset(start.face, start.heading, self.drop)
        goal = self.aim(robot, start, rng)
        robot.slope(math.radians(self.slope), goal.bearing(robot).direction)
        robot.step(round(self.settle / robot.dt))
        return goal

