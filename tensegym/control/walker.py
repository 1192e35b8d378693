"""The open-loop walker: from a table of which pull tips which face where, the pull that leads nearest the heading."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from tensegym.errors import InputError
from tensegym.robot import TensegrityRobot
from tensegym.structure import FloatArray

from .tipping import Pull, Tip, current_face, face_direction


class Walker:
    """Looks at the face it stands on only when a pull is over; in between it plays commands blindly."""

    def __init__(self, table: Sequence[Tip]) -> None:
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
            self._pull, self._since = self.choose(robot, direction), robot.time
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
