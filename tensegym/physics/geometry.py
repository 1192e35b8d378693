"""Geometry of springs and nodes from body poses, compiled."""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel

from .vectors import ALLOCATING, INLINED, KERNEL, cross, rotate, rotation_matrix


@kernel(**KERNEL)
def rotations_of(poses, out):
    """Write the rotation matrices (b, 3, 3) of poses (b, 7), body to world."""
    for b in range(len(poses)):
        rotation_matrix(poses[b, 3:], out[b])


@kernel(**KERNEL)
def points_in_world(poses, rotations, bodies, points, out):
    """Write where points (k, 3) [m] of ``bodies`` (k,), in their frames, stand in the world: out (k, 3) [m]."""
    for p in range(len(bodies)):
        b = bodies[p]
        x, y, z = points[p, 0], points[p, 1], points[p, 2]
        for i in range(3):
            out[p, i] = poses[b, i] + (rotations[b, i, 0] * x + rotations[b, i, 1] * y + rotations[b, i, 2] * z)


@kernel(**ALLOCATING)
def points_at(poses, bodies, points):
    """The same from poses (b, 7) alone, in an array of its own (k, 3)."""
    rotations, out = np.empty((len(poses), 3, 3)), np.empty((len(bodies), 3))
    rotations_of(poses, rotations)
    points_in_world(poses, rotations, bodies, points, out)
    return out


@kernel(**KERNEL)
def span(poses, rotations, ends, params, c):
    """Of cable c: what runs from end a to end b (3,), and both ends from their bodies' centres (3,), world axes [m].

    ends (s, 2), params (s, 9): see Model.
    """
    r, a, b = rotations, ends[c, 0], ends[c, 1]
    xa, ya, za = params[c, 0], params[c, 1], params[c, 2]
    xb, yb, zb = params[c, 3], params[c, 4], params[c, 5]
    ax = r[a, 0, 0] * xa + r[a, 0, 1] * ya + r[a, 0, 2] * za
    ay = r[a, 1, 0] * xa + r[a, 1, 1] * ya + r[a, 1, 2] * za
    az = r[a, 2, 0] * xa + r[a, 2, 1] * ya + r[a, 2, 2] * za
    bx = r[b, 0, 0] * xb + r[b, 0, 1] * yb + r[b, 0, 2] * zb
    by = r[b, 1, 0] * xb + r[b, 1, 1] * yb + r[b, 1, 2] * zb
    bz = r[b, 2, 0] * xb + r[b, 2, 1] * yb + r[b, 2, 2] * zb
    x = (poses[b, 0] + bx) - (poses[a, 0] + ax)
    y = (poses[b, 1] + by) - (poses[a, 1] + ay)
    z = (poses[b, 2] + bz) - (poses[a, 2] + az)
    return (x, y, z), (ax, ay, az), (bx, by, bz)


@kernel(**INLINED)
def spring_geometry(model, poses, angles, out, lengths):
    """Write the lengths (s,) of all springs, and rotations, directions and moment arms in ``out``.

    A length's rate is directions . (v_b - v_a) + sum over the ends of moment_arms . w, and a tension T exerts on end a
    the force T directions and the moment -T moment_arms[0] about its body's centre, on end b -T directions and
    -T moment_arms[1].
    """
    ends, params, directions, arms = model.spring_bodies, model.spring_params, out.directions, out.moment_arms
    rotations_of(poses, out.rotations)
    cables = len(ends) - len(model.pin_bodies)
    for c in range(cables):
        (x, y, z), from_a, from_b = span(poses, out.rotations, ends, params, c)
        length = np.sqrt(x * x + y * y + z * z)
        along = x / length, y / length, z / length
        lengths[c] = length
        at_a, at_b = cross(from_a, along), cross(from_b, along)
        for i in range(3):
            directions[c, i], arms[c, 0, i], arms[c, 1, i] = along[i], -at_a[i], at_b[i]
    for p in range(len(model.pin_bodies)):
        axis = rotate(poses[model.pin_bodies[p, 0], 3:], model.pin_params[p, 6:9])
        lengths[cables + p] = angles[p]
        for i in range(3):
            directions[cables + p, i], arms[cables + p, 0, i], arms[cables + p, 1, i] = 0.0, -axis[i], axis[i]
