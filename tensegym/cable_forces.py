"""The force kernel: cable lengths, tensions and drives to one force and one moment a body, compiled, on flat arrays.

Cables are spring-dampers, T = max(0, k (l - l0) + c dl/dt) and exactly 0 when l <= l0; two-way cables (the paper's
springs) leave out the max. Length rates are differenced in time, so only poses are read from the engine. Explicit
tensions use the state at the start of a step; implicit ones solve for the tensions at its end,

    (A + 1 / (dt c + dt^2 k)) T = (k (l + dt dl/dt - l0) + c dl/dt) / (dt c + dt^2 k),   A = J M^-1 J^T,

a linear complementarity problem with T >= 0, where J maps body velocities to length rates. It is symmetric positive
definite, so projected Gauss-Seidel converges to its only solution.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .drives import CURRENT, PULLED, VOLTAGE, drive_step
from .rotation import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE, turn_bodies

# Columns of a cable's parameter row
LOCAL_A, LOCAL_B, STIFFNESS, DAMPING, TWO_WAY = slice(0, 3), slice(3, 6), 6, 7, 8
# Entries of the running account, all since the last reset
DRIVE_WORK, ELECTRICAL_ENERGY, CENTRE_PATH, FOOT_PATH, FOOT_PATH_SUM = range(5)
ACCOUNT_SIZE = 5
GROUND_TOLERANCE = 1e-3  # m; a foot whose gap to the plane is below this is grounded
_MAX_SWEEPS, _TOLERANCE = 200, 1e-6  # of the implicit solve; changes below 1e-6 of the largest tension end it


@njit(cache=True)
def rotation_matrix(q, out):
    """Rotation matrix of a unit quaternion xyzw, body to world."""
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


@njit(cache=True)
def points_in_world(poses, bodies, locals_, out):
    """Points fixed in bodies: poses (b, 7) position and xyzw, bodies (p,), locals_ (p, 3) -> out (p, 3) [m]."""
    rotation = np.empty((3, 3))
    last = -1
    for p in range(len(bodies)):
        body = bodies[p]
        if body != last:
            rotation_matrix(poses[body, 3:], rotation)
            last = body
        for i in range(3):
            out[p, i] = poses[body, i] + (
                rotation[i, 0] * locals_[p, 0] + rotation[i, 1] * locals_[p, 1] + rotation[i, 2] * locals_[p, 2]
            )


@njit(cache=True)
def cable_geometry(poses, ends, cables, arms, directions, lengths):
    """Cable ends as arms from their bodies' centres, unit directions from end a to end b, lengths; world axes, m.

    ends (c, 2) bodies, cables (c, 9) -> arms (c, 2, 3), directions (c, 3), lengths (c,).
    """
    rotations = np.empty((len(poses), 3, 3))
    for b in range(len(poses)):
        rotation_matrix(poses[b, 3:], rotations[b])
    for c in range(len(ends)):
        square = 0.0
        for i in range(3):
            for side in range(2):
                r = rotations[ends[c, side]]
                o = 3 * side
                arms[c, side, i] = r[i, 0] * cables[c, o] + r[i, 1] * cables[c, o + 1] + r[i, 2] * cables[c, o + 2]
            directions[c, i] = (poses[ends[c, 1], i] + arms[c, 1, i]) - (poses[ends[c, 0], i] + arms[c, 0, i])
            square += directions[c, i] ** 2
        lengths[c] = np.sqrt(square)
        directions[c] /= lengths[c]


@njit(cache=True)
def explicit_tensions(cables, lengths, rates, natural, tensions):
    """Tensions (c,) [N] of the state as it is."""
    for c in range(len(tensions)):
        stretch = lengths[c] - natural[c]
        tension = cables[c, STIFFNESS] * stretch + cables[c, DAMPING] * rates[c]
        if cables[c, TWO_WAY] == 0 and (stretch <= 0 or tension < 0):
            tension = 0.0
        tensions[c] = tension


@njit(cache=True)
def mobility_matrix(poses, ends, bodies, arms, directions, out):
    """A = J M^-1 J^T (c, c) [1/kg] for bodies symmetric about their z axis."""
    count = len(ends)
    turns = np.empty((count, 2, 3))  # angular part of a unit tension's generalised force
    accelerations = np.empty((count, 2, 3))  # angular acceleration it causes
    axis = np.empty((len(poses), 3))
    for b in range(len(poses)):
        x, y, z, w = poses[b, 3], poses[b, 4], poses[b, 5], poses[b, 6]
        axis[b, 0], axis[b, 1], axis[b, 2] = 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)
    for c in range(count):
        for side in range(2):
            body = ends[c, side]
            turn, a = turns[c, side], axis[body]
            r, n = arms[c, side], directions[c]
            sign = 1.0 if side == 1 else -1.0
            turn[0] = sign * (r[1] * n[2] - r[2] * n[1])
            turn[1] = sign * (r[2] * n[0] - r[0] * n[2])
            turn[2] = sign * (r[0] * n[1] - r[1] * n[0])
            along = turn[0] * a[0] + turn[1] * a[1] + turn[2] * a[2]
            across = bodies[body, INVERSE_TRANSVERSE]
            for i in range(3):
                accelerations[c, side, i] = across * turn[i] + (bodies[body, INVERSE_AXIAL] - across) * along * a[i]
    for c in range(count):
        for d in range(c + 1):
            total = 0.0
            for side in range(2):
                for other in range(2):
                    if ends[c, side] != ends[d, other]:
                        continue
                    body = ends[c, side]
                    sign = 1.0 if side == other else -1.0
                    for i in range(3):
                        total += sign * bodies[body, INVERSE_MASS] * directions[c, i] * directions[d, i]
                        total += turns[c, side, i] * accelerations[d, other, i]
            out[c, d] = total
            out[d, c] = total


@njit(cache=True, fastmath={"reassoc", "contract"})
def _dot(a, b):
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@njit(cache=True)
def implicit_tensions(poses, ends, cables, bodies, arms, directions, lengths, rates, natural, dt, tensions):
    """Tensions (c,) [N] at the end of the step; ``tensions`` holds the last step's as the starting guess."""
    count = len(ends)
    mobility = np.empty((count, count))
    mobility_matrix(poses, ends, bodies, arms, directions, mobility)
    weight, target = np.empty(count), np.empty(count)
    for c in range(count):
        k, damping = cables[c, STIFFNESS], cables[c, DAMPING]
        weight[c] = 1 / (dt * damping + dt * dt * k)
        stretch = lengths[c] + dt * rates[c] - natural[c]
        target[c] = weight[c] * (k * stretch + damping * rates[c])
        if cables[c, TWO_WAY] == 0 and stretch <= 0:
            target[c] = 0.0  # stays slack
            weight[c] = np.inf
            tensions[c] = 0.0
    for _ in range(_MAX_SWEEPS):
        change, scale = 0.0, 1e-9
        for c in range(count):
            if weight[c] == np.inf:
                continue
            rest = target[c] - _dot(mobility[c], tensions)
            new = tensions[c] + (rest - weight[c] * tensions[c]) / (mobility[c, c] + weight[c])
            if cables[c, TWO_WAY] == 0 and new < 0:
                new = 0.0
            change = max(change, abs(new - tensions[c]))
            scale = max(scale, abs(new))
            tensions[c] = new
        if change <= _TOLERANCE * scale:
            break


