"""The force kernel: cable lengths, tensions and drives to one force and one moment a body, compiled, on flat arrays.

Cables are spring-dampers, T = max(0, k (l - l0) + c dl/dt) and exactly 0 when l <= l0; two-way cables (the paper's
springs) leave out the max. Length rates are differenced in time, so only poses are read from the engine. Explicit
tensions use the state at the start of a step; implicit ones solve for the tensions at its end,

    (A + 1 / (dt c + dt^2 k)) T = (k (l + dt dl/dt - l0) + c dl/dt) / (dt c + dt^2 k),   A = J M^-1 J^T,

a linear complementarity problem with T >= 0, where J maps body velocities to length rates. It is symmetric positive
definite, so projected Gauss-Seidel converges to its only solution.

The flexure of a split rod is one more row: a two-way spring whose length is the angle of its pin [rad], tension its
moment [N m]. Where its own motion is slow against the step it keeps its explicit force in an implicit step too.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .drives import CURRENT, PULLED, VOLTAGE, drive_step
from .pins import add_generalised, pin_axis, pinned_inertia, second_poses, second_twist, step_pinned, symmetry_axis
from .rotation import INVERSE_AXIAL, INVERSE_MASS, INVERSE_TRANSVERSE, dot, turn_bodies

# Columns of a cable's parameter row
LOCAL_A, LOCAL_B, STIFFNESS, DAMPING, TWO_WAY = slice(0, 3), slice(3, 6), 6, 7, 8
# Entries of the running account, all since the last reset
DRIVE_WORK, ELECTRICAL_ENERGY, CENTRE_PATH, FOOT_PATH, FOOT_PATH_SUM = range(5)
ACCOUNT_SIZE = 5
GROUND_TOLERANCE = 1e-3  # m; a foot whose gap to the plane is below this is grounded
_MAX_SWEEPS, _TOLERANCE = 200, 1e-6  # of the implicit solve; changes below 1e-6 of the largest tension end it
_SLOW = 0.1  # (dt w)^2 and dt c A below which a flexure's row stays explicit; the scheme is stable up to 4


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
def cable_geometry(poses, ends, cables, turns, directions, lengths):
    """Unit directions from end a to end b, lengths, and the turning that a length's rate takes from each end's body.

    ends (c, 2) bodies, cables (c, 9) -> turns (c, 2, 3) [m], directions (c, 3), lengths (c,) [m]; world axes. The rate
    is directions . (v_b - v_a) + sum over the ends of turns . w, and a tension T exerts on end a the force T directions
    and the moment -T turns[0] about its body's centre, on end b -T directions and -T turns[1].
    """
    r = np.empty((len(poses), 3, 3))
    for b in range(len(poses)):
        rotation_matrix(poses[b, 3:], r[b])
    for c in range(len(ends)):
        square = 0.0
        for side in range(2):
            b, x, y, z = ends[c, side], cables[c, 3 * side], cables[c, 3 * side + 1], cables[c, 3 * side + 2]
            for i in range(3):
                turns[c, side, i] = r[b, i, 0] * x + r[b, i, 1] * y + r[b, i, 2] * z  # the arm, for now
        for i in range(3):
            directions[c, i] = (poses[ends[c, 1], i] + turns[c, 1, i]) - (poses[ends[c, 0], i] + turns[c, 0, i])
            square += directions[c, i] ** 2
        lengths[c] = np.sqrt(square)
        for i in range(3):
            directions[c, i] /= lengths[c]
        nx, ny, nz = directions[c, 0], directions[c, 1], directions[c, 2]
        for side in range(2):
            rx, ry, rz = turns[c, side, 0], turns[c, side, 1], turns[c, side, 2]
            sign = 1.0 if side == 1 else -1.0
            turns[c, side, 0] = sign * (ry * nz - rz * ny)
            turns[c, side, 1] = sign * (rz * nx - rx * nz)
            turns[c, side, 2] = sign * (rx * ny - ry * nx)


@njit(cache=True)
def flexure_geometry(poses, pins, pin_params, angles, first, turns, directions, lengths):
    """The rows of the flexures, from row ``first`` on, as `cable_geometry` gives those of the cables."""
    axis = np.empty(3)
    for p in range(len(pins)):
        pin_axis(poses, pins, pin_params, p, axis)
        lengths[first + p] = angles[p]
        for i in range(3):
            directions[first + p, i] = 0.0
            turns[first + p, 0, i], turns[first + p, 1, i] = -axis[i], axis[i]


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
def mobility_matrix(poses, ends, bodies, partner, pins, pin_params, turns, directions, out):
    """A = J M^-1 J^T (c, c) [1/kg] for bodies symmetric about their z axis, pinned pairs moving as their pin allows."""
    count = len(ends)
    response = np.zeros((len(poses), 6, count))  # accelerations of the bodies by a unit tension in each cable
    axis = np.empty((len(poses), 3))
    for b in range(len(poses)):
        symmetry_axis(poses[b], axis[b])
    for c in range(count):
        for side in range(2):
            body = ends[c, side]
            if partner[body] >= 0:
                continue
            sign = bodies[body, INVERSE_MASS] if side == 1 else -bodies[body, INVERSE_MASS]
            across = bodies[body, INVERSE_TRANSVERSE]
            more = (bodies[body, INVERSE_AXIAL] - across) * dot(turns[c, side], axis[body])
            for i in range(3):
                response[body, i, c] += sign * directions[c, i]
                response[body, 3 + i, c] += across * turns[c, side, i] + more * axis[body, i]
    if len(pins):
        _pinned_response(poses, ends, bodies, pins, pin_params, turns, directions, response)
    for c in range(count):
        a, b = response[ends[c, 0]], response[ends[c, 1]]
        x, y, z = directions[c]
        (ax, ay, az), (bx, by, bz) = turns[c]
        for d in range(c + 1):  # one loop over cables with the rest written out: it vectorises
            out[c, d] = (x * (b[0, d] - a[0, d]) + y * (b[1, d] - a[1, d]) + z * (b[2, d] - a[2, d])
                         + ax * a[3, d] + ay * a[4, d] + az * a[5, d]
                         + bx * b[3, d] + by * b[4, d] + bz * b[5, d])  # fmt: skip
    for c in range(count):
        for d in range(c):
            out[d, c] = out[c, d]


@njit(cache=True)
def _pinned_response(poses, ends, bodies, pins, pin_params, turns, directions, response):
    geometry, mass, inverse = np.empty((6, 3)), np.empty((7, 7)), np.empty((7, 7))
    push, motion, force, twist = np.empty(7), np.empty(7), np.empty(3), np.empty(6)
    for p in range(len(pins)):
        pinned_inertia(poses, bodies, pins, pin_params, p, geometry, mass, inverse)
        for c in range(len(ends)):
            for side in range(2):
                second = ends[c, side] == pins[p, 1]
                if not second and ends[c, side] != pins[p, 0]:
                    continue
                for i in range(3):
                    force[i] = directions[c, i] if side == 1 else -directions[c, i]
                push[:] = 0.0
                add_generalised(geometry, second, force, turns[c, side], push)
                for i in range(7):
                    total = 0.0
                    for j in range(7):
                        total += inverse[i, j] * push[j]
                    motion[i] = total
                second_twist(geometry, motion, twist)
                for i in range(6):
                    response[pins[p, 0], i, c] += motion[i]
                    response[pins[p, 1], i, c] += twist[i]


@njit(cache=True)
def implicit_tensions(poses, ends, cables, bodies, partner, pins, pin_params, turns, directions, lengths, rates,
                      natural, dt, tensions):  # fmt: skip
    """Tensions (c,) [N] at the end of the step; ``tensions`` holds the last step's as the starting guess."""
    count = len(ends)
    mobility = np.empty((count, count))
    mobility_matrix(poses, ends, bodies, partner, pins, pin_params, turns, directions, mobility)
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
    for c in range(count - len(pins), count):
        k, damping = cables[c, STIFFNESS], cables[c, DAMPING]
        if dt * mobility[c, c] * max(dt * k, damping) < _SLOW:
            weight[c] = np.inf
            tensions[c] = k * (lengths[c] - natural[c]) + damping * rates[c]
    residual = target.copy()  # target - A T, kept up to date: a whole row a change, which vectorises
    for c in range(count):
        if tensions[c] != 0:
            for d in range(count):
                residual[d] -= mobility[c, d] * tensions[c]
    for _ in range(_MAX_SWEEPS):
        change, scale = 0.0, 1e-9
        for c in range(count):
            if weight[c] == np.inf:
                continue
            new = tensions[c] + (residual[c] - weight[c] * tensions[c]) / (mobility[c, c] + weight[c])
            if cables[c, TWO_WAY] == 0 and new < 0:
                new = 0.0
            step = new - tensions[c]
            if step != 0:
                for d in range(count):
                    residual[d] -= mobility[c, d] * step
                tensions[c] = new
            change = max(change, abs(step))
            scale = max(scale, abs(new))
        if change <= _TOLERANCE * scale:
            break


