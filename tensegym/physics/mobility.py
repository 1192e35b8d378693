"""The mobility matrix: what unit tensions do to the rates of all lengths, compiled."""

from __future__ import annotations

import numpy as np
from numba import njit

from .rod_rotation import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE, dot
from .split_rods import add_generalised, pinned_inertia, second_twist, symmetry_axis


@njit(cache=True)
def mobility_matrix(poses, ends, bodies, partner, pins, pin_params, turns, directions, out):
    """A = J M^-1 J^T (c, c) [1/kg] for bodies symmetric about their z axis, pinned pairs moving as their pin allows."""
    count = len(ends)
    response = np.zeros((len(poses), 6, count))  # accelerations of the bodies by a unit tension in each cable
    axis = np.empty((len(poses), 3))
    for b in range(len(poses)):
        symmetry_axis(poses[b], axis[b])
    for c in range(count):
        for side in range(2):
            body = ends[c, side]
            if partner[body] >= 0:
                continue
            sign = bodies[body, INVERSE_MASS] if side == 1 else -bodies[body, INVERSE_MASS]
            across = bodies[body, INVERSE_TRANSVERSE]
            more = (bodies[body, INVERSE_AXIAL] - across) * dot(turns[c, side], axis[body])
            for i in range(3):
                response[body, i, c] += sign * directions[c, i]
                response[body, 3 + i, c] += across * turns[c, side, i] + more * axis[body, i]
    if len(pins):
        _pinned_response(poses, ends, bodies, pins, pin_params, turns, directions, response)
    for c in range(count):
        a, b = response[ends[c, 0]], response[ends[c, 1]]
        x, y, z = directions[c]
        (ax, ay, az), (bx, by, bz) = turns[c]
        for d in range(c + 1):  # one loop over cables with the rest written out: it vectorises
            out[c, d] = (x * (b[0, d] - a[0, d]) + y * (b[1, d] - a[1, d]) + z * (b[2, d] - a[2, d])
                         + ax * a[3, d] + ay * a[4, d] + az * a[5, d]
                         + bx * b[3, d] + by * b[4, d] + bz * b[5, d])  # fmt: skip
    for c in range(count):
        for d in range(c):
            out[d, c] = out[c, d]


@njit(cache=True)
def _pinned_response(poses, ends, bodies, pins, pin_params, turns, directions, response):
    geometry, mass, inverse = np.empty((6, 3)), np.empty((7, 7)), np.empty((7, 7))
    push, motion, force, twist = np.empty(7), np.empty(7), np.empty(3), np.empty(6)
    for p in range(len(pins)):
        pinned_inertia(poses, bodies, pins, pin_params, p, geometry, mass, inverse)
        for c in range(len(ends)):
            for side in range(2):
                second = ends[c, side] == pins[p, 1]
                if not second and ends[c, side] != pins[p, 0]:
                    continue
                for i in range(3):
                    force[i] = directions[c, i] if side == 1 else -directions[c, i]
                push[:] = 0.0
                add_generalised(geometry, second, force, turns[c, side], push)
                for i in range(7):
                    total = 0.0
                    for j in range(7):
                        total += inverse[i, j] * push[j]
                    motion[i] = total
                second_twist(geometry, motion, twist)
                for i in range(6):
                    response[pins[p, 0], i, c] += motion[i]
                    response[pins[p, 1], i, c] += twist[i]
