"""StepOnto: the paper's own motion, from one face onto a chosen neighbour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, cast

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.bearing import Bearing
from tensegym.control.tipping import current_face
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import bounded, parsed

from .bound import Bound
from .goal import Goal
from .progress import Progress
from .start import Start
from .task import Task

STILL = 0.05  # m/s: a robot none of whose nodes is faster rests


class Neighbour(Goal):
    """Across one edge of the face the robot stands on, onto the next face.

    Args:
        across: (2,) unit vector, from the face's middle across the edge.
        start, face: indices of the face it stands on, and of the one to arrive on.
    """

    def __init__(self, across: FloatArray, start: int, face: int) -> None:
        self._across, self.face = across, face
        self.rested = 0.0
        """For how long it has rested there so far, without a break [s]."""
        self.around = False
        """Whether it rested on a third face on its way."""
        self._own = {start, face}

    def bearing(self, robot: TensegrityRobot) -> Bearing:
        """As `Goal` has it."""
        return Bearing(self._across)

    def update(self, robot: TensegrityRobot, way: float, seconds: float) -> None:
        """As `Goal` has it."""
        still = bool(np.linalg.norm(robot.nodes_in_world()[1], axis=1).max() < STILL)
        here = current_face(robot)
        self.rested = self.rested + seconds if still and here == self.face else 0.0
        self.around |= still and here not in self._own


@dataclass(frozen=True, kw_only=True)
class StepOnto(Task):
    """Tip onto a neighbour of the face it stands on, drawn at random; the wanted direction is across their edge.

    An episode ends with its first tip; with ``rest`` when it has rested so long on the face wanted, however many tips
    that took. Of its metrics ``arrived`` is 1 where it is (or rested) there, ``direct`` the same where it rested on no
    third face before.
    """

    goal: Bound = parsed(Bound.parse, Bound("arrived", True, 0.9))
    rest: float = bounded(0, 60, 0.0, "s", "to be rested on the face wanted; 0: the first tip is all")

    MEASURES: ClassVar[tuple[str, ...]] = ("arrived", "direct")

    def aim(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Neighbour:
        edge = int(rng.integers(3))
        corners = robot.node_positions_in_world()[robot.faces.triangles[start.face]][:, :2]
        across = corners[[edge, (edge + 1) % 3]].mean(axis=0) - corners.mean(axis=0)
        return Neighbour(across / np.linalg.norm(across), start.face, int(robot.faces.neighbours[start.face, edge]))

    def over(self, episode: Progress) -> str | None:
        if self.rest:
            return "arrived" if self._rested(episode) else None
        return "tipped" if episode.meter.tips else None

    def measures(self, episode: Progress) -> dict[str, float]:
        goal = cast(Neighbour, episode.goal)
        there = self._rested(episode) if self.rest else episode.meter.face == goal.face
        return {"arrived": float(episode.sound and there), "direct": float(episode.sound and there and not goal.around)}

    def _rested(self, episode: Progress) -> bool:
        return cast(Neighbour, episode.goal).rested >= self.rest - 1e-9