@njit(cache=True)
def substep(poses, last_poses, ends, cables, bodies, natural, lengths, tensions, rates, drive_constants, drives,
            first_driven, feet, foot_points, foot_radius, foot_positions, masses, account, dt, implicit,
            wrenches):  # fmt: skip
    """One kernel a substep: geometry, tensions, wrenches (b, 6) in world axes about body centres, drives, account.

    Everything after ``cables`` and before ``dt`` is state and is updated in place; ``wrenches`` is written.
    """
    count = len(ends)
    arms, directions = np.empty((count, 2, 3)), np.empty((count, 3))
    before = tensions[first_driven : first_driven + len(drives)].copy()
    rates[:] = lengths
    cable_geometry(poses, ends, cables, arms, directions, lengths)
    for c in range(count):
        rates[c] = (lengths[c] - rates[c]) / dt
    if implicit:
        implicit_tensions(poses, ends, cables, bodies, arms, directions, lengths, rates, natural, dt, tensions)
    else:
        explicit_tensions(cables, lengths, rates, natural, tensions)

    wrenches[:] = 0.0
    for c in range(count):
        for side in range(2):
            pull = tensions[c] if side == 0 else -tensions[c]
            w, r, n = wrenches[ends[c, side]], arms[c, side], directions[c]
            for i in range(3):
                w[i] += pull * n[i]
            w[3] += pull * (r[1] * n[2] - r[2] * n[1])
            w[4] += pull * (r[2] * n[0] - r[0] * n[2])
            w[5] += pull * (r[0] * n[1] - r[1] * n[0])
    turn_bodies(poses, last_poses, bodies, dt, wrenches)

    for d in range(len(drives)):
        c = first_driven + d
        # trapezoidal: the pull of the last step was made between the last tension and this one
        account[DRIVE_WORK] += 0.5 * (before[d] + tensions[c]) * drives[d, PULLED]
        drive_step(drive_constants, drives[d], tensions[c], dt)
        natural[c] -= drives[d, PULLED]
        account[ELECTRICAL_ENERGY] += max(0.0, drives[d, CURRENT] * drives[d, VOLTAGE]) * dt

    _account_feet(poses, last_poses, feet, foot_points, foot_radius, foot_positions, masses, account, dt)
    last_poses[:] = poses


@njit(cache=True)
def _account_feet(poses, last_poses, feet, foot_points, foot_radius, foot_positions, masses, account, dt):
    """Add the horizontal paths of the grounded feet's centres (mean and sum over feet) and of the centre of mass."""
    now = np.empty_like(foot_positions)
    points_in_world(poses, feet, foot_points, now)
    grounded, path = 0, 0.0
    for p in range(len(feet)):
        limit = foot_radius[p] + GROUND_TOLERANCE
        if now[p, 2] <= limit and foot_positions[p, 2] <= limit:
            grounded += 1
            path += np.hypot(now[p, 0] - foot_positions[p, 0], now[p, 1] - foot_positions[p, 1])
    foot_positions[:] = now
    if grounded:
        account[FOOT_PATH] += path / grounded
        account[FOOT_PATH_SUM] += path
    dx, dy, total = 0.0, 0.0, 0.0
    for b in range(len(poses)):
        total += masses[b]
        dx += masses[b] * (poses[b, 0] - last_poses[b, 0])
        dy += masses[b] * (poses[b, 1] - last_poses[b, 1])
    account[CENTRE_PATH] += np.hypot(dx, dy) / total
