"""The robot pulled as deep as its drives can: where its springs come to rest, for bounds on what pulling stiffens."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.compiled import kernel
from tensegym.design.design import RobotDesign
from tensegym.design.groups import column
from tensegym.design.parameters import Drive

from .geometry import spring_geometry
from .model import STIFFNESS, TWO_WAY, Model, new_out
from .split_rods import second_poses, split_rod_inertia
from .tangent import first_columns, generalised_forces
from .vectors import ALLOCATING

PULLING, RESTING = 300, 500  # steps of the relaxation while the cables are wound in, and after
KEPT = 0.85  # of the velocity in a step
YIELDING = 10.0  # stiff cables are taken no stiffer than so many elastic ones, or as makes this of the drives' pull


def stall_tension(drive: Drive) -> float:
    """Tension that a drive can just wind in [N]."""
    current = min(drive.current_limit, drive.voltage_limit / drive.resistance) - drive.friction_current
    pull = max(0.0, current) * drive.torque_constant * drive.gear_ratio / drive.spool_radius
    return pull * drive.gear_efficiency


def pulled_state(
    design: RobotDesign, model: Model, part: float | FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Poses (b, 7), pins' angles (p,) and tensions (s,) with all stiff cables wound in, each by a part of its deepest
    pull, one or (w,), or to the tension that stalls its drive.

    Dynamic relaxation (Day 1965; Barnes 1999, "Form finding and analysis of tension structures"): the springs move
    bodies whose masses are the stiffness around them, so that steps of one are stable, under damping. Contacts are left
    out. Tensions are within some 20 % of those that a simulation ends at.
    """
    pull = part * column(design.each_stiff_cable, "max_pull") * design.stiff_cable_lengths
    stall = np.array([stall_tension(drive) for drive in design.each_drive])
    stiffness = model.spring_params[:, STIFFNESS].copy()
    stiffest = column(design.each_cable, "stiffness").max(initial=0.0)
    soft = YIELDING * np.minimum(stiffest, stall / np.maximum(pull, 1e-9))
    stiffness[model.driven] = np.minimum(stiffness[model.driven], soft)
    poses, angles, tensions = model.rest_poses.copy(), np.zeros(len(model.pin_bodies)), np.zeros(len(stiffness))
    _relax(model, first_columns(model), stiffness, pull, stall, new_out(model), poses, angles, tensions)
    return poses, angles, tensions


@kernel(**ALLOCATING)
def _relax(model, first, stiffness, pull, stall, out, poses, angles, tensions):
    """Move poses (b, 7) and angles (p,), and write the tensions (s,); stiffness (s,), pull (w,) [m], stall (w,) [N]."""
    size, driven = first[-1], model.first_driven
    force, velocity, inertia = np.empty(size), np.zeros(size), np.zeros(size)
    lengths = np.empty(len(tensions))
    for step in range(PULLING + RESTING):
        second_poses(model, angles, poses)
        spring_geometry(model, poses, angles, out, lengths)
        if step == 0:
            _add_inertia(model, first, stiffness, out, inertia)
        split_rod_inertia(model, poses, out)
        part = min(1.0, step / PULLING)
        for c in range(len(tensions)):
            d = c - driven
            wound = part * pull[d] if 0 <= d < len(pull) else 0.0
            tension = stiffness[c] * (lengths[c] - model.rest_lengths[c] + wound)
            if model.spring_params[c, TWO_WAY] == 0:
                tension = max(0.0, tension)
            tensions[c] = min(tension, stall[d]) if 0 <= d < len(pull) else tension
        generalised_forces(model, first, tensions, out, force)
        for i in range(size):
            if inertia[i] > 0:  # what no spring holds stays
                velocity[i] = KEPT * velocity[i] + force[i] / inertia[i]
        for b in range(len(poses)):
            at = first[b]
            if model.other_half[b] >= 0 and b > model.other_half[b]:
                continue  # a second half follows its first
            x, y, z = 0.5 * velocity[at + 3], 0.5 * velocity[at + 4], 0.5 * velocity[at + 5]
            a, e, c, w = poses[b, 3], poses[b, 4], poses[b, 5], poses[b, 6]
            poses[b, 3], poses[b, 4] = a + x * w + y * c - z * e, e + y * w + z * a - x * c
            poses[b, 5], poses[b, 6] = c + z * w + x * e - y * a, w - x * a - y * e - z * c
            norm = np.sqrt(poses[b, 3] ** 2 + poses[b, 4] ** 2 + poses[b, 5] ** 2 + poses[b, 6] ** 2)
            for i in range(3):
                poses[b, i] += velocity[at + i]
            for i in range(3, 7):
                poses[b, i] /= norm
        for p in range(len(angles)):
            angles[p] += velocity[first[model.pin_bodies[p, 0]] + 6]


@kernel(**ALLOCATING)
def _add_inertia(model, first, stiffness, out, inertia):
    """Write the masses (n,) that make steps of one stable: twice what holds each coordinate."""
    for c in range(len(stiffness)):
        for side in range(2):
            body = model.spring_bodies[c, side]
            at, arms = first[body], out.moment_arms[c, side]
            square = arms[0] ** 2 + arms[1] ** 2 + arms[2] ** 2
            reach = 0.0
            for i in range(3):
                reach += model.spring_params[c, 3 * side + i] ** 2
            pin = c >= len(stiffness) - len(model.pin_bodies)
            for i in range(3):
                inertia[at + i] += 0.0 if pin else 2 * stiffness[c]
                inertia[at + 3 + i] += 2 * stiffness[c] * (square if pin else 4 * reach)
            if model.other_half[body] >= 0:
                inertia[at + 6] += 2 * stiffness[c] * (square if pin else 4 * reach)
