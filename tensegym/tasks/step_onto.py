"""StepOnto: the paper's own motion, from one face onto a chosen neighbour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, cast

import numpy as np

from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import parsed

from .bound import Bound
from .goal import Neighbour
from .progress import Progress
from .start import Start
from .task import Task


@dataclass(frozen=True, kw_only=True)
class StepOnto(Task):
    """Tip onto a neighbour of the face it stands on, drawn at random; the wanted direction is across their edge.

    An episode ends with its first tip.
    """

    goal: Bound = parsed(Bound.parse, Bound("arrived", True, 0.9))

    MEASURES: ClassVar[tuple[str, ...]] = ("arrived",)

    def aim(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Neighbour:
        edge = int(rng.integers(3))
        corners = robot.node_positions_in_world()[robot.faces.triangles[start.face]][:, :2]
        across = corners[[edge, (edge + 1) % 3]].mean(axis=0) - corners.mean(axis=0)
        return Neighbour(across / np.linalg.norm(across), int(robot.faces.neighbours[start.face, edge]))

    def over(self, episode: Progress) -> str | None:
        return "tipped" if episode.meter.tips else None

    def measures(self, episode: Progress) -> dict[str, float]:
        return {"arrived": float(episode.sound and episode.meter.face == cast(Neighbour, episode.goal).face)}
