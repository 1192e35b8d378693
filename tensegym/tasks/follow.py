"""Follow: go along a line, an arc, a triangle, a figure of eight, or a path of one's own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, cast

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import as_rows, bounded, choice, parsed

from .bound import Bound
from .path import SHAPES, Path, sampled
from .progress import Progress
from .start import Start
from .task import Task

Corners = tuple[tuple[float, float], ...]
WORST_OFF = 1e3  # rod lengths, in an episode that cannot be believed
_CLEAR = 0.5  # rod lengths: a path of one's own that comes this near its start again is taken for one through it


def read_corners(value: Any) -> Corners:
    """Corners of a path from rows of two numbers. Raises DesignError where they are no path that begins once."""
    rows = as_rows(value, 2, "corners", DesignError, "x, y in rod lengths")
    if not len(rows):
        return ()
    if len(rows) < 2 or not np.linalg.norm(np.diff(rows, axis=0), axis=1).all():
        raise DesignError("corners of a path: two or more, each another one than the one before")
    if np.abs(rows).max() > 1e4:
        raise DesignError(f"corners of a path lie within 1e4 rod lengths; given {np.abs(rows).max():g}")
    from_start = np.linalg.norm(sampled(rows) - rows[0], axis=1)
    left = int((from_start > _CLEAR).argmax())  # 0: it never leaves
    if not left or from_start[left:].min() < _CLEAR:
        raise DesignError(f"the path of these corners comes within {_CLEAR:g} rod lengths of its own start again, or "
                          "never leaves it: end it before, begin elsewhere on it, or take a shape")  # fmt: skip
    return tuple((float(x), float(y)) for x, y in rows)


@dataclass(frozen=True, kw_only=True)
class Follow(Task):
    """Go along a path on the ground. It begins where the robot stands, towards the start's direction.

    Of its metrics ``cross_track`` is the root mean square distance from the path [rod lengths], ``followed`` the share
    of it that the robot has come along, ``path_speed`` that way over the time [rod lengths/s].
    """

    goal: Bound = parsed(Bound.parse, Bound("cross_track", False, 0.5))
    seconds: float = bounded(0.1, 3600, 120.0, "s", "length of an episode; it ends with the path's end")
    shape: str = choice(*SHAPES, default="eight", what="of the path, where no corners are given")
    size: float = bounded(0.5, 1000, 6.0, "L", "of the shape, in rod lengths")
    corners: Corners = parsed(read_corners, (), "of a path of one's own [L], x along the start's direction")
    ahead: float = bounded(0.1, 10, 1.0, "L", "the wanted direction points to where the path is so far ahead")
    reach: float = bounded(0.05, 10, 0.5, "L", "nearer than this the end is reached")

    MEASURES: ClassVar[tuple[str, ...]] = ("cross_track", "followed", "path_speed")
    WORST: ClassVar[Mapping[str, float]] = {"cross_track": WORST_OFF}

    def line(self, length: float, start: FloatArray, angle: float) -> FloatArray:
        """(n, 2) points along the path [m], for rods of a length [m], from ``start`` (2,) on, at an angle [rad]."""
        corners = np.array(self.corners) if self.corners else self.size * SHAPES[self.shape]()
        c, s = math.cos(angle), math.sin(angle)
        return start + length * sampled(corners - corners[0]) @ np.array([[c, s], [-s, c]])

    def aim(self, robot: TensegrityRobot, start: Start, rng: np.random.Generator) -> Path:
        length = robot.design.length
        points = self.line(length, robot.centre_of_mass_in_world()[:2], start.direction)
        return Path(points, self.ahead * length, self.reach * length)

    def over(self, episode: Progress) -> str | None:
        return "came to the path's end" if cast(Path, episode.goal).ended else None

    def measures(self, episode: Progress) -> dict[str, float]:
        path, length = cast(Path, episode.goal), episode.robot.design.length
        come = path.share * path.length / length
        return {"cross_track": path.off / length, "followed": path.share,
                "path_speed": come / max(episode.gait.duration, 1e-9)}  # fmt: skip