@njit(cache=True)
def wrenches_of(ends, turns, directions, tensions, wrenches):
    """Force and moment (b, 6) on every body about its centre, world axes, by tensions (c,)."""
    wrenches[:] = 0.0
    for c in range(len(ends)):
        for side in range(2):
            pull = tensions[c] if side == 0 else -tensions[c]
            body = ends[c, side]
            for i in range(3):
                wrenches[body, i] += pull * directions[c, i]
                wrenches[body, 3 + i] -= tensions[c] * turns[c, side, i]


@njit(cache=True)
def start(poses, angles, ends, cables, pins, pin_params, springs):
    """Set lengths, rates, tensions of ``springs`` (4, c) for a state at rest; its last row is the natural lengths."""
    count, flexures = len(ends), len(ends) - len(pins)
    turns, directions = np.empty((count, 2, 3)), np.empty((count, 3))
    cable_geometry(poses, ends[:flexures], cables, turns, directions, springs[0])
    flexure_geometry(poses, pins, pin_params, angles, flexures, turns, directions, springs[0])
    springs[1] = 0.0
    explicit_tensions(cables, springs[0], springs[1], springs[3], springs[2])


@njit(cache=True)
def substep(poses, angles, wrenches, last_poses, ends, cables, bodies, partner, pins, pin_params, natural, lengths,
            tensions, rates, drive_constants, drives, first_driven, feet, foot_points, foot_radius, foot_positions,
            masses, account, dt, implicit):  # fmt: skip
    """One kernel a substep: geometry, tensions, wrenches (b, 6) in world axes about body centres, drives, account.

    Everything after ``pin_params`` and before ``dt``, and ``last_poses``, is state and is updated in place, and so are
    the poses of second halves; ``wrenches`` is written.
    """
    count = len(ends)
    turns, directions = np.empty((count, 2, 3)), np.empty((count, 3))
    before = tensions[first_driven : first_driven + len(drives)].copy()
    rates[:] = lengths
    second_poses(pins, pin_params, angles, poses)
    flexures = count - len(pins)
    cable_geometry(poses, ends[:flexures], cables, turns, directions, lengths)
    flexure_geometry(poses, pins, pin_params, angles, flexures, turns, directions, lengths)
    for c in range(count):
        rates[c] = (lengths[c] - rates[c]) / dt
    if implicit:
        implicit_tensions(poses, ends, cables, bodies, partner, pins, pin_params, turns, directions, lengths, rates,
                          natural, dt, tensions)  # fmt: skip
    else:
        explicit_tensions(cables, lengths, rates, natural, tensions)

    wrenches_of(ends, turns, directions, tensions, wrenches)
    turn_bodies(poses, last_poses, bodies, partner, dt, wrenches)
    if len(pins):
        step_pinned(poses, last_poses, bodies, pins, pin_params, rates[flexures:], dt, wrenches)

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
            path += np.sqrt((now[p, 0] - foot_positions[p, 0]) ** 2 + (now[p, 1] - foot_positions[p, 1]) ** 2)
    foot_positions[:] = now
    if grounded:
        account[FOOT_PATH] += path / grounded
        account[FOOT_PATH_SUM] += path
    dx, dy, total = 0.0, 0.0, 0.0
    for b in range(len(poses)):
        total += masses[b]
        dx += masses[b] * (poses[b, 0] - last_poses[b, 0])
        dy += masses[b] * (poses[b, 1] - last_poses[b, 1])
    account[CENTRE_PATH] += np.sqrt(dx * dx + dy * dy) / total
