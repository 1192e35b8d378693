"""Boxes that stand still: walls, steps, bars and ramps beside the ground, and how far a foot is from one."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.compiled import kernel
from tensegym.errors import DesignError
from tensegym.tables import Checked, bounded

from .vectors import KERNEL

CENTRE, HALF, TURN = slice(0, 3), slice(3, 6), slice(6, 10)  # columns of a box's row
Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Box(Checked, error=DesignError):
    """A solid that nothing moves, as rough as the ground.

    Raises:
        DesignError: a number is outside its range, or the quaternion is of no length.
    """

    centre: Triple = bounded(-1e4, 1e4, unit="m", what="in the world")
    half: Triple = bounded(1e-3, 1e4, unit="m", what="half sizes along its own axes")
    turn: tuple[float, float, float, float] = bounded(-1, 1, (0.0, 0.0, 0.0, 1.0), what="quaternion xyzw to the world")

    def __post_init__(self) -> None:
        super().__post_init__()
        if abs(math.hypot(*self.turn) - 1) > 1e-6:
            raise DesignError(f"Box.turn = {self.turn!r} is no unit quaternion; its length must be 1")

    @classmethod
    def between(cls, low: Triple, high: Triple) -> Box:
        """The one along the world's axes between two corners [m]."""
        (x, y, z), (X, Y, Z) = low, high
        return cls(((x + X) / 2, (y + Y) / 2, (z + Z) / 2), ((X - x) / 2, (Y - y) / 2, (Z - z) / 2))


def box_rows(boxes: Iterable[Box]) -> FloatArray:
    """(k, 10) a row a box: columns CENTRE, HALF, TURN."""
    return np.array([(*box.centre, *box.half, *box.turn) for box in boxes], dtype=float).reshape(-1, 10)


def boxes_of(rows: FloatArray) -> tuple[Box, ...]:
    """The boxes of such rows (k, 10)."""
    return tuple(Box(tuple(row[CENTRE]), tuple(row[HALF]), tuple(row[TURN])) for row in rows.tolist())


@kernel(**KERNEL)
def distance_to_box(point, box, near):
    """Signed distance [m] of a point (3,) to a box (10,), inside it negative; anything over ``near`` where it is more.

    Outside it is that to the nearest point of the surface, inside that to the nearest side.
    """
    x, y, z = point[0] - box[0], point[1] - box[1], point[2] - box[2]
    reach = near + np.sqrt(box[3] * box[3] + box[4] * box[4] + box[5] * box[5])
    if reach > 0 and x * x + y * y + z * z > reach * reach:
        return np.inf
    # into the box's own axes: v - 2 w (u x v) + 2 u x (u x v) for the quaternion (u, w)
    a, b, c, w = box[6], box[7], box[8], box[9]
    tx, ty, tz = 2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)
    dx = abs(x - w * tx + b * tz - c * ty) - box[3]
    dy = abs(y - w * ty + c * tx - a * tz) - box[4]
    dz = abs(z - w * tz + a * ty - b * tx) - box[5]
    inside = max(dx, dy, dz)
    if inside <= 0:
        return inside
    ox, oy, oz = max(dx, 0.0), max(dy, 0.0), max(dz, 0.0)
    return np.sqrt(ox * ox + oy * oy + oz * oz)
