"""What lies on the ground of a picture: how high the ground is there, and the boxes on it."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.physics.box import CENTRE, HALF, TURN
from tensegym.physics.terrain import Ground


def on_ground(ground: Ground | None, points: FloatArray) -> FloatArray:
    """(k, 3) points (k, 2) [m] on the ground, boxes apart; on z = 0 where there is none."""
    found = np.column_stack([points, np.zeros(len(points))])
    if ground is not None and ground.rough:
        cells = points.T / ground.cell + (len(ground.heights) - 1) / 2
        found[:, 2] = map_coordinates(ground.heights, cells, order=1, mode="nearest")
    return found


def on_top(ground: Ground | None, points: FloatArray) -> FloatArray:
    """(k, 3) points (k, 2) [m] on the ground, or on the highest box there."""
    found = on_ground(ground, points)
    for box in ground.boxes if ground is not None else ():
        found[:, 2] = np.maximum(found[:, 2], _top(box, points))
    return found


def draped(ground: Ground | None, points: FloatArray, piece: float) -> FloatArray:
    """(m, 3) a line through points (k, 2) [m] laid over ground and boxes, in pieces of ``piece`` [m] at most."""
    spans = np.diff(points, axis=0)
    counts = np.maximum(1, np.ceil(np.linalg.norm(spans, axis=1) / piece)).astype(int)
    shares = np.concatenate([np.arange(count) / count for count in counts])
    starts = np.repeat(points[:-1], counts, axis=0) + shares[:, None] * np.repeat(spans, counts, axis=0)
    return on_top(ground, np.concatenate([starts, points[-1:]]))


def _top(box: FloatArray, points: FloatArray) -> FloatArray:
    """(k,) where vertical lines through points (k, 2) leave a box (10,), -inf beside it [m]."""
    turn = Rotation.from_quat(box[TURN])
    up = turn.inv().apply([0.0, 0.0, 1.0])
    up = np.where(np.abs(up) < 1e-12, 1e-12, up)  # along a side: a line is in it everywhere, or nowhere
    foot = turn.inv().apply(np.column_stack([points, np.zeros(len(points))]) - box[CENTRE])
    ends = np.stack([(-box[HALF] - foot) / up, (box[HALF] - foot) / up])
    enters, leaves = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
    return np.where(enters <= leaves, leaves, -np.inf)
