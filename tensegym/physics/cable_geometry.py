"""Geometry of cables and flexures from body poses, compiled: poses (b, 7) are position [m] and quaternion xyzw."""

from __future__ import annotations

import numpy as np
from numba import njit

from .split_rods import pin_axis


@njit(cache=True)
def rotation_matrix(q, out):
    """Rotation matrix of a unit quaternion xyzw, body to world."""
    x, y, z, w = q[0], q[1], q[2], q[3]
    out[0, 0] = 1 - 2 * (y * y + z * z)
    out[0, 1] = 2 * (x * y - z * w)
    out[0, 2] = 2 * (x * z + y * w)
    out[1, 0] = 2 * (x * y + z * w)
    out[1, 1] = 1 - 2 * (x * x + z * z)
    out[1, 2] = 2 * (y * z - x * w)
    out[2, 0] = 2 * (x * z - y * w)
    out[2, 1] = 2 * (y * z + x * w)
    out[2, 2] = 1 - 2 * (x * x + y * y)


@njit(cache=True)
def points_in_world(poses, bodies, locals_, out):
    """Points fixed in bodies: poses (b, 7) position and xyzw, bodies (p,), locals_ (p, 3) -> out (p, 3) [m]."""
    rotation = np.empty((3, 3))
    last = -1
    for p in range(len(bodies)):
        body = bodies[p]
        if body != last:
            rotation_matrix(poses[body, 3:], rotation)
            last = body
        for i in range(3):
            out[p, i] = poses[body, i] + (
                rotation[i, 0] * locals_[p, 0] + rotation[i, 1] * locals_[p, 1] + rotation[i, 2] * locals_[p, 2]
            )


@njit(cache=True)
def cable_geometry(poses, ends, cables, turns, directions, lengths):
    """Unit directions from end a to end b, lengths, and the turning that a length's rate takes from each end's body.

    ends (c, 2) bodies, cables (c, 9) -> turns (c, 2, 3) [m], directions (c, 3), lengths (c,) [m]; world axes. The rate
    is directions . (v_b - v_a) + sum over the ends of turns . w, and a tension T exerts on end a the force T directions
    and the moment -T turns[0] about its body's centre, on end b -T directions and -T turns[1].
    """
    r = np.empty((len(poses), 3, 3))
    for b in range(len(poses)):
        rotation_matrix(poses[b, 3:], r[b])
    for c in range(len(ends)):
        square = 0.0
        for side in range(2):
            b, x, y, z = ends[c, side], cables[c, 3 * side], cables[c, 3 * side + 1], cables[c, 3 * side + 2]
            for i in range(3):
                turns[c, side, i] = r[b, i, 0] * x + r[b, i, 1] * y + r[b, i, 2] * z  # the arm, for now
        for i in range(3):
            directions[c, i] = (poses[ends[c, 1], i] + turns[c, 1, i]) - (poses[ends[c, 0], i] + turns[c, 0, i])
            square += directions[c, i] ** 2
        lengths[c] = np.sqrt(square)
        for i in range(3):
            directions[c, i] /= lengths[c]
        nx, ny, nz = directions[c, 0], directions[c, 1], directions[c, 2]
        for side in range(2):
            rx, ry, rz = turns[c, side, 0], turns[c, side, 1], turns[c, side, 2]
            sign = 1.0 if side == 1 else -1.0
            turns[c, side, 0] = sign * (ry * nz - rz * ny)
            turns[c, side, 1] = sign * (rz * nx - rx * nz)
            turns[c, side, 2] = sign * (rx * ny - ry * nx)


@njit(cache=True)
def flexure_geometry(poses, pins, pin_params, angles, first, turns, directions, lengths):
    """The rows of the flexures, from row ``first`` on, as `cable_geometry` gives those of the cables."""
    axis = np.empty(3)
    for p in range(len(pins)):
        pin_axis(poses, pins, pin_params, p, axis)
        lengths[first + p] = angles[p]
        for i in range(3):
            directions[first + p, i] = 0.0
            turns[first + p, 0, i], turns[first + p, 1, i] = -axis[i], axis[i]
