"""Obstacles of a course: flat blocks, a corridor, a low bar, an incline, rough ground; as boxes and heights."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.errors import DesignError
from tensegym.physics.box import Box
from tensegym.tables import Checked, bounded

_WALL, _WALL_HEIGHT, _SUNK = 0.2, 0.5, 0.3  # L: thickness and height of walls; how deep boxes reach into the ground


@dataclass(frozen=True, kw_only=True)
class Sizes(Checked, error=DesignError):
    """Sizes of obstacles, in rod lengths; the way leads along the world's x, the lane lies about it."""

    lane: float = bounded(1.5, 50, 4.0, "L", "width of the lane, which the robot must not leave")
    before: float = bounded(1.5, 50, 1.5, "L", "level way before each obstacle")
    stretch: float = bounded(0.5, 50, 3.0, "L", "length of blocks, of the corridor, of rough ground")
    block: float = bounded(0.05, 5, 0.4, "L", "side of a block; they stand like a chessboard's black squares")
    block_height: float = bounded(0.005, 1, 0.05, "L", "of the blocks")
    corridor: float = bounded(1, 50, 2.0, "L", "between its walls, which are half a rod length high")
    bar_height: float = bounded(0.005, 1, 0.1, "L", "of the bar's top; it lies across the lane, as thick as it is high")
    incline: float = bounded(0, 45, 10.0, "deg", "up and down again")
    ramp: float = bounded(0.2, 50, 2.0, "L", "horizontal length of the way up, and of the way down")
    summit: float = bounded(0.1, 50, 1.0, "L", "of the level part between")
    bumps: float = bounded(0, 0.3, 0.03, "L", "root mean square height of rough ground")
    bump_length: float = bounded(0.15, 5, 0.4, "L", "correlation length of its bumps")


class Obstacle(NamedTuple):
    """One that begins at 0 along the way, in rod lengths."""

    length: float
    boxes: tuple[Box, ...] = ()
    rough: bool = False
    """Whether the ground is."""


def blocks(sizes: Sizes) -> Obstacle:
    """Flat ones, low enough to step on, with gaps as wide as they are."""
    side, high = sizes.block, sizes.block_height
    half = math.ceil(0.5 * sizes.lane / side)
    rows = max(1, round(sizes.stretch / side))
    return Obstacle(rows * side, tuple(
        Box.between((row * side, place * side, -_SUNK), ((row + 1) * side, (place + 1) * side, high))
        for row in range(rows) for place in range(-half, half) if (row + place) % 2
    ))  # fmt: skip


def corridor(sizes: Sizes) -> Obstacle:
    """Two walls to go between, which open towards the robot over the width of the lane."""
    inner, mouth = 0.5 * sizes.corridor, 0.5 * (sizes.lane - sizes.corridor)
    end, walls = mouth + sizes.stretch, []
    for side in (1, -1):
        walls.append(_wall((mouth, side * inner), (end, side * inner), side))
        if mouth:
            walls.append(_wall((0.0, side * (inner + mouth)), (mouth, side * inner), side))
    return Obstacle(end, tuple(walls))


def _wall(start: tuple[float, float], end: tuple[float, float], side: int) -> Box:
    """Whose face towards the lane's middle goes from start to end; side: 1 where it stands to the left."""
    along = np.subtract(end, start)
    angle, run = math.atan2(along[1], along[0]), float(np.hypot(*along))
    x, y = np.add(start, end) / 2 + side * 0.5 * _WALL * np.array([-math.sin(angle), math.cos(angle)])
    turn = (0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))
    return Box((x, y, 0.5 * (_WALL_HEIGHT - _SUNK)), (0.5 * run, 0.5 * _WALL, 0.5 * (_WALL_HEIGHT + _SUNK)), turn)


def bar(sizes: Sizes) -> Obstacle:
    """To be passed over: a robot that is as high as its rods are long fits under nothing that is low."""
    high, half = sizes.bar_height, 0.5 * sizes.lane
    return Obstacle(high, (Box.between((0.0, -half, -_SUNK), (high, half, high)),))


def incline(sizes: Sizes) -> Obstacle:
    """Up, some way level, and down."""
    angle, half = math.radians(sizes.incline), 0.5 * sizes.lane
    rise, top = sizes.ramp * math.tan(angle), sizes.ramp + sizes.summit
    level = Box.between((sizes.ramp, -half, -_SUNK), (top, half, max(rise, 1e-3)))
    return Obstacle(top + sizes.ramp, (
        _ramp(0.0, sizes.ramp, angle, half), level, _ramp(top + sizes.ramp, -sizes.ramp, -angle, half)
    ) if rise else ())  # fmt: skip


def _ramp(foot: float, run: float, angle: float, half: float) -> Box:
    """One whose upper side rises from the ground at ``foot`` over ``run``, which is negative where it falls."""
    middle = np.array([foot + 0.5 * run, 0.0, 0.5 * run * math.tan(angle)])
    turn = Rotation.from_euler("y", -angle)
    x, y, z = (middle - turn.apply([0.0, 0.0, 0.5 * _SUNK])).tolist()
    return Box((x, y, z), (0.5 * abs(run) / math.cos(angle), half, 0.5 * _SUNK), tuple(turn.as_quat().tolist()))


def rough(sizes: Sizes) -> Obstacle:
    """Bumps."""
    return Obstacle(sizes.stretch, rough=True)


OBSTACLES: dict[str, Callable[[Sizes], Obstacle]] = {
    "blocks": blocks, "corridor": corridor, "bar": bar, "incline": incline, "rough": rough,
}  # fmt: skip
