"""Ground: a plane, a random smooth field of heights, boxes on it; and how far a foot is above it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter

from tensegym.arrays import FloatArray
from tensegym.compiled import kernel
from tensegym.errors import DesignError
from tensegym.tables import Checked, bounded

from .box import Box, box_rows, boxes_of, distance_to_box
from .vectors import ALLOCATING, KERNEL

CELLS_PER_LENGTH = 4  # grid cells a correlation length
MOST_CELLS = 1000  # from the middle to an edge; the engine then holds four million heights


def longest_reach(correlation_length: float) -> float:
    """Largest reach of bumps of this correlation length [m]."""
    return MOST_CELLS * correlation_length / CELLS_PER_LENGTH


@dataclass(frozen=True)
class Terrain(Checked, error=DesignError):
    """Bumps with the autocorrelation exp(-(r / correlation_length)^2), as surface metrology has Gaussian roughness.

    The root mean square slope is sqrt(2) roughness / correlation_length. seed: of the bumps.
    """

    roughness: float = bounded(0, 0.2, 0.02, "m", "root mean square height", open_low=True)
    correlation_length: float = bounded(0.1, 5, 0.3, "m", "over which heights have much to do with each other")
    reach: float = bounded(1, 5000, 12.0, "m", "from the middle to the nearest edge; beyond it there is no ground")
    seed: int = bounded(0, 2**31, 0, "", "of the bumps")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.reach > longest_reach(self.correlation_length):
            raise DesignError(
                f"Terrain.reach = {self.reach!r} is over {longest_reach(self.correlation_length):g} m, {MOST_CELLS} "
                "cells of a quarter of correlation_length; give less, or longer bumps"
            )

    @property
    def cell(self) -> float:
        """Spacing of the grid [m]."""
        return self.correlation_length / CELLS_PER_LENGTH

    def heights(self, clearing: float) -> FloatArray:
        """(n, n) heights [m] over x (rows) and y, the origin on the middle one.

        They are 0 up to ``clearing`` [m] from the origin and rise to their full size over a correlation length.
        """
        half = int(np.ceil(self.reach / self.cell))
        noise = np.random.default_rng(self.seed).standard_normal((2 * half + 1, 2 * half + 1))
        # filtered by a Gaussian of standard deviation s, white noise has the autocorrelation exp(-r^2 / (4 s^2))
        bumps = gaussian_filter(noise, CELLS_PER_LENGTH / 2, mode="wrap")
        bumps -= bumps.mean()
        x = np.arange(-half, half + 1) * self.cell
        # the cell's diagonal is added so that whole triangles are flat up to there
        beyond = np.hypot(x[:, None], x) - clearing - np.sqrt(2) * self.cell
        share = np.clip(beyond / self.correlation_length, 0, 1)
        return self.roughness / bumps.std() * bumps * share**2 * (3 - 2 * share)


class Ground(NamedTuple):
    """Heights over the world's x and y, the origin in the middle."""

    heights: FloatArray
    """(n, n) [m] over x (rows) and y; (0, 0) for the plane z = 0."""
    cell: float
    """Spacing of the grid [m]."""
    boxes: FloatArray = np.zeros((0, 10))
    """(k, 10) of the boxes that stand on it, see box.py."""

    @property
    def rough(self) -> bool:
        """Whether it is other than a plane, boxes apart."""
        return len(self.heights) > 0

    @property
    def obstacles(self) -> tuple[Box, ...]:
        """The boxes, one by one."""
        return boxes_of(self.boxes)

    def holding(self, boxes: Iterable[Box]) -> Ground:
        """The same ground with these boxes on it."""
        return self._replace(boxes=box_rows(boxes))


FLAT = Ground(np.zeros((0, 0)), 1.0)


@kernel(**KERNEL)
def distance_to_ground(point, ground):
    """Signed distance [m] of a point (3,) to the ground or to the nearest box, below or in it negative; nan beyond the
    ground's edges."""
    distance = _distance_to_heights(point, ground.heights, ground.cell)
    for b in range(len(ground.boxes)):
        distance = min(distance, distance_to_box(point, ground.boxes[b], distance))
    return distance


@kernel(**KERNEL)
def _distance_to_heights(point, heights, cell):
    """To the plane z = 0, or to what the engine makes of a grid of heights: two triangles a cell, which meet in the
    diagonal from (0, 1) to (1, 0). The distance is that to the plane of the triangle above or below the point."""
    if not len(heights):
        return point[2]
    last = len(heights) - 1
    u, v = point[0] / cell + 0.5 * last, point[1] / cell + 0.5 * last
    if not (0 <= u <= last and 0 <= v <= last):
        return np.nan
    i, j = min(int(u), last - 1), min(int(v), last - 1)
    u, v = u - i, v - j
    if u + v <= 1:
        corner, du, dv = heights[i, j], heights[i + 1, j] - heights[i, j], heights[i, j + 1] - heights[i, j]
    else:
        du, dv = heights[i + 1, j + 1] - heights[i, j + 1], heights[i + 1, j + 1] - heights[i + 1, j]
        corner = heights[i + 1, j + 1] - du - dv
    return (point[2] - (corner + du * u + dv * v)) / np.sqrt(1 + (du * du + dv * dv) / (cell * cell))


@kernel(**ALLOCATING)
def distances_to_ground(points, ground):
    """Those of points (k, 3): (k,) [m]."""
    out = np.empty(len(points))
    for p in range(len(points)):
        out[p] = distance_to_ground(points[p], ground)
    return out
