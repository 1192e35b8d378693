"""The kernel of a substep: from poses to one force and one moment a body, drives and the running account, compiled."""

from __future__ import annotations

import numpy as np
from numba import njit

from .cable_geometry import cable_geometry, flexure_geometry, points_in_world
from .cable_law import explicit_tensions, implicit_tensions, wrenches_of
from .drives import CURRENT, PULLED, VOLTAGE, drive_step
from .rod_rotation import turn_bodies
from .split_rod_step import step_pinned
from .split_rods import second_poses
from .terrain import distance_to_ground

# Entries of the running account, all since the last reset
DRIVE_WORK, ELECTRICAL_ENERGY, CENTRE_PATH, FOOT_PATH, FOOT_PATH_SUM = range(5)
ACCOUNT_SIZE = 5
GROUND_TOLERANCE = 1e-3  # m; a foot whose gap to the ground is below this is grounded


@njit(cache=True)
def substep(poses, angles, wrenches, last_poses, ends, cables, bodies, partner, pins, pin_params, natural, lengths,
            tensions, rates, drive_constants, drives, first_driven, heights, cell, feet, foot_points, foot_radius,
            foot_positions, masses, account, dt, implicit):  # fmt: skip
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

    _account_feet(poses, last_poses, heights, cell, feet, foot_points, foot_radius, foot_positions, masses, account)
    last_poses[:] = poses


@njit(cache=True)
def _account_feet(poses, last_poses, heights, cell, feet, foot_points, foot_radius, foot_positions, masses, account):
    """Add the horizontal paths of the grounded feet's centres (mean and sum over feet) and of the centre of mass."""
    now = np.empty_like(foot_positions)
    points_in_world(poses, feet, foot_points, now)
    grounded, path = 0, 0.0
    for p in range(len(feet)):
        limit = foot_radius[p] + GROUND_TOLERANCE
        height, before = distance_to_ground(now[p], heights, cell), distance_to_ground(foot_positions[p], heights, cell)
        if height <= limit and before <= limit:
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
