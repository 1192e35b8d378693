"""Pinned rods: two rigid halves that turn against each other about one axis, as PyBullet holds them.

Coordinates are those of the engine: the pose of the first half and the angle of the pin. Velocities u (7,): that of the
first half's centre, its angular velocity, both in world axes, and the pin's rate. (Featherstone, Rigid Body Dynamics
Algorithms, 2008.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from tensegym.arrays import FloatArray, IntArray

from .rod_rotation import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE, dot

# Columns of a pin's parameter row: the pin in the frames of the first and the second half, its axis in either
PIN_FIRST, PIN_SECOND, AXIS = slice(0, 3), slice(3, 6), slice(6, 9)


@dataclass(frozen=True)
class PinArrays:
    """bodies (p, 2) rows of the first and the second half; params (p, 9) as above [m]; partner (b,) the other half's
    row, -1 of a whole body."""

    bodies: IntArray
    params: FloatArray
    partner: IntArray


@njit(cache=True)
def symmetry_axis(pose, out):
    """World axis (3,) that a body's own z points along."""
    x, y, z, w = pose[3], pose[4], pose[5], pose[6]
    out[0], out[1], out[2] = 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)


@njit(cache=True)
def _into_world(pose, local, out):
    """Turn a body's vector (3,) into world axes."""
    x, y, z, w = pose[3], pose[4], pose[5], pose[6]
    tx = 2 * (y * local[2] - z * local[1])
    ty = 2 * (z * local[0] - x * local[2])
    tz = 2 * (x * local[1] - y * local[0])
    out[0] = local[0] + w * tx + y * tz - z * ty
    out[1] = local[1] + w * ty + z * tx - x * tz
    out[2] = local[2] + w * tz + x * ty - y * tx


@njit(cache=True)
def cross(a, b, out):
    out[0], out[1], out[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def inertia_times(body, axis, w, out):
    """Moment of inertia of a body symmetric about ``axis`` times w (3,)."""
    across, along = 1 / body[INVERSE_TRANSVERSE], 1 / body[INVERSE_AXIAL]
    part = (along - across) * dot(w, axis)
    for i in range(3):
        out[i] = across * w[i] + part * axis[i]


@njit(cache=True)
def second_poses(pins, params, angles, poses):
    """Write the poses of the second halves: pins (p, 2), angles (p,) [rad], poses (b, 7)."""
    for p in range(len(pins)):
        first, second = poses[pins[p, 0]], poses[pins[p, 1]]
        s, w = np.sin(0.5 * angles[p]), np.cos(0.5 * angles[p])
        x, y, z = s * params[p, 6], s * params[p, 7], s * params[p, 8]
        a, b, c, d = first[3], first[4], first[5], first[6]
        second[3] = d * x + a * w + b * z - c * y
        second[4] = d * y + b * w + c * x - a * z
        second[5] = d * z + c * w + a * y - b * x
        second[6] = d * w - a * x - b * y - c * z
        arm, back = np.empty(3), np.empty(3)
        _into_world(first, params[p, 0:3], arm)
        _into_world(second, params[p, 3:6], back)
        for i in range(3):
            second[i] = first[i] + arm[i] - back[i]


@njit(cache=True)
def pin_axis(poses, pins, params, p, out):
    """World axis (3,) of a pin: it turns the second half by a positive angle."""
    _into_world(poses[pins[p, 0]], params[p, 6:9], out)


@njit(cache=True)
def pinned_inertia(poses, bodies, pins, params, p, geometry, mass, inverse):
    """Mass matrix (7, 7) of a rod and its inverse; geometry (6, 3) rows are r1, r2 from the centres to the pin, its
    axis, the halves' own axes, and c, the velocity of the second centre for a unit rate."""
    one, two = pins[p, 0], pins[p, 1]
    r1, r2, axis, z1, z2, c = geometry
    _into_world(poses[one], params[p, 0:3], r1)
    _into_world(poses[two], params[p, 3:6], r2)
    _into_world(poses[one], params[p, 6:9], axis)
    symmetry_axis(poses[one], z1)
    symmetry_axis(poses[two], z2)
    cross(r2, axis, c)
    m1, m2 = 1 / bodies[one, INVERSE_MASS], 1 / bodies[two, INVERSE_MASS]
    d, unit, spun, row = np.empty(3), np.zeros(3), np.empty(3), np.empty(3)
    for i in range(3):
        d[i] = r1[i] - r2[i]
    mass[:] = 0.0
    square = dot(d, d)
    for i in range(3):
        mass[i, i] = m1 + m2
        mass[i, 6] = mass[6, i] = m2 * c[i]
        unit[:] = 0.0
        unit[i] = 1.0
        cross(unit, d, row)  # velocity of the second centre for a unit turn
        for j in range(3):
            mass[j, 3 + i] = mass[3 + i, j] = m2 * row[j]
        inertia_times(bodies[one], z1, unit, row)
        inertia_times(bodies[two], z2, unit, spun)
        for j in range(3):
            mass[3 + i, 3 + j] = row[j] + spun[j] - m2 * d[i] * d[j]
        mass[3 + i, 3 + i] += m2 * square
    inertia_times(bodies[two], z2, axis, spun)
    cross(d, c, row)
    for i in range(3):
        mass[3 + i, 6] = mass[6, 3 + i] = spun[i] + m2 * row[i]
    mass[6, 6] = dot(axis, spun) + m2 * dot(c, c)
    _invert(mass, inverse)


@njit(cache=True)
def _invert(matrix, out):
    """Inverse of a symmetric positive definite matrix, by Cholesky's factor: at this size LAPACK's calls cost more."""
    n = len(matrix)
    factor = np.zeros((n, n))  # inverse of the lower factor
    lower = np.zeros((n, n))
    for i in range(n):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= lower[i, k] * lower[j, k]
            lower[i, j] = np.sqrt(total) if i == j else total / lower[j, j]
    for j in range(n):
        factor[j, j] = 1 / lower[j, j]
        for i in range(j + 1, n):
            total = 0.0
            for k in range(j, i):
                total -= lower[i, k] * factor[k, j]
            factor[i, j] = total / lower[i, i]
    for i in range(n):
        for j in range(i + 1):
            total = 0.0
            for k in range(i, n):
                total += factor[k, i] * factor[k, j]
            out[i, j] = out[j, i] = total


@njit(cache=True)
def add_generalised(geometry, second, force, moment, out):
    """Add to out (7,) a force and a moment about the centre of the first half, or of the second one."""
    r1, r2, axis, _, _, c = geometry
    for i in range(3):
        out[i] += force[i]
        out[3 + i] += moment[i]
    if second:
        x, y, z = r1[0] - r2[0], r1[1] - r2[1], r1[2] - r2[2]
        out[3] += y * force[2] - z * force[1]
        out[4] += z * force[0] - x * force[2]
        out[5] += x * force[1] - y * force[0]
        out[6] += dot(axis, moment) + dot(c, force)


@njit(cache=True)
def second_twist(geometry, u, out):
    """Velocity of the second half's centre and its angular velocity (6,) in the motion u (7,)."""
    r1, r2, axis, _, _, c = geometry
    x, y, z = r1[0] - r2[0], r1[1] - r2[1], r1[2] - r2[2]
    out[0] = u[0] + u[4] * z - u[5] * y + u[6] * c[0]
    out[1] = u[1] + u[5] * x - u[3] * z + u[6] * c[1]
    out[2] = u[2] + u[3] * y - u[4] * x + u[6] * c[2]
    for i in range(3):
        out[3 + i] = u[3 + i] + u[6] * axis[i]
