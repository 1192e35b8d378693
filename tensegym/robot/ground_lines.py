"""The ground as lines to be drawn, and the boxes on it as patches."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.physics.box import CENTRE, HALF, TURN

from .sight import Sight

_CUT = 72  # pieces of a line
_PATCH = 0.35  # L, side of a box's patches at most
_MOST = 24  # along a side


def on_ground(sight: Sight, points: FloatArray) -> FloatArray:
    """(k, 3) points (k, 2) [m] on the ground, boxes apart."""
    found = np.column_stack([points, np.zeros(len(points))])
    if sight.ground is not None and sight.ground.rough:
        cells = points.T / sight.ground.cell + (len(sight.ground.heights) - 1) / 2
        found[:, 2] = map_coordinates(sight.ground.heights, cells, order=1, mode="nearest")
    return found


def grid_lines(sight: Sight) -> tuple[FloatArray, FloatArray]:
    """Ends (k, 2, 3) [m] of a grid about the robot, half a rod apart, a quarter where it shows bumps; and how visible
    each piece is (k,), less with the distance."""
    rough = sight.ground is not None and sight.ground.rough
    spacing, count = (0.25 * sight.length, 10) if rough else (0.5 * sight.length, 12)
    middle = spacing * np.round(sight.centre[:2] / spacing)
    across, along = np.meshgrid(
        spacing * np.arange(-count, count + 1), spacing * np.linspace(-count, count, _CUT + 1), indexing="ij"
    )
    lines = np.stack([across, along], axis=-1)
    flat = np.concatenate([lines, lines[..., ::-1]]) + middle
    points = on_ground(sight, flat.reshape(-1, 2)).reshape(*flat.shape[:2], 3)
    ends = np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)
    visible = 1 - np.linalg.norm(ends[:, 0, :2] - middle, axis=1) / (count * spacing)
    return ends[visible > 0], visible[visible > 0]


def box_patches(sight: Sight, colour: tuple[int, int, int]) -> tuple[FloatArray, FloatArray]:
    """Corners (k, 4, 3) [m] of the patches that the boxes' faces are cut into, and their colours (k, 3)."""
    patches, colours = [np.zeros((0, 4, 3))], [np.zeros((0, 3))]
    for box in sight.ground.boxes if sight.ground is not None else ():
        turn = Rotation.from_quat(box[TURN])
        for axis in range(3):
            for sign in (-1, 1):
                face = _face(box[HALF], axis, sign, _PATCH * sight.length)
                light = 0.82 + 0.18 * float(turn.apply(sign * np.eye(3)[axis]) @ sight.up)
                patches.append(box[CENTRE] + turn.apply(face.reshape(-1, 3)).reshape(-1, 4, 3))
                colours.append(np.tile(light * np.array(colour), (len(face), 1)))
    return np.concatenate(patches), np.concatenate(colours)


def _face(half: FloatArray, axis: int, sign: int, side: float) -> FloatArray:
    """(k, 4, 3) patches of one face of a box of half sides (3,), in its own frame."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    us, vs = (np.linspace(-half[i], half[i], 1 + min(_MOST, int(np.ceil(2 * half[i] / side)))) for i in (u, v))
    grid = np.zeros((len(us), len(vs), 3))
    grid[..., axis], grid[..., u], grid[..., v] = sign * half[axis], us[:, None], vs
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)
