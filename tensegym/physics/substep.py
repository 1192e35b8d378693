"""The kernel of a substep: from poses to one force and one moment a body, drives and the running totals, compiled.

Which engine steps the bodies, and what it does wrong in that, it does not know.
"""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel

from .cable_law import explicit_tensions, implicit_tensions, tension_wrenches
from .drives import CURRENT, PULLED, VOLTAGE, drive_step
from .geometry import points_in_world, spring_geometry
from .model import CENTRE_PATH, DRIVE_WORK, ELECTRICAL_ENERGY, FOOT_PATH, FOOT_PATH_SUM, PEAK_TENSION
from .spin import damp_spins
from .split_rods import second_poses, split_rod_inertia
from .terrain import distance_to_ground
from .vectors import INLINED, KERNEL

GROUND_TOLERANCE = 1e-3  # m; a foot whose gap to the ground is below this is grounded


@kernel(**INLINED)
def substep(model, ground, state, out, dt, implicit):
    """Geometry, tensions, wrenches, drives, totals: ``state`` is updated, ``out`` written; out.wrenches act on the
    bodies.

    model, state, out: see model.py. ground: a terrain.Ground. dt [s]. implicit: which tensions, see cable_law.py.
    """
    driven, tensions = model.first_driven, state.tensions
    for d in range(len(state.drives)):
        out.last_tensions[d] = tensions[driven + d]
    second_poses(model, state.angles, state.poses)
    for c in range(len(tensions)):
        state.rates[c] = state.lengths[c]
    spring_geometry(model, state.poses, state.angles, out, state.lengths)
    for c in range(len(tensions)):
        state.rates[c] = (state.lengths[c] - state.rates[c]) / dt
    split_rod_inertia(model, state.poses, out)
    if implicit:
        implicit_tensions(model, out, state.lengths, state.rates, state.natural, dt, tensions)
    else:
        explicit_tensions(model.spring_params, state.lengths, state.rates, state.natural, tensions)

    tension_wrenches(model.spring_bodies, out, tensions)
    damp_spins(model.body_params, state.poses, state.last_poses, dt, out.rotations, out.velocities, out.wrenches)
    _wind(model, state, out, dt)
    peak = state.totals[PEAK_TENSION]
    for c in range(len(tensions) - len(model.pin_bodies)):
        peak = max(peak, tensions[c])
    state.totals[PEAK_TENSION] = peak
    _add_paths(model, ground, state, out)
    poses, last_poses = state.poses, state.last_poses
    for b in range(len(poses)):
        for i in range(7):
            last_poses[b, i] = poses[b, i]


@kernel(**KERNEL)
def reset_springs(model, state, out):
    """Set lengths, rates and tensions for a state at rest."""
    spring_geometry(model, state.poses, state.angles, out, state.lengths)
    state.rates[:] = 0.0
    explicit_tensions(model.spring_params, state.lengths, state.rates, state.natural, state.tensions)


@kernel(**INLINED)
def _wind(model, state, out, dt):
    """Advance the drives under their cables' tensions, and add up what they do and take."""
    totals, drives = state.totals, state.drives
    for d in range(len(drives)):
        c = model.first_driven + d
        # trapezoidal: the pull of the last step was made between the last tension and this one
        totals[DRIVE_WORK] += 0.5 * (out.last_tensions[d] + state.tensions[c]) * drives[d, PULLED]
        drive_step(model.drive_params[d], drives[d], state.tensions[c], dt)
        state.natural[c] -= drives[d, PULLED]
        totals[ELECTRICAL_ENERGY] += max(0.0, drives[d, CURRENT] * drives[d, VOLTAGE]) * dt


@kernel(**INLINED)
def _add_paths(model, ground, state, out):
    """Add the horizontal paths of the grounded feet's centres (mean and sum over feet) and of the centre of mass."""
    now, before, totals = out.new_positions, state.node_positions, state.totals
    points_in_world(state.poses, out.rotations, model.node_bodies, model.node_points, now)
    grounded, path = 0, 0.0
    for p in range(len(now)):
        limit = model.foot_radii[p] + GROUND_TOLERANCE
        if distance_to_ground(now[p], ground) <= limit and distance_to_ground(before[p], ground) <= limit:
            grounded += 1
            path += np.sqrt((now[p, 0] - before[p, 0]) ** 2 + (now[p, 1] - before[p, 1]) ** 2)
        for i in range(3):
            before[p, i] = now[p, i]
    if grounded:
        totals[FOOT_PATH] += path / grounded
        totals[FOOT_PATH_SUM] += path
    dx, dy, total = 0.0, 0.0, 0.0
    for b in range(len(model.masses)):
        total += model.masses[b]
        dx += model.masses[b] * (state.poses[b, 0] - state.last_poses[b, 0])
        dy += model.masses[b] * (state.poses[b, 1] - state.last_poses[b, 1])
    totals[CENTRE_PATH] += np.sqrt(dx * dx + dy * dy) / total
