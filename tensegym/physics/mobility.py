"""The mobility matrix: what unit tensions do to the rates of all lengths, compiled."""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel

from .model import BLOCK, INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE
from .split_rods import add_generalised, second_twist
from .vectors import ALLOCATING, INLINED, KERNEL, dot


@kernel(**KERNEL)
def whole_blocks(count):
    """The columns of the blocks that hold ``count`` of them."""
    return (count + BLOCK - 1) // BLOCK * BLOCK


@kernel(**INLINED)
def mobility_matrix(model, out, count):
    """Write out.mobility, A = J M^-1 J^T (count, count) [1/kg], of the spring rows out.rows[:count].

    Bodies are symmetric about their z axis, the halves of split rods move as their pin allows; from rotations,
    directions, moment arms and the pins' inertia in ``out``. Columns up to a whole block are written, with zeros.
    """
    ends, bodies, arms, directions = model.spring_bodies, model.body_params, out.moment_arms, out.directions
    rows, response, mobility, other_half, turns = out.rows, out.response, out.mobility, model.other_half, out.rotations
    width = whole_blocks(count)
    for b in range(len(response)):
        for i in range(6):
            for k in range(width):
                response[b, i, k] = 0.0
    for k in range(count):
        c = rows[k]
        for side in range(2):
            body = ends[c, side]
            if other_half[body] >= 0:
                continue
            axis = turns[body, 0, 2], turns[body, 1, 2], turns[body, 2, 2]
            sign = bodies[body, INVERSE_MASS] if side == 1 else -bodies[body, INVERSE_MASS]
            across = bodies[body, INVERSE_TRANSVERSE]
            more = (bodies[body, INVERSE_AXIAL] - across) * dot(arms[c, side], axis)
            for i in range(3):
                response[body, i, k] += sign * directions[c, i]
                response[body, 3 + i, k] += across * arms[c, side, i] + more * axis[i]
    if len(model.pin_bodies):
        _split_response(model, out, count)
    for k in range(count):
        c = rows[k]
        a, b, row = response[ends[c, 0]], response[ends[c, 1]], mobility[k]
        x, y, z = directions[c, 0], directions[c, 1], directions[c, 2]
        ax, ay, az = arms[c, 0, 0], arms[c, 0, 1], arms[c, 0, 2]
        bx, by, bz = arms[c, 1, 0], arms[c, 1, 1], arms[c, 1, 2]
        for d in range(whole_blocks(k + 1)):  # one loop with the rest written out: it vectorises
            row[d] = (x * (b[0, d] - a[0, d]) + y * (b[1, d] - a[1, d]) + z * (b[2, d] - a[2, d])
                      + ax * a[3, d] + ay * a[4, d] + az * a[5, d]
                      + bx * b[3, d] + by * b[4, d] + bz * b[5, d])  # fmt: skip
    for k in range(count):
        for d in range(k):
            mobility[d, k] = mobility[k, d]
        for d in range(count, width):
            mobility[k, d] = 0.0


@kernel(**ALLOCATING)
def _split_response(model, out, count):
    """Add what unit tensions do to the halves of split rods."""
    ends, pins, arms, directions = model.spring_bodies, model.pin_bodies, out.moment_arms, out.directions
    rows, response = out.rows, out.response
    push, motion, force, twist = np.empty(7), np.empty(7), np.empty(3), np.empty(6)
    for p in range(len(pins)):
        geometry, inverse = out.pin_geometry[p], out.pin_inverse[p]
        for k in range(count):
            c = rows[k]
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
                    response[pins[p, 0], i, k] += motion[i]
                    response[pins[p, 1], i, k] += twist[i]
