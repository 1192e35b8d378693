"""Split rods: two rigid halves that turn against each other about a pin, as PyBullet holds them, compiled.

Coordinates are those of the engine: the pose of the first half and the angle of the pin. Velocities u (7,): that of the
first half's centre, its angular velocity, both in world axes, and the pin's rate. (Featherstone, Rigid Body Dynamics
Algorithms, 2008.)

A rod's geometry (6, 3), all in world axes: from the first and the second half's centre to the pin, the pin's axis, the
halves' own z axes, and the velocity of the second centre for a unit rate of the pin.
"""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel

from .model import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE
from .vectors import KERNEL, cross, dot, invert, rotate, z_axis


@kernel(**KERNEL)
def inertia_times(body, axis, w):
    """Moment of inertia of a body symmetric about ``axis`` times w (3,), as three numbers; body (4,) its parameters."""
    across, along = 1 / body[INVERSE_TRANSVERSE], 1 / body[INVERSE_AXIAL]
    part = (along - across) * dot(w, axis)
    return across * w[0] + part * axis[0], across * w[1] + part * axis[1], across * w[2] + part * axis[2]


@kernel(**KERNEL)
def second_poses(model, angles, poses):
    """Write the poses of the second halves into poses (b, 7), from those of the first and the pins' angles (p,)."""
    pins, params = model.pin_bodies, model.pin_params
    for p in range(len(pins)):
        first, second = poses[pins[p, 0]], poses[pins[p, 1]]
        s, w = np.sin(0.5 * angles[p]), np.cos(0.5 * angles[p])
        x, y, z = s * params[p, 6], s * params[p, 7], s * params[p, 8]
        a, b, c, d = first[3], first[4], first[5], first[6]
        second[3] = d * x + a * w + b * z - c * y
        second[4] = d * y + b * w + c * x - a * z
        second[5] = d * z + c * w + a * y - b * x
        second[6] = d * w - a * x - b * y - c * z
        arm, back = rotate(first[3:], params[p, 0:3]), rotate(second[3:], params[p, 3:6])
        for i in range(3):
            second[i] = first[i] + arm[i] - back[i]


@kernel(**KERNEL)
def split_rod_inertia(model, poses, out):
    """Write the geometry, mass matrix and inverse of every split rod in ``out``."""
    body_params, params = model.body_params, model.pin_params
    for p in range(len(params)):
        one, two = model.pin_bodies[p, 0], model.pin_bodies[p, 1]
        mass = out.pin_mass[p]
        r1, r2 = rotate(poses[one, 3:], params[p, 0:3]), rotate(poses[two, 3:], params[p, 3:6])
        axis, z1, z2 = rotate(poses[one, 3:], params[p, 6:9]), z_axis(poses[one, 3:]), z_axis(poses[two, 3:])
        c = cross(r2, axis)
        for i in range(3):
            geometry = out.pin_geometry[p]
            geometry[0, i], geometry[1, i], geometry[2, i] = r1[i], r2[i], axis[i]
            geometry[3, i], geometry[4, i], geometry[5, i] = z1[i], z2[i], c[i]
        m1, m2 = 1 / body_params[one, INVERSE_MASS], 1 / body_params[two, INVERSE_MASS]
        d = r1[0] - r2[0], r1[1] - r2[1], r1[2] - r2[2]
        mass[:] = 0.0
        square = dot(d, d)
        for i in range(3):
            unit = 1.0 * (i == 0), 1.0 * (i == 1), 1.0 * (i == 2)
            mass[i, i] = m1 + m2
            mass[i, 6] = mass[6, i] = m2 * c[i]
            row = cross(unit, d)  # velocity of the second centre for a unit turn
            for j in range(3):
                mass[j, 3 + i] = mass[3 + i, j] = m2 * row[j]
            first, second = inertia_times(body_params[one], z1, unit), inertia_times(body_params[two], z2, unit)
            for j in range(3):
                mass[3 + i, 3 + j] = first[j] + second[j] - m2 * d[i] * d[j]
            mass[3 + i, 3 + i] += m2 * square
        spun, row = inertia_times(body_params[two], z2, axis), cross(d, c)
        for i in range(3):
            mass[3 + i, 6] = mass[6, 3 + i] = spun[i] + m2 * row[i]
        mass[6, 6] = dot(axis, spun) + m2 * dot(c, c)
        invert(mass, out.pin_work[0], out.pin_work[1], out.pin_inverse[p])


@kernel(**KERNEL)
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


@kernel(**KERNEL)
def second_twist(geometry, u, out):
    """Write the velocity of the second half's centre and its angular velocity (6,) in the motion u (7,)."""
    r1, r2, axis, _, _, c = geometry
    x, y, z = r1[0] - r2[0], r1[1] - r2[1], r1[2] - r2[2]
    out[0] = u[0] + u[4] * z - u[5] * y + u[6] * c[0]
    out[1] = u[1] + u[5] * x - u[3] * z + u[6] * c[1]
    out[2] = u[2] + u[3] * y - u[4] * x + u[6] * c[2]
    for i in range(3):
        out[3 + i] = u[3 + i] + u[6] * axis[i]
