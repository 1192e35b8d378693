"""The planner: A* over a table of tips to the place to go to, played pull by pull and planned anew after each.

As planners of published tensegrity robots do it, over motions that were tabulated beforehand. What is learned is
measured against it.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import bounded

from .bearing import Bearing
from .made_for import MadeFor
from .tipping import Pull, Tip, current_face, face_direction
from .walker import Walker, WalkerSettings

_FAR = 3.0  # rod lengths: a place beyond it is planned for as far as this
_CELL, _SECTORS = 0.15, 24  # of the states that count as one: rod lengths, parts of a turn
_MOST = 4000  # states looked at for a plan


@dataclass(frozen=True)
class PlannerSettings(WalkerSettings):
    """How a table's pulls are played, and how near a plan has to come."""

    reach: float = bounded(0.05, 10, 0.4, "L", "a plan ends nearer than this to the place, in rod lengths")


class Pose(NamedTuple):
    """Standing somewhere: a state of the search."""

    face: int
    x: float
    y: float
    angle: float
    """Of the face, see `face_direction` [rad]."""


class Planner(Walker):
    """A walker that looks ahead.

    Args:
        table: of tips with their turns, of a design with the same members; None makes the robot's own.
        settings: how its pulls are played.
        period: a command is held for this long [s].
        made_for: the robot of the table, where that is known.
    """

    def __init__(
        self, table: Sequence[Tip] | None, settings: PlannerSettings | None = None, period: float = 0.1,
        made_for: MadeFor | None = None,
    ) -> None:  # fmt: skip
        settings = settings or PlannerSettings()
        super().__init__(table, settings, period, made_for)
        self._reach = settings.reach

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        """As `Controller` has it. Raises DesignError as `Walker.begin`, or where the table has no turns."""
        super().begin(robot, seed)
        if any(tip.turn is None for tips in self._by_face.values() for tip in tips):
            raise DesignError("the table of tips has no turns: make it anew with `tensegym step --all-faces`")
        self._moves = {face: _distinct(tips, robot.design.length) for face, tips in self._by_face.items()}
        ways = [math.hypot(*tip.travel) for tips in self._moves.values() for tip in tips]
        self._longest = max(ways, default=1.0)

    def choose(self, robot: TensegrityRobot, bearing: Bearing) -> Pull:
        """The first pull of the shortest plan found; the one that leads nearest the bearing where there is none."""
        length, face = robot.design.length, current_face(robot)
        angle = face_direction(robot, face, robot.node_positions_in_world())
        goal = min(bearing.distance, _FAR * length) * bearing.direction
        plan = self._plan(Pose(face, 0.0, 0.0, angle), goal, length)
        return plan[0].pull if plan else super().choose(robot, bearing)

    def _plan(self, start: Pose, goal: FloatArray, length: float) -> list[Tip]:
        """A*: fewest pulls to within reach of ``goal`` (2,) [m], or to the state nearest to it that was found."""
        order, seen = itertools.count(), {_cell(start, length)}
        nearest, plan = float(np.hypot(*goal)), list[Tip]()
        queue = [(0.0, next(order), start, plan)]
        while queue and len(seen) < _MOST:
            _, _, pose, come = heapq.heappop(queue)
            left = math.hypot(goal[0] - pose.x, goal[1] - pose.y)
            if left < nearest:
                nearest, plan = left, come
            if left <= self._reach * length:
                return come
            for tip in self._moves.get(pose.face, ()):
                there = _after(pose, tip)
                cell = _cell(there, length)
                if cell in seen:
                    continue
                seen.add(cell)
                more = max(0.0, math.hypot(goal[0] - there.x, goal[1] - there.y) - self._reach * length) / self._longest
                heapq.heappush(queue, (len(come) + 1 + more, next(order), there, [*come, tip]))
        return plan


def _after(pose: Pose, tip: Tip) -> Pose:
    c, s = math.cos(pose.angle), math.sin(pose.angle)
    dx, dy = tip.travel
    return Pose(tip.to_face, pose.x + c * dx - s * dy, pose.y + s * dx + c * dy, pose.angle + (tip.turn or 0.0))


def _cell(pose: Pose, length: float) -> tuple[int, int, int, int]:
    sector = round(pose.angle / (2 * math.pi) * _SECTORS) % _SECTORS
    return pose.face, round(pose.x / length / _CELL), round(pose.y / length / _CELL), sector


def _distinct(tips: Sequence[Tip], length: float) -> list[Tip]:
    """One of those that lead to about the same pose: the one that pulls the least."""
    kept: dict[tuple[int, int, int, int], Tip] = {}
    for tip in sorted(tips, key=lambda tip: tip.peak_tension):
        kept.setdefault(_cell(_after(Pose(tip.from_face, 0.0, 0.0, 0.0), tip), length), tip)
    return list(kept.values())
