"""The open-loop walker: from a table of which pull tips which face where, the pull that leads nearest the heading.

A table takes minutes to make for a design. `WalkerController` plays that of another design of the same topology.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.parameters import bounded, check_ranges
from tensegym.errors import DesignError, InputError
from tensegym.robot.robot import TensegrityRobot

from .tipping import Pull, Tip, current_face, face_direction


class Walker:
    """Looks at the face it stands on only when a pull is over; in between it plays commands blindly."""

    def __init__(self, table: Sequence[Tip], played: Callable[[Pull], Pull] = lambda pull: pull) -> None:
        """played: what becomes of a pull of the table on this robot."""
        self._played = played
        self._by_face: dict[int, list[Tip]] = {}
        for tip in table:
            if tip.tipped:
                self._by_face.setdefault(tip.from_face, []).append(tip)
        self._fallback = max(table, key=lambda tip: len(tip.pull.drives)).pull
        self.restart()

    def restart(self) -> None:
        """Forget the pull in progress."""
        self._pull: Pull | None = None
        self._since = 0.0

    def angles(self, robot: TensegrityRobot, direction: FloatArray) -> FloatArray:
        """Commanded spool angles (w,) [rad] now; direction (2,) is the wanted heading in the world."""
        if self._pull is None or robot.time - self._since >= self._pull.duration - 1e-9:
            self._pull, self._since = self._played(self.choose(robot, direction)), robot.time
        return self._pull.angles(robot, robot.time - self._since)

    def choose(self, robot: TensegrityRobot, direction: FloatArray) -> Pull:
        """The pull from the table whose travel points most along ``direction``; a deep one where none tips."""
        face = current_face(robot)
        tips = self._by_face.get(face)
        if not tips:
            return replace(self._fallback, depth=robot.design.stiff_cable.max_pull)
        angle = face_direction(robot, face, robot.node_positions_in_world())
        wanted = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) @ direction
        return max(tips, key=lambda tip: float(wanted @ tip.travel)).pull


@dataclass(frozen=True)
class Playing:
    """How a table's pulls are played on a design. Raises DesignError naming the field that is out of its range."""

    depth: float = bounded(0, 1, 1.0, "", "of the table's deepest pull, as a part of max_pull", open_low=True)
    pull_time: float = bounded(0.1, 60, 2.0, "s", "wound in for this long")
    release_time: float = bounded(0.1, 60, 1.6, "s", "let out for this long")

    def __post_init__(self) -> None:
        check_ranges(self)


class WalkerController:
    """A walker driving a robot towards a direction (2,), with another design's table of tips played as told.

    Raises DesignError where the robot has other numbers of faces or drives than the one the table is of.
    """

    period = 0.1  # s: a command is held for this long

    def __init__(self, robot: TensegrityRobot, playing: Playing, direction: FloatArray, table: Sequence[Tip]) -> None:
        tabled = 1 + max(tip.from_face for tip in table), 1 + max(max(tip.pull.drives) for tip in table)
        here = len(robot.faces.triangles), len(robot.drives)
        if tabled != here:
            raise DesignError(
                f"the walker's table is of a robot with {tabled[0]} faces and {tabled[1]} drives, this one has "
                f"{here[0]} and {here[1]}; take the pattern generator (kind = 'cpg')"
            )
        deepest = robot.design.stiff_cable.max_pull
        scale = playing.depth * deepest / max(tip.pull.depth for tip in table)

        def played(pull: Pull) -> Pull:
            return Pull(pull.drives, min(scale * pull.depth, deepest), playing.pull_time, playing.release_time)

        self._walker, self._robot, self._direction = Walker(table, played), robot, direction

    def angles(self) -> FloatArray:
        """Commanded spool angles (w,) [rad] for the next period."""
        return self._walker.angles(self._robot, self._direction)


def save_table(table: Sequence[Tip], path: Path) -> None:
    """Write a table of tips as JSON."""
    path.write_text(json.dumps([asdict(tip) for tip in table]))


def load_table(path: Path) -> list[Tip]:
    """Read what `save_table` wrote."""
    if not path.is_file():
        raise FileNotFoundError(f"no table of tips {path}; make one with `tensegym step --all-faces --out DIR`")
    try:
        return [
            Tip(Pull(**(row["pull"] | {"drives": tuple(row["pull"]["drives"])})), row["from_face"], row["to_face"],
                tuple(row["travel"]), row["peak_tension"])
            for row in json.loads(path.read_text())
        ]  # fmt: skip
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path} is not a table of tips: {error}") from error
