"""Lane: obstacles one after another along the world's x, laid out on the ground, and the goal of passing them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.physics.box import Box
from tensegym.physics.terrain import CELLS_PER_LENGTH, FLAT, Ground, Terrain
from tensegym.robot.robot import TensegrityRobot

from .obstacles import Obstacle
from .path import Path, sampled

_BEYOND = 2.0  # rod lengths of ground behind the start, beside the lane and after its end


class Layout:
    """Where obstacles lie, in metres.

    Args:
        obstacles: in their order, in rod lengths.
        before: level way before each [rod lengths].
        length: of a rod [m].
    """

    def __init__(self, obstacles: Sequence[Obstacle], before: float, length: float) -> None:
        run = before + np.array([obstacle.length for obstacle in obstacles])
        self.ends: FloatArray = length * np.cumsum(run)
        """(k,) where each ends along the way [m]."""
        self.begins: FloatArray = self.ends - length * (run - before)
        self._obstacles, self._length = tuple(obstacles), length

    def ground(self, lane: float, bumps: float, bump_length: float) -> Ground:
        """With the boxes on it, and bumps where it is rough; all in rod lengths, as `Sizes` has them."""
        boxes = [_scaled(box, self._length, float(begin)) for obstacle, begin in zip(self._obstacles, self.begins,
                 strict=True) for box in obstacle.boxes]  # fmt: skip
        if not (bumps and any(obstacle.rough for obstacle in self._obstacles)):
            return FLAT.holding(boxes)
        length = self._length
        reach = max(float(self.ends[-1]), lane * length / 2) + _BEYOND * length
        terrain = Terrain(bumps * length, bump_length * length, reach)
        heights = terrain.heights(0.0)
        x = (np.arange(len(heights)) - len(heights) // 2) * terrain.cell
        share = np.zeros(len(x))
        for obstacle, begin, end in zip(self._obstacles, self.begins, self.ends, strict=True):
            if obstacle.rough:
                share += np.clip(np.minimum(x - begin, end - x) / (terrain.cell * CELLS_PER_LENGTH), 0, 1)
        return Ground(heights * share[:, None], terrain.cell).holding(boxes)


def _scaled(box: Box, length: float, begin: float) -> Box:
    x, y, z = (length * place for place in box.centre)
    a, b, c = (length * half for half in box.half)
    return replace(box, centre=(begin + x, y, z), half=(a, b, c))


class Lane(Path):
    """Go along x, past the end of each obstacle, and never out of the lane.

    Args:
        start: (2,) where the robot stands [m].
        ends: (k,) where obstacles end along x [m].
        half: of the lane's width [m].
        ahead: how far ahead the bearing points [m].
    """

    def __init__(self, start: FloatArray, ends: FloatArray, half: float, ahead: float) -> None:
        last = [float(ends[-1]) + 2 * ahead, 0.0]
        super().__init__(sampled(np.array([[float(start[0]), 0.0], last])), ahead, 0.0)
        self._ends, self._half, self._behind = ends, half, float(start[0]) - 2 * ahead
        self.passed = 0
        """Obstacles so far that no part of the robot is before the end of."""
        self.seconds = 0.0
        """Since the start, until all were passed [s]."""
        self.idle = 0.0
        """Since it came further than ever before [s]."""
        self.left = False
        """Whether the centre of mass was out of the lane."""

    @property
    def done(self) -> bool:
        """Whether it has passed all."""
        return self.passed == len(self._ends)

    def update(self, robot: TensegrityRobot, way: float, seconds: float) -> None:
        """As `Goal` has it."""
        come = self.share
        super().update(robot, way, seconds)
        self.idle = 0.0 if self.share > come else self.idle + seconds
        here = robot.centre_of_mass_in_world()
        self.seconds += seconds
        self.left |= bool(abs(here[1]) > self._half or here[0] < self._behind)
        if not self.left:
            last = robot.node_positions_in_world()[:, 0].min()
            self.passed = max(self.passed, int((self._ends <= last).sum()))
