"""The open-loop walker: from a table of which pull tips which face where, the pull that leads nearest the heading.

A table takes minutes to make for a design; that of another design with the same members will do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError, InputError
from tensegym.files import write_json
from tensegym.robot.reading import heading_rotation
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import Checked, bounded, read_records

from .bearing import Bearing
from .made_for import KEY, MadeFor, check_table
from .tipping import Pull, Tip, current_face, face_direction, tip_table

_REMEDY = "make its own by `tensegym step --all-faces --design FILE --out DIR`, or say tips = 'own'"


@dataclass(frozen=True)
class WalkerSettings(Checked, error=DesignError):
    """How a table's pulls are played on a design. Raises DesignError naming the field that is out of its range."""

    depth: float = bounded(0, 1, 1.0, "", "of the table's deepest pull, as a part of max_pull", open_low=True)
    pull_time: float = bounded(0.1, 60, 2.0, "s", "wound in for this long")
    release_time: float = bounded(0.1, 60, 1.6, "s", "let out for this long")


class Walker:
    """Looks at the face it stands on only when a pull is over; in between it plays commands blindly.

    Args:
        table: of tips, of a design with the same members; None makes the robot's own, which takes minutes.
        settings: how its pulls are played.
        period: a command is held for this long [s].
        made_for: the robot of the table, where that is known.
    """

    def __init__(
        self, table: Sequence[Tip] | None, settings: WalkerSettings | None = None, period: float = 0.1,
        made_for: MadeFor | None = None,
    ) -> None:  # fmt: skip
        self._settings, self.period = settings or WalkerSettings(), period
        self._own, self._table, self._made_for = table is None, table, made_for
        self._by_face: dict[int, list[Tip]] = {}

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        """As `Controller` has it. Raises DesignError where the table is of a robot with other faces, rods or drives."""
        if self._own and (self._made_for is None or self._made_for.differs(MadeFor.like(robot))):
            with TensegrityRobot(robot.design, dt=robot.dt, engine=robot.engine) as other:
                self._table, self._made_for = tip_table(other), MadeFor.like(other)
            self._by_face = {}
        table = self._table or ()
        if not self._by_face:
            self._read(table)
        check_table(self._made_for, (tip.from_face for tip in table), self._drives, robot, "the table of tips", _REMEDY)
        self._deepest = robot.design.deepest_pull
        self._scale = self._settings.depth * self._deepest / self._depth
        self._pull: Pull | None = None
        self._since = 0.0

    def _read(self, table: Sequence[Tip]) -> None:
        """What every episode asks of the table."""
        self._drives = 1 + max(max(tip.pull.drives) for tip in table)
        self._depth = max(tip.pull.depth for tip in table)
        self._fallback = max(table, key=lambda tip: len(tip.pull.drives)).pull
        for tip in table:
            if tip.tipped:
                self._by_face.setdefault(tip.from_face, []).append(tip)

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        """As `Controller` has it."""
        if self._pull is None or robot.time - self._since >= self._pull.duration - 1e-9:
            self._pull, self._since = self._played(self.choose(robot, bearing)), robot.time
        return self._pull.angles(robot, robot.time - self._since)

    def _played(self, pull: Pull) -> Pull:
        """What becomes of a pull of the table on this robot."""
        depth = min(self._scale * pull.depth, self._deepest)
        return Pull(pull.drives, depth, self._settings.pull_time, self._settings.release_time)

    def choose(self, robot: TensegrityRobot, bearing: Bearing) -> Pull:
        """The pull from the table whose travel points most along the bearing; a deep one where none tips."""
        face = current_face(robot)
        tips = self._by_face.get(face)
        if not tips:
            return replace(self._fallback, depth=self._deepest)
        angle = face_direction(robot, face, robot.node_positions_in_world())
        wanted = heading_rotation(np.array([np.cos(angle), np.sin(angle)]))[:2, :2] @ bearing.direction
        return max(tips, key=lambda tip: float(wanted @ tip.travel)).pull


def save_table(table: Sequence[Tip], path: Path, made_for: MadeFor) -> None:
    """Write a table of tips, and of which robot they are, as JSON."""
    write_json(path, {KEY: asdict(made_for), "tips": [asdict(tip) for tip in table]})


def load_table(path: Path) -> list[Tip]:
    """Read what `save_table` wrote. Raises InputError naming the row and the field, or FileNotFoundError."""
    return read_records(path, "tips", Tip, "tensegym step --all-faces --out DIR", InputError)
