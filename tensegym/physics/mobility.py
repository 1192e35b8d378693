"""The mobility matrix: what unit tensions do to the rates of all lengths, compiled."""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel

from .model import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE
from .split_rods import add_generalised, second_twist
from .vectors import KERNEL, dot


@kernel(**KERNEL)
def mobility_matrix(model, out):
    """Write out.mobility, A = J M^-1 J^T (s, s) [1/kg], for bodies symmetric about their z axis, the halves of split
    rods moving as their pin allows; from rotations, directions, moment arms and the pins' inertia in ``out``."""
    ends, bodies, arms, directions = model.spring_bodies, model.body_params, out.moment_arms, out.directions
    response, mobility = out.response, out.mobility
    count = len(ends)
    response[:] = 0.0
    for c in range(count):
        for side in range(2):
            body = ends[c, side]
            if model.other_half[body] >= 0:
                continue
            axis = out.rotations[body, :, 2]
            sign = bodies[body, INVERSE_MASS] if side == 1 else -bodies[body, INVERSE_MASS]
            across = bodies[body, INVERSE_TRANSVERSE]
            more = (bodies[body, INVERSE_AXIAL] - across) * dot(arms[c, side], axis)
            for i in range(3):
                response[body, i, c] += sign * directions[c, i]
                response[body, 3 + i, c] += across * arms[c, side, i] + more * axis[i]
    if len(model.pin_bodies):
        _split_response(model, out)
    for c in range(count):
        a, b = response[ends[c, 0]], response[ends[c, 1]]
        x, y, z = directions[c]
        (ax, ay, az), (bx, by, bz) = arms[c]
        for d in range(c + 1):  # one loop over springs with the rest written out: it vectorises
            mobility[c, d] = (x * (b[0, d] - a[0, d]) + y * (b[1, d] - a[1, d]) + z * (b[2, d] - a[2, d])
                              + ax * a[3, d] + ay * a[4, d] + az * a[5, d]
                              + bx * b[3, d] + by * b[4, d] + bz * b[5, d])  # fmt: skip
    for c in range(count):
        for d in range(c):
            mobility[d, c] = mobility[c, d]


@kernel(**KERNEL)
def _split_response(model, out):
    """Add what unit tensions do to the halves of split rods."""
    ends, pins, arms, directions = model.spring_bodies, model.pin_bodies, out.moment_arms, out.directions
    push, motion, force, twist = np.empty(7), np.empty(7), np.empty(3), np.empty(6)
    for p in range(len(pins)):
        geometry, inverse = out.pin_geometry[p], out.pin_inverse[p]
        for c in range(len(ends)):
            for side in range(2):
                second = ends[c, side] == pins[p, 1]
                if not second and ends[c, side] != pins[p, 0]:
                    continue
                for i in range(3):
                    force[i] = directions[c, i] if side == 1 else -directions[c, i]
                push[:] = 0.0
                add_generalised(geometry, second, force, arms[c, side], push)
                for i in range(7):
                    total = 0.0
                    for j in range(7):
                        total += inverse[i, j] * push[j]
                    motion[i] = total
                second_twist(geometry, motion, twist)
                for i in range(6):
                    out.response[pins[p, 0], i, c] += motion[i]
                    out.response[pins[p, 1], i, c] += twist[i]
