"""A leapfrog step of pinned rods (pins.py), without drift.

PyBullet's explicit velocity terms let a multibody's momentum drift, so here, as for whole rods (rotation.py), the
kernel commands what makes the engine's step come out as leapfrog does. With P(n + 1/2) the momenta of both halves and
T(n) the motions that the pin allows,

    T(n)^T (P(n + 1/2) - P(n - 1/2)) = dt T(n)^T (forces and moments on the halves),

solved for the rod's new velocity u by a few steps of Newton's method; the pin's reaction drops out, being equal and
opposite at one point. A translation and a turn of the whole rod are among the motions T, so linear and angular momentum
change by what acts from outside, to rounding. The engine is then given tau = M (u' - u) / dt + h, with its own mass
matrix M and velocity terms h. (Constraints at the old positions: Ryckaert, Ciccotti, Berendsen 1977.)
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .rod_rotation import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE, angular_velocity, dot, turned
from .split_rods import add_generalised, cross, inertia_times, pinned_inertia

_MOST_ITERATIONS, _TOLERANCE = 20, 1e-12  # changes of a velocity over (1 + the fastest); each is 1e-2 of the last


@njit(cache=True)
def _spin_momentum(body, z, w, half_step, out):
    """Angular momentum at the half step from the own axis z now."""
    middle = np.empty(3)
    middle[:] = turned(z, w, half_step)
    across, along = 1 / body[INVERSE_TRANSVERSE], 1 / body[INVERSE_AXIAL]
    part = (along - across) * dot(w, z)
    for i in range(3):
        out[i] = across * w[i] + part * middle[i]


@njit(cache=True)
def _composed(w, axis, rate, dt, out):
    """Angular velocity (3,) of a body that is turned by axis * rate * dt first and by w * dt then, in one step dt."""
    speed = np.sqrt(dot(w, w))
    s = 0.5 * dt if speed * dt < 1e-12 else np.sin(0.5 * speed * dt) / speed
    x, y, z, q = s * w[0], s * w[1], s * w[2], np.cos(0.5 * speed * dt)
    t, r = np.sin(0.5 * rate * dt), np.cos(0.5 * rate * dt)
    a, b, c = t * axis[0], t * axis[1], t * axis[2]
    vx, vy, vz = q * a + r * x + y * c - z * b, q * b + r * y + z * a - x * c, q * c + r * z + x * b - y * a
    size = np.sqrt(vx * vx + vy * vy + vz * vz)
    real = q * r - x * a - y * b - z * c
    factor = 2 / dt if size < 1e-12 else 2 * np.arctan2(size, real) / (size * dt)
    out[0], out[1], out[2] = factor * vx, factor * vy, factor * vz


@njit(cache=True)
def step_pinned(poses, last_poses, bodies, pins, params, rates, dt, wrenches):
    """Replace the wrenches (b, 6) on pinned halves by those that make the engine take a leapfrog step under them: force
    and moment on the first half, a moment along the pin on the second. rates (p,) of the pins over the last step."""
    geometry, mass, inverse = np.empty((6, 3)), np.empty((7, 7)), np.empty((7, 7))
    u, old, goal, got = np.empty(7), np.empty(7), np.empty(7), np.empty(7)
    w2, v, spin, moved, back = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for p in range(len(pins)):
        one, two = pins[p, 0], pins[p, 1]
        pinned_inertia(poses, bodies, pins, params, p, geometry, mass, inverse)
        r1, r2, axis, z1, z2, _ = geometry
        m1, m2 = 1 / bodies[one, INVERSE_MASS], 1 / bodies[two, INVERSE_MASS]
        # what the momenta are to become along the motions that the pin allows
        goal[:] = 0.0
        for side in range(2):
            row = pins[p, side]
            w2[:] = angular_velocity(poses[row], last_poses[row], dt)
            _spin_momentum(bodies[row], z1 if side == 0 else z2, w2, -0.5 * dt, spin)
            for i in range(3):
                v[i] = (poses[row, i] - last_poses[row, i]) / dt
                if side == 0:
                    old[i], old[3 + i] = v[i], w2[i]
                v[i] = v[i] / bodies[row, INVERSE_MASS] + dt * wrenches[row, i]
                spin[i] += dt * wrenches[row, 3 + i]
            add_generalised(geometry, side == 1, v, spin, goal)
        old[6] = rates[p]
        u[:] = old
        for _ in range(_MOST_ITERATIONS):
            _composed(u[3:6], axis, u[6], dt, w2)
            moved[:] = turned(r1, u[3:6], dt)
            back[:] = turned(r2, w2, dt)
            got[:] = 0.0
            for i in range(3):
                v[i] = m1 * u[i]
            _spin_momentum(bodies[one], z1, u[3:6], 0.5 * dt, spin)
            add_generalised(geometry, False, v, spin, got)
            for i in range(3):
                v[i] = m2 * (u[i] + ((moved[i] - r1[i]) - (back[i] - r2[i])) / dt)
            _spin_momentum(bodies[two], z2, w2, 0.5 * dt, spin)
            add_generalised(geometry, True, v, spin, got)
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
        _engine_bias(bodies, one, two, geometry, old, got)
        for i in range(7):
            for j in range(7):
                got[i] += mass[i, j] * (u[j] - old[j]) / dt
        for i in range(3):
            wrenches[one, i] = got[i]
            wrenches[one, 3 + i] = got[3 + i] - got[6] * axis[i]
            wrenches[two, i] = 0.0
            wrenches[two, 3 + i] = got[6] * axis[i]


@njit(cache=True)
def _engine_bias(bodies, one, two, geometry, u, out):
    """Velocity terms h (7,) of the rod at velocity u, as the engine takes them: at the old state."""
    r1, r2, axis, z1, z2, _ = geometry
    w1, w2, turning, gone = u[3:6], np.empty(3), np.empty(3), np.empty(3)
    force, moment, spin = np.empty(3), np.empty(3), np.empty(3)
    out[:] = 0.0
    inertia_times(bodies[one], z1, w1, spin)
    cross(w1, spin, moment)
    force[:] = 0.0
    add_generalised(geometry, False, force, moment, out)
    for i in range(3):
        w2[i] = w1[i] + u[6] * axis[i]
        gone[i] = u[6] * axis[i]
    cross(w1, gone, turning)  # angular acceleration of the second half at constant u
    cross(w1, r1, spin)
    cross(w1, spin, force)
    cross(turning, r2, gone)
    for i in range(3):
        force[i] -= gone[i]
    cross(w2, r2, spin)
    cross(w2, spin, gone)
    for i in range(3):
        force[i] = (force[i] - gone[i]) / bodies[two, INVERSE_MASS]
    inertia_times(bodies[two], z2, w2, spin)
    cross(w2, spin, moment)
    inertia_times(bodies[two], z2, turning, spin)
    for i in range(3):
        moment[i] += spin[i]
    add_generalised(geometry, True, force, moment, out)
