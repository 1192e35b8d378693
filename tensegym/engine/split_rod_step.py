"""A leapfrog step of split rods, without drift, compiled.

Explicit velocity terms, as both engines have them, let a rod's momentum drift, so here, as for whole rods
(rod_rotation.py), the kernel commands what makes the engine's step come out as leapfrog does. With P(n + 1/2) the
momenta of both halves and T(n) the motions that the pin allows,

    T(n)^T (P(n + 1/2) - P(n - 1/2)) = dt T(n)^T (forces and moments on the halves),

solved for the rod's new velocity u by a few steps of Newton's method; the pin's reaction drops out, being equal and
opposite at one point. A translation and a turn of the whole rod are among the motions T, so linear and angular momentum
change by what acts from outside, to rounding. The engine is then given tau = M (u' - u) / dt + h, with its own mass
matrix M and velocity terms h. (Constraints at the old positions: Ryckaert, Ciccotti, Berendsen 1977.)
"""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel
from tensegym.physics.model import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE
from tensegym.physics.split_rods import add_generalised, inertia_times
from tensegym.physics.vectors import ALLOCATING, KERNEL, cross, dot, turn

_MOST_ITERATIONS, _TOLERANCE = 20, 1e-12  # changes of a velocity over (1 + the fastest); each is 1e-2 of the last


@kernel(**KERNEL)
def _spin_momentum(body, z, w, half_step):
    """Angular momentum, as three numbers, at the half step from the own axis z now."""
    middle = turn(z, w, half_step)
    across, along = 1 / body[INVERSE_TRANSVERSE], 1 / body[INVERSE_AXIAL]
    part = (along - across) * dot(w, z)
    return across * w[0] + part * middle[0], across * w[1] + part * middle[1], across * w[2] + part * middle[2]


@kernel(**KERNEL)
def _composed(w, axis, rate, dt):
    """Angular velocity, as three numbers, of a body turned by axis * rate * dt first and by w * dt then, in one dt."""
    speed = np.sqrt(dot(w, w))
    s = 0.5 * dt if speed * dt < 1e-12 else np.sin(0.5 * speed * dt) / speed
    x, y, z, q = s * w[0], s * w[1], s * w[2], np.cos(0.5 * speed * dt)
    t, r = np.sin(0.5 * rate * dt), np.cos(0.5 * rate * dt)
    a, b, c = t * axis[0], t * axis[1], t * axis[2]
    vx, vy, vz = q * a + r * x + y * c - z * b, q * b + r * y + z * a - x * c, q * c + r * z + x * b - y * a
    size = np.sqrt(vx * vx + vy * vy + vz * vz)
    real = q * r - x * a - y * b - z * c
    factor = 2 / dt if size < 1e-12 else 2 * np.arctan2(size, real) / (size * dt)
    return factor * vx, factor * vy, factor * vz


@kernel(**ALLOCATING)
def step_split_rods(model, state, dt, out):
    """Replace the wrenches on the halves of split rods by those that make the engine take a leapfrog step under them:
    force and moment on the first half, a moment along the pin on the second."""
    params, wrenches, cables = model.body_params, out.wrenches, len(state.rates) - len(state.angles)
    u, old, goal, got = np.empty(7), np.empty(7), np.empty(7), np.empty(7)
    v, w, bend = np.empty(3), np.empty(3), np.empty(3)
    for p in range(len(model.pin_bodies)):
        one, two = model.pin_bodies[p, 0], model.pin_bodies[p, 1]
        geometry, mass, inverse = out.pin_geometry[p], out.pin_mass[p], out.pin_inverse[p]
        r1, r2, axis, z1, z2, _ = geometry
        m1, m2 = 1 / params[one, INVERSE_MASS], 1 / params[two, INVERSE_MASS]
        # what the momenta are to become along the motions that the pin allows
        goal[:] = 0.0
        for side in range(2):
            row = model.pin_bodies[p, side]
            spin = out.velocities[row, 3], out.velocities[row, 4], out.velocities[row, 5]
            momentum = _spin_momentum(params[row], z1 if side == 0 else z2, spin, -0.5 * dt)
            for i in range(3):
                v[i] = out.velocities[row, i]
                if side == 0:
                    old[i], old[3 + i] = v[i], spin[i]
                v[i] = v[i] / params[row, INVERSE_MASS] + dt * wrenches[row, i]
                w[i] = momentum[i] + dt * wrenches[row, 3 + i]
            add_generalised(geometry, side == 1, v, w, goal)
        old[6] = state.rates[cables + p]
        u[:] = old
        for _ in range(_MOST_ITERATIONS):
            second = _composed(u[3:6], axis, u[6], dt)
            moved, back = turn(r1, u[3:6], dt), turn(r2, second, dt)
            got[:] = 0.0
            for i in range(3):
                v[i] = m1 * u[i]
            add_generalised(geometry, False, v, _spin_momentum(params[one], z1, u[3:6], 0.5 * dt), got)
            for i in range(3):
                v[i] = m2 * (u[i] + ((moved[i] - r1[i]) - (back[i] - r2[i])) / dt)
            add_generalised(geometry, True, v, _spin_momentum(params[two], z2, second, 0.5 * dt), got)
            change, fastest = 0.0, 1.0
            for i in range(7):
                step = 0.0
                for j in range(7):
                    step += inverse[i, j] * (goal[j] - got[j])
                u[i] += step
                change = max(change, abs(step))
                fastest = max(fastest, abs(u[i]))
            if not change > _TOLERANCE * fastest:
                break
        _engine_bias(params[one], params[two], geometry, old, got)
        for i in range(7):
            for j in range(7):
                got[i] += mass[i, j] * (u[j] - old[j]) / dt
        for i in range(3):
            bend[i] = got[6] * axis[i]
            wrenches[one, i] = got[i]
            wrenches[one, 3 + i] = got[3 + i] - bend[i]
            wrenches[two, i] = 0.0
            wrenches[two, 3 + i] = bend[i]


@kernel(**KERNEL)
def _engine_bias(one, two, geometry, u, out):
    """Write the velocity terms h (7,) of the rod at velocity u, as the engine takes them: at the old state. one, two:
    the halves' parameters (4,)."""
    r1, r2, axis, z1, z2, _ = geometry
    w1 = u[3], u[4], u[5]
    along = u[6] * axis[0], u[6] * axis[1], u[6] * axis[2]
    w2 = w1[0] + along[0], w1[1] + along[1], w1[2] + along[2]
    turning = cross(w1, along)  # angular acceleration of the second half at constant u
    out[:] = 0.0
    add_generalised(geometry, False, (0.0, 0.0, 0.0), cross(w1, inertia_times(one, z1, w1)), out)
    to_pin, lag, from_pin = cross(w1, cross(w1, r1)), cross(turning, r2), cross(w2, cross(w2, r2))
    mass = two[INVERSE_MASS]
    force = ((to_pin[0] - lag[0] - from_pin[0]) / mass, (to_pin[1] - lag[1] - from_pin[1]) / mass,
             (to_pin[2] - lag[2] - from_pin[2]) / mass)  # fmt: skip
    gyroscopic, change = cross(w2, inertia_times(two, z2, w2)), inertia_times(two, z2, turning)
    moment = gyroscopic[0] + change[0], gyroscopic[1] + change[1], gyroscopic[2] + change[2]
    add_generalised(geometry, True, force, moment, out)
