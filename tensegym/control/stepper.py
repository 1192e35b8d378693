"""The stepper: from any face onto a chosen one, in closed loop. It looks whether the robot has tipped, and where to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import Checked, noted

from .bearing import Bearing
from .hold import PERIOD, REST, Attempt, Hold
from .made_for import MadeFor, check_table
from .tipping import current_face

_SWEEPS = 60  # of the iteration over values
_SEEN = 0.7  # what an end counts that was seen now, against all that were before
_FAR = 1e3  # holds: from where no hold leads on


@dataclass(frozen=True)
class StepperSettings(Checked, error=DesignError):
    """How it steps."""

    around: bool = noted(True, "whether it may go by a third face, where that takes fewer holds than going straight")


class Stepper:
    """Steps onto the neighbour whose edge lies nearest the first bearing it is told, and rests there.

    A hold is chosen by the fewest holds that are expected to the face wanted (value iteration over the table's shares).
    Where it led is seen, and counts for more than the table from then on: another is tried where one did not tip the
    robot, or tipped it elsewhere.

    Args:
        table: of holds, of a design with the same members.
        settings: how it steps.
        made_for: the robot of the table, where that is known.
    """

    period = PERIOD

    def __init__(
        self, table: Sequence[Hold], settings: StepperSettings | None = None, made_for: MadeFor | None = None
    ) -> None:
        self._table, self._settings, self._made_for = table, settings or StepperSettings(), made_for

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        """As `Controller` has it. Raises DesignError where the table is of a robot with other faces, rods or drives."""
        faces = {hold.from_face for hold in self._table} | {face for hold in self._table for face, _ in hold.ends}
        check_table(self._made_for, faces, len(self._table[0].parts), robot, "the table of holds",
                    "make its own by `python benchmarks/holds.py --design FILE`")  # fmt: skip
        self._wanted: int | None = None
        self._attempt: Attempt | None = None
        self._hold: Hold | None = None
        self._let_go = -math.inf
        self._holds = list(self._table)

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        """As `Controller` has it."""
        released, face = np.zeros(len(robot.drives)), current_face(robot)
        if self._wanted is None:
            self._wanted, self._first = neighbour_towards(robot, face, bearing.direction), face
        if self._attempt is None:
            if robot.time - self._let_go < REST - 1e-9:
                return released
            if self._hold:
                self._learn(self._hold, face)
            self._hold = None if face == self._wanted else self._choose(face)
            if self._hold is None:
                return released
            self._attempt = Attempt(robot, self._hold.parts)
        elif self._attempt.over(robot):
            self._attempt, self._let_go = None, robot.time
            return released
        return self._attempt.angles

    def _choose(self, face: int) -> Hold | None:
        """The hold from a face after which the fewest are expected; None where there is none at all."""
        left = holds_left(self._holds, self._wanted or 0, here=None if self._settings.around else self._first)
        here = [hold for hold in self._holds if hold.from_face == face]
        return min(here, key=lambda hold: _expected(hold, left), default=None)

    def _learn(self, hold: Hold, end: int) -> None:
        """Let a hold be expected to end where it has just ended."""
        shares = {face: (1 - _SEEN) * share for face, share in hold.ends}
        shares[end] = shares.get(end, 0.0) + _SEEN
        self._holds[self._holds.index(hold)] = replace(hold, ends=tuple(shares.items()))


def neighbour_towards(robot: TensegrityRobot, face: int, direction: FloatArray) -> int:
    """The face across the edge that lies most along a direction (2,)."""
    corners = robot.node_positions_in_world()[robot.faces.triangles[face]][:, :2]
    outward = [corners[[edge, (edge + 1) % 3]].mean(axis=0) - corners.mean(axis=0) for edge in range(3)]
    along = [float(out @ direction) / float(np.linalg.norm(out)) for out in outward]
    neighbours: IntArray = robot.faces.neighbours[face]
    return int(neighbours[int(np.argmax(along))])


def holds_left(table: Sequence[Hold], wanted: int, here: int | None = None) -> dict[int, float]:
    """How many holds are expected from each face to the one wanted, going by the best; with ``here`` by none but it."""
    left = {hold.from_face: _FAR for hold in table} | {wanted: 0.0}
    ways = {face: [hold for hold in table if hold.from_face == face] for face in left}
    for _ in range(_SWEEPS):
        for face, holds in ways.items():
            if face != wanted and here in (None, face):
                left[face] = min([_FAR, *(_expected(hold, left) for hold in holds)])
    return left


def _expected(hold: Hold, left: dict[int, float]) -> float:
    """Holds expected after choosing this one until it leads away: ends where it began are tried again."""
    stays = hold.leads_to(hold.from_face)
    if stays >= 1:
        return _FAR
    return (1 + sum(share * left.get(face, _FAR) for face, share in hold.ends if face != hold.from_face)) / (1 - stays)
