"""Equations of motion of a tree of links, M(q) a + h(q, v) = tau, compiled. World axes throughout.

Columns of M and rows of h: a floating base's linear and angular velocity (6), then the joints. h holds the velocity
terms and gravity. M = sum over links of m Jv^T Jv + Jw^T I Jw; h from the accelerations that the velocities alone make
(Newton-Euler; Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 5 and 6, in the plain form for small trees).

PyBullet's own calculateInverseDynamics leaves out how a fixed base is turned, so gravity comes out wrong there.
"""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel
from tensegym.flexure.fem.beam import OPTIONS

FIXED, REVOLUTE, PRISMATIC = range(3)


# Not physics' own: a kernel compiled for this tree's rows first was seen to change the last bits of a robot's substep.
@kernel(**OPTIONS)
def cross(a, b, out):
    """out = a x b."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@kernel(**OPTIONS)
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(**OPTIONS)
def _times(matrix, vector, out):
    for i in range(3):
        out[i] = _dot(matrix[i], vector)


@kernel(**OPTIONS)
def turn_about(axis, angle, out):
    """Rotation matrix by ``angle`` about a unit axis."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z, t = axis[0], axis[1], axis[2], 1 - c
    out[0, 0], out[0, 1], out[0, 2] = t * x * x + c, t * x * y - s * z, t * x * z + s * y
    out[1, 0], out[1, 1], out[1, 2] = t * x * y + s * z, t * y * y + c, t * y * z - s * x
    out[2, 0], out[2, 1], out[2, 2] = t * x * z - s * y, t * y * z + s * x, t * z * z + c


@kernel(**OPTIONS)
def frames(tree, base, q, turns, origins, centres, axes):
    """Where every link is: rotation (l, 3, 3), URDF origin, centre of mass and joint axis (l, 3), in the world.

    base (7,) position and quaternion of the base's principal frame; q (j,) joint positions.
    """
    x, y, z, w = base[3], base[4], base[5], base[6]
    own = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])  # fmt: skip
    shift, local, spun = np.empty(3), np.empty((3, 3)), np.empty((3, 3))
    for i in range(len(tree.parent)):
        up = tree.parent[i]
        if up < 0:
            _times(own, tree.offset[i], shift)
            for k in range(3):
                origins[i, k] = base[k] + shift[k]
            local[:] = own
        else:
            _times(turns[up], tree.offset[i], shift)
            for k in range(3):
                origins[i, k] = origins[up, k] + shift[k]
            local[:] = turns[up]
        if tree.kind[i] == REVOLUTE:
            turn_about(tree.axis[i], q[tree.joint[i]], spun)
            turns[i] = local @ tree.turn[i] @ spun
        else:
            turns[i] = local @ tree.turn[i]
        _times(turns[i], tree.axis[i], axes[i])
        if tree.kind[i] == PRISMATIC:
            for k in range(3):
                origins[i, k] += axes[i, k] * q[tree.joint[i]]
        _times(turns[i], tree.centre[i], shift)
        for k in range(3):
            centres[i, k] = origins[i, k] + shift[k]


@kernel(**OPTIONS)
def _columns(tree, link, point, origins, centres, axes, where, linear, angular):
    """Jacobian columns of a point on a link: their numbers in ``where``, linear and angular (k, 3); returns k."""
    count, arm = 0, np.empty(3)
    i = link
    while i >= 0:
        if tree.kind[i] == PRISMATIC:
            linear[count], angular[count] = axes[i], 0.0
        if tree.kind[i] == REVOLUTE:
            for k in range(3):
                arm[k] = point[k] - origins[i, k]
            cross(axes[i], arm, linear[count])
            angular[count] = axes[i]
        if tree.kind[i] != FIXED:
            where[count] = tree.first + tree.joint[i]
            count += 1
        i = tree.parent[i]
    if tree.first:
        for k in range(3):
            arm[k] = point[k] - centres[0, k]
        for k in range(3):
            linear[count], angular[count] = 0.0, 0.0
            linear[count, k] = 1.0
            where[count] = k
            count += 1
        for k in range(3):
            linear[count], angular[count] = 0.0, 0.0
            angular[count, k] = 1.0
            cross(angular[count], arm, linear[count])
            where[count] = 3 + k
            count += 1
    return count


