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

from .structure import FloatArray

# Columns of a body's parameter row; every body is symmetric about its z axis
INVERSE_MASS, INVERSE_TRANSVERSE, INVERSE_AXIAL, SPIN_DAMPING = range(4)


def step_back(poses: FloatArray, velocities: FloatArray, dt: float) -> None:
    """Move poses (b, 7) back along velocities (b, 6) by ``dt`` [s], in place."""
    poses[:, :3] -= dt * velocities[:, :3]
    back = Rotation.from_rotvec(-dt * velocities[:, 3:]) * Rotation.from_quat(poses[:, 3:])
    poses[:, 3:] = back.as_quat()


@njit(cache=True)
def angular_velocity(pose, last, dt, out):
    """World angular velocity (3,) [rad/s] that took the orientation of ``last`` (7,) to that of ``pose`` in ``dt``."""
    x0, y0, z0, w0 = last[3], last[4], last[5], last[6]
    x1, y1, z1, w1 = pose[3], pose[4], pose[5], pose[6]
    # q1 times the conjugate of q0
    x = w0 * x1 - w1 * x0 - (y1 * z0 - z1 * y0)
    y = w0 * y1 - w1 * y0 - (z1 * x0 - x1 * z0)
    z = w0 * z1 - w1 * z0 - (x1 * y0 - y1 * x0)
    w = w0 * w1 + x0 * x1 + y0 * y1 + z0 * z1
    size = np.sqrt(x * x + y * y + z * z)
    if w < 0:
        x, y, z, w = -x, -y, -z, -w
    factor = 2 / dt if size < 1e-12 else 2 * np.arctan2(size, w) / (size * dt)
    out[0], out[1], out[2] = factor * x, factor * y, factor * z


@njit(cache=True)
def turned(axis, w, angle_time, out):
    """``axis`` (3,) turned by w * angle_time (Rodrigues)."""
    speed = np.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    if speed * abs(angle_time) < 1e-12:
        out[:] = axis
        return
    ux, uy, uz = w[0] / speed, w[1] / speed, w[2] / speed
    c, s = np.cos(speed * angle_time), np.sin(speed * angle_time)
    along = (ux * axis[0] + uy * axis[1] + uz * axis[2]) * (1 - c)
    out[0] = c * axis[0] + s * (uy * axis[2] - uz * axis[1]) + along * ux
    out[1] = c * axis[1] + s * (uz * axis[0] - ux * axis[2]) + along * uy
    out[2] = c * axis[2] + s * (ux * axis[1] - uy * axis[0]) + along * uz


@njit(cache=True)
def bullet_gyroscopic_change(w, axis, across, along, dt, out):
    """What Bullet adds to the angular velocity w (3,) for the gyroscopic term, world axes.

    Explicit Euler, -dt I^-1 (w x I w), which for moments ``across`` and ``along`` ``axis`` is this closed form.
    """
    spin = w[0] * axis[0] + w[1] * axis[1] + w[2] * axis[2]
    factor = -dt * spin * (across - along) / across
    out[0] = factor * (axis[1] * w[2] - axis[2] * w[1])
    out[1] = factor * (axis[2] * w[0] - axis[0] * w[2])
    out[2] = factor * (axis[0] * w[1] - axis[1] * w[0])


@njit(cache=True)
def turn_bodies(poses, last_poses, bodies, partner, dt, wrenches):
    """Replace the moments in ``wrenches`` (b, 6) by those that make Bullet take a leapfrog step under them.

    Adds the damping of the spin about each body's axis first; halves of a pinned rod, those with a ``partner`` (b,) of
    0 or more, get nothing else here (pins.py).
    """
    w, new, old_middle, middle, axis = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    change, momentum = np.empty(3), np.empty(3)
    for b in range(len(poses)):
        across, along = 1 / bodies[b, INVERSE_TRANSVERSE], 1 / bodies[b, INVERSE_AXIAL]
        angular_velocity(poses[b], last_poses[b], dt, w)
        qx, qy, qz, qw = poses[b, 3], poses[b, 4], poses[b, 5], poses[b, 6]
        axis[0], axis[1], axis[2] = 2 * (qx * qz + qy * qw), 2 * (qy * qz - qx * qw), 1 - 2 * (qx * qx + qy * qy)
        spin = w[0] * axis[0] + w[1] * axis[1] + w[2] * axis[2]
        moment = wrenches[b, 3:]
        for i in range(3):
            moment[i] -= bodies[b, SPIN_DAMPING] * spin * axis[i]
        if partner[b] >= 0 or across == along:
            continue  # pinned, or a ball, which has no gyroscopic term
        turned(axis, w, -0.5 * dt, old_middle)
        for i in range(3):
            momentum[i] = across * w[i] + (along - across) * spin * old_middle[i] + dt * moment[i]
        on_axis = momentum[0] * axis[0] + momentum[1] * axis[1] + momentum[2] * axis[2]
        new[:] = w
        for _ in range(4):
            turned(axis, new, 0.5 * dt, middle)
            lag = 1 - (middle[0] * axis[0] + middle[1] * axis[1] + middle[2] * axis[2])
            spin = on_axis / (along + (across - along) * lag)
            for i in range(3):
                new[i] = (momentum[i] - (along - across) * spin * middle[i]) / across
        bullet_gyroscopic_change(w, axis, across, along, dt, change)
        for i in range(3):
            change[i] = new[i] - w[i] - change[i]
        part = change[0] * axis[0] + change[1] * axis[1] + change[2] * axis[2]
        for i in range(3):
            moment[i] = (across * change[i] + (along - across) * part * axis[i]) / dt
