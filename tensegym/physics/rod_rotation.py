"""Turning of thin rods, to second order and without drift.

Bullet steps the gyroscopic term by explicit Euler, which gives a spinning rod energy and angular momentum in proportion
to dt. The kernel knows that update, so it commands the torque that makes the step come out as leapfrog does:
L(n + 1/2) = L(n - 1/2) + dt torque(n), with L = I(axis at the half step) w. That conserves angular momentum exactly and
the spin of a free rod too.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray

# Columns of a body's parameter row; every body is symmetric about its z axis
INVERSE_MASS, INVERSE_TRANSVERSE, INVERSE_AXIAL, SPIN_DAMPING = range(4)


def step_back(poses: FloatArray, velocities: FloatArray, dt: float) -> None:
    """Move poses (b, 7) back along velocities (b, 6) by ``dt`` [s], in place."""
    poses[:, :3] -= dt * velocities[:, :3]
    back = Rotation.from_rotvec(-dt * velocities[:, 3:]) * Rotation.from_quat(poses[:, 3:])
    poses[:, 3:] = back.as_quat()


@njit(cache=True)
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


@njit(cache=True)
def arcsine_ratio(square):
    """arcsin(s) / s of s^2 below 0.01; the first term left out is 1.2e-18."""
    high = 35 / 1152 + square * (63 / 2816 + square * (231 / 13312 + square * (143 / 10240)))
    return 1 + square * (1 / 6 + square * (3 / 40 + square * (5 / 112 + square * high)))


@njit(cache=True)
def angular_velocity(pose, last, dt):
    """World angular velocity (3,) [rad/s] that took the orientation of ``last`` (7,) to that of ``pose`` in ``dt``."""
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


@njit(cache=True)
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True)
def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def turned(axis, w, time):
    """``axis`` (3,) turned by w * time (Rodrigues)."""
    square = dot(w, w)
    s, c = sine_ratios(square * time * time)
    (x, y, z), sideways = axis, cross(w, axis)
    less, s, along = 1 - c * time * time * square, s * time, c * time * time * dot(w, axis)
    return (less * x + s * sideways[0] + along * w[0], less * y + s * sideways[1] + along * w[1],
            less * z + s * sideways[2] + along * w[2])  # fmt: skip


@njit(cache=True)
def bullet_gyroscopic_change(w, axis, across, along, dt):
    """What Bullet adds to the angular velocity w (3,) for the gyroscopic term, world axes.

    Explicit Euler, -dt I^-1 (w x I w), which for moments ``across`` and ``along`` ``axis`` is this closed form.
    """
    x, y, z = cross(w, axis)
    factor = dt * dot(w, axis) * (across - along) / across
    return factor * x, factor * y, factor * z


@njit(cache=True)
def turn_bodies(poses, last_poses, bodies, partner, dt, wrenches):
    """Replace the moments in ``wrenches`` (b, 6) by those that make Bullet take a leapfrog step under them.

    Adds the damping of the spin about each body's axis first; halves of a pinned rod, those with a ``partner`` (b,) of
    0 or more, get nothing else here (pins.py).
    """
    for b in range(len(poses)):
        across, along = 1 / bodies[b, INVERSE_TRANSVERSE], 1 / bodies[b, INVERSE_AXIAL]
        w = angular_velocity(poses[b], last_poses[b], dt)
        qx, qy, qz, qw = poses[b, 3], poses[b, 4], poses[b, 5], poses[b, 6]
        axis = 2 * (qx * qz + qy * qw), 2 * (qy * qz - qx * qw), 1 - 2 * (qx * qx + qy * qy)
        moment = wrenches[b, 3:]
        for i in range(3):
            moment[i] -= bodies[b, SPIN_DAMPING] * dot(w, axis) * axis[i]
        if partner[b] >= 0 or across == along:
            continue  # pinned, or a ball, which has no gyroscopic term
        new = _leapfrog(w, axis, across, along, dt, moment)
        engine = bullet_gyroscopic_change(w, axis, across, along, dt)
        change = new[0] - w[0] - engine[0], new[1] - w[1] - engine[1], new[2] - w[2] - engine[2]
        part = (along - across) * dot(change, axis)
        for i in range(3):
            moment[i] = (across * change[i] + part * axis[i]) / dt


@njit(cache=True)
def _leapfrog(w, axis, across, along, dt, moment):
    """The angular velocity (3,) after a step: I(half a step on) w_new = I(half a step ago) w + dt moment.

    With the axis half a step on as axis + s w x axis + c w x (w x axis), solved for w_new with s, c and the last term
    those of the last guess. What slows it is the spin's change with the tilt: at 2 ms three passes leave some 1e-9 of
    the moment at 3 rad/s, 1e-6 at 20 rad/s.
    """
    flat, inverse, half = along - across, 1 / across, 0.5 * dt
    middle = turned(axis, w, -half)
    old = flat * dot(w, axis)
    momentum = (across * w[0] + old * middle[0] + dt * moment[0], across * w[1] + old * middle[1] + dt * moment[1],
                across * w[2] + old * middle[2] + dt * moment[2])  # fmt: skip
    on_axis = dot(momentum, axis)
    for _ in range(3):
        square, spin = dot(w, w), dot(w, axis)
        s, c = sine_ratios(square * half * half)
        c *= half * half
        new_spin = on_axis / (along - flat * c * (square - spin * spin))
        pull = flat * new_spin
        k, less, more = pull * half * s * inverse, pull * (1 - c * square), pull * c * spin
        # w_new + k w_new x axis = r
        r = (inverse * (momentum[0] - less * axis[0] - more * w[0]),
             inverse * (momentum[1] - less * axis[1] - more * w[1]),
             inverse * (momentum[2] - less * axis[2] - more * w[2]))  # fmt: skip
        side, on, scale = cross(r, axis), dot(r, axis), 1 / (1 + k * k)
        w = (on * axis[0] + scale * (r[0] - on * axis[0] - k * side[0]),
             on * axis[1] + scale * (r[1] - on * axis[1] - k * side[1]),
             on * axis[2] + scale * (r[2] - on * axis[2] - k * side[2]))  # fmt: skip
    return w