@kernel(**OPTIONS)
def generalised(tree, link, point, force, torque, origins, centres, axes, out):
    """Add to out (n,) what a force at a point and a torque on a link do."""
    size = len(tree.parent) + 6
    where, linear, angular = np.empty(size, np.int64), np.empty((size, 3)), np.empty((size, 3))
    for c in range(_columns(tree, link, point, origins, centres, axes, where, linear, angular)):
        out[where[c]] += _dot(linear[c], force) + _dot(angular[c], torque)


@kernel(**OPTIONS)
def point_velocity(tree, link, point, v, origins, centres, axes, linear, angular):
    """Velocity linear (3,) of a point on a link and its angular velocity (3,), of v (n,)."""
    size = len(tree.parent) + 6
    where, shifts, turns = np.empty(size, np.int64), np.empty((size, 3)), np.empty((size, 3))
    linear[:], angular[:] = 0.0, 0.0
    for c in range(_columns(tree, link, point, origins, centres, axes, where, shifts, turns)):
        linear += v[where[c]] * shifts[c]
        angular += v[where[c]] * turns[c]


@kernel(**OPTIONS)
def mass_matrix(tree, turns, origins, centres, axes, out):
    """M (n, n)."""
    size = len(tree.parent) + 6
    where, linear, angular = np.empty(size, np.int64), np.empty((size, 3)), np.empty((size, 3))
    spin = np.empty(3)
    out[:] = 0.0
    for i in range(len(tree.parent)):
        if tree.mass[i] == 0.0:
            continue
        inertia = turns[i] @ tree.inertia[i] @ turns[i].T
        count = _columns(tree, i, centres[i], origins, centres, axes, where, linear, angular)
        for c in range(count):
            _times(inertia, angular[c], spin)
            for d in range(count):
                out[where[c], where[d]] += tree.mass[i] * _dot(linear[c], linear[d]) + _dot(spin, angular[d])


@kernel(**OPTIONS)
def bias(tree, v, gravity, turns, origins, centres, axes, out):
    """h (n,): the force that holds velocities v (n,) without acceleration, gravity (3,) included."""
    size = len(tree.parent)
    spins, turnings, pulls = np.zeros((size, 3)), np.zeros((size, 3)), np.zeros((size, 3))
    d, e, f, moment = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    out[:] = 0.0
    for i in range(size):
        up = tree.parent[i]
        rate = v[tree.first + tree.joint[i]] if tree.kind[i] != FIXED else 0.0
        if up < 0:
            if tree.first:
                spins[i] = v[3:6]
                d[:] = origins[i] - centres[i]  # the base's centre is what has no acceleration
                cross(spins[i], d, e)
                cross(spins[i], e, pulls[i])
        else:
            d[:] = origins[i] - origins[up]
            spins[i], turnings[i] = spins[up], turnings[up]
            cross(spins[up], d, e)
            cross(spins[up], e, pulls[i])
            cross(turnings[up], d, e)
            cross(spins[up], axes[i], f)
            for k in range(3):
                pulls[i, k] += pulls[up, k] + e[k]
                if tree.kind[i] == PRISMATIC:
                    pulls[i, k] += 2 * rate * f[k]
                elif tree.kind[i] == REVOLUTE:
                    spins[i, k] += rate * axes[i, k]
                    turnings[i, k] += rate * f[k]
        if tree.mass[i] == 0.0:
            continue
        d[:] = centres[i] - origins[i]
        cross(spins[i], d, e)
        cross(spins[i], e, f)
        cross(turnings[i], d, e)
        force = tree.mass[i] * (pulls[i] + e + f - gravity)
        inertia = turns[i] @ tree.inertia[i] @ turns[i].T
        _times(inertia, spins[i], e)
        cross(spins[i], e, f)
        _times(inertia, turnings[i], moment)
        generalised(tree, i, centres[i], force, moment + f, origins, centres, axes, out)
