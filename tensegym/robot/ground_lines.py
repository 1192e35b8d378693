"""The ground as lines to be drawn, and the boxes on it as patches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.physics.box import CENTRE, HALF, TURN

from .sight import Sight
from .surface import on_ground

_CUT = 72  # pieces of a line
_PATCH = 0.35  # L, side of a box's patches at most
_MOST = 24  # along a side
_CHESS = 0.05  # by which every other patch of a large face is darker


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
    points = on_ground(sight.ground, flat.reshape(-1, 2)).reshape(*flat.shape[:2], 3)
    ends = np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)
    visible = 1 - np.linalg.norm(ends[:, 0, :2] - middle, axis=1) / (count * spacing)
    return ends[visible > 0], visible[visible > 0]


def box_patches(sight: Sight, place: FloatArray, colour: tuple[int, int, int]) -> tuple[FloatArray, FloatArray]:
    """Corners (k, 4, 3) [m] of the patches of what is seen of the boxes' faces from a place (3,) above z = 0, whatever
    stands before it; and their colours (k, 3)."""
    patches, colours = [np.zeros((0, 4, 3))], [np.zeros((0, 3))]
    for box in sight.ground.boxes if sight.ground is not None else ():
        turn = Rotation.from_quat(box[TURN])
        for axis in range(3):
            for sign in (-1, 1):
                normal = turn.apply(sign * np.eye(3)[axis])
                if normal @ (place - box[CENTRE]) <= box[HALF][axis]:  # it looks away, and others hide it
                    continue
                face = _face(box[HALF], axis, sign, _PATCH * sight.length)
                tints = (0.82 + 0.18 * float(normal @ sight.up)) * _tints(*face.shape[:2])
                corners, kept = _above(box[CENTRE] + turn.apply(face.reshape(-1, 3)).reshape(-1, 4, 3), normal)
                patches.append(corners)
                colours.append(tints[kept, None] * np.array(colour))
    return np.concatenate(patches), np.concatenate(colours)


def _face(half: FloatArray, axis: int, sign: int, side: float) -> FloatArray:
    """(n, m, 4, 3) patches of one face of a box of half sides (3,), in its own frame."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    us, vs = (np.linspace(-half[i], half[i], 1 + min(_MOST, int(np.ceil(2 * half[i] / side)))) for i in (u, v))
    grid = np.zeros((len(us), len(vs), 3))
    grid[..., axis], grid[..., u], grid[..., v] = sign * half[axis], us[:, None], vs
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2)


def _tints(rows: int, columns: int) -> FloatArray:
    """(rows columns,) how light the patches of a face are: a large one's as a chessboard's, so that its slope shows."""
    chess = np.add.outer(np.arange(rows), np.arange(columns)) % 2 * (min(rows, columns) > 2)
    return 1.0 - _CHESS * chess.ravel()


def _above(patches: FloatArray, normal: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """What patches (k, 4, 3) of a face with this normal (3,) have above z = 0, and which have any (k,): corners below
    move up along the face."""
    kept = patches[..., 2].max(axis=1) > 1e-9
    uphill = np.array([0.0, 0.0, 1.0]) - normal[2] * normal
    if uphill[2] < 1e-9:  # level
        return patches[kept], kept
    return patches[kept] + np.maximum(0.0, -patches[kept, :, 2:] / uphill[2]) * uphill, kept
