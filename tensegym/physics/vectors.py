"""Vectors, rotations and small matrices for compiled kernels: three components each, quaternions xyzw."""

from __future__ import annotations

from typing import Any

import numpy as np

from tensegym.compiled import kernel

ALLOCATING: dict[str, Any] = {"error_model": "numpy", "_nrt": True}  # division by zero: an infinity, no exception
# A kernel that makes no arrays needs no counts of references to them, a third of a substep's time
KERNEL: dict[str, Any] = ALLOCATING | {"_nrt": False}
# A call copies every word of a Model, a State and an Out, some hundreds: kernels of the step that take whole ones
INLINED: dict[str, Any] = KERNEL | {"forceinline": True}


@kernel(**KERNEL)
def dot(a, b):
    """a . b of vectors (3,)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(**KERNEL)
def cross(a, b):
    """a x b of vectors (3,), as three numbers."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel(**KERNEL)
def rotation_matrix(q, out):
    """Write the rotation matrix (3, 3) of a unit quaternion, body to world."""
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


@kernel(**KERNEL)
def z_axis(q):
    """World direction of a body's own z axis, as three numbers: the last column of its rotation matrix."""
    x, y, z, w = q[0], q[1], q[2], q[3]
    return 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)


@kernel(**KERNEL)
def rotate(q, v):
    """A vector (3,) turned by a unit quaternion, body to world, as three numbers."""
    x, y, z, w = q[0], q[1], q[2], q[3]
    tx = 2 * (y * v[2] - z * v[1])
    ty = 2 * (z * v[0] - x * v[2])
    tz = 2 * (x * v[1] - y * v[0])
    return v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx


@kernel(**KERNEL)
def turn(axis, w, time):
    """A vector (3,) turned by the angular velocity w (3,) for ``time`` (Rodrigues), as three numbers."""
    square = dot(w, w)
    s, c = sine_ratios(square * time * time)
    (x, y, z), sideways = axis, cross(w, axis)
    less, s, along = 1 - c * time * time * square, s * time, c * time * time * dot(w, axis)
    return (less * x + s * sideways[0] + along * w[0], less * y + s * sideways[1] + along * w[1],
            less * z + s * sideways[2] + along * w[2])  # fmt: skip


@kernel(**KERNEL)
def sine_ratios(square):
    """sin(a) / a and (1 - cos(a)) / a^2 of a^2. A body turns by little in a step: below 0.1 rad the series is exact to
    rounding, its first term left out being a^10 / 11! of the whole.
    """
    if square < 0.01:
        sine = 1 - square * (1 / 6 - square * (1 / 120 - square * (1 / 5040 - square * (1 / 362880))))
        versine = 1 / 2 - square * (1 / 24 - square * (1 / 720 - square * (1 / 40320 - square * (1 / 3628800))))
        return sine, versine
    angle = np.sqrt(square)
    return np.sin(angle) / angle, (1 - np.cos(angle)) / square


@kernel(**KERNEL)
def arcsine_ratio(square):
    """arcsin(s) / s of s^2 below 0.01; the first term left out is 1.2e-18."""
    high = 35 / 1152 + square * (63 / 2816 + square * (231 / 13312 + square * (143 / 10240)))
    return 1 + square * (1 / 6 + square * (3 / 40 + square * (5 / 112 + square * high)))


@kernel(**KERNEL)
def angular_velocity(pose, last, dt):
    """World angular velocity [rad/s], as three numbers, that took the orientation of the pose ``last`` (7,) to that of
    ``pose`` in ``dt`` [s]."""
    x0, y0, z0, w0 = last[3], last[4], last[5], last[6]
    x1, y1, z1, w1 = pose[3], pose[4], pose[5], pose[6]
    # q1 times the conjugate of q0
    x = w0 * x1 - w1 * x0 - (y1 * z0 - z1 * y0)
    y = w0 * y1 - w1 * y0 - (z1 * x0 - x1 * z0)
    z = w0 * z1 - w1 * z0 - (x1 * y0 - y1 * x0)
    w = w0 * w1 + x0 * x1 + y0 * y1 + z0 * z1
    square = x * x + y * y + z * z
    if square < 0.01:
        factor = 2 / dt * arcsine_ratio(square)
    else:
        size = np.sqrt(square)
        factor = 2 * np.arctan2(size, abs(w)) / (size * dt)
    if w < 0:
        factor = -factor
    return factor * x, factor * y, factor * z


@kernel(**KERNEL)
def invert(matrix, lower, factor, out):
    """Write the inverse of a symmetric positive definite matrix (n, n), by Cholesky's factor: at n = 7 LAPACK's calls
    cost more. lower, factor (n, n) are workspace."""
    n = len(matrix)
    for i in range(n):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= lower[i, k] * lower[j, k]
            lower[i, j] = np.sqrt(total) if i == j else total / lower[j, j]
    for j in range(n):
        factor[j, j] = 1 / lower[j, j]  # the inverse of the lower factor
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
