"""A robot's forces linearised about a state: mass, lengths' rates and what the tensions' turning stiffens, compiled.

Coordinates q are those of the bodies: displacement [m] and turn [rad], in world axes, of a whole one; of a split rod
those of its first half and the angle of its pin. Tensions T act with the generalised forces -J^T T, and

    d(J^T T)/dq = J^T (dT/dl) J + G,   G the geometric stiffness: T / l across a cable, and its pull on what turns.

(Guest 2006, "The stiffness of prestressed frameworks: a unifying approach".)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.compiled import kernel

from .cable_law import tension_wrenches
from .geometry import spring_geometry
from .model import INVERSE_MASS, SPIN_DAMPING, Model, new_out
from .split_rods import add_generalised, inertia_times, second_poses, split_rod_inertia
from .vectors import ALLOCATING, KERNEL

STEP = 1e-6  # m and rad, of the differences: their error is of its square


class Tangent(NamedTuple):
    """Matrices over the coordinates (n,) of a state."""

    mass: FloatArray
    """(n, n)."""
    rates: FloatArray
    """(s, n) J: rate of every spring's length by unit velocities."""
    geometric: FloatArray
    """(n, n) G, its symmetric part."""
    spin_damping: FloatArray
    """(n, n) of the rods about their axes."""


def first_columns(model: Model) -> IntArray:
    """(b + 1,) first coordinate of every body, and how many there are; a second half has its first half's."""
    sizes = np.where(model.other_half < 0, 6, 7)
    sizes[model.pin_bodies[:, 1]] = 0
    columns = np.concatenate([[0], np.cumsum(sizes)])
    columns[model.pin_bodies[:, 1]] = columns[model.pin_bodies[:, 0]]
    return columns


def tangent(model: Model, poses: FloatArray, angles: FloatArray, tensions: FloatArray) -> Tangent:
    """The matrices at poses (b, 7), pins' angles (p,) and tensions (s,)."""
    first, springs = first_columns(model), len(model.spring_bodies)
    size = int(first[-1])
    mass, rates = np.zeros((size, size)), np.zeros((springs, size))
    geometric, damping = np.zeros((size, size)), np.zeros((size, size))
    _fill(model, first, poses, angles, np.asarray(tensions, dtype=float), new_out(model), mass, rates, geometric,
          damping)  # fmt: skip
    return Tangent(mass, rates, (geometric + geometric.T) / 2, damping)


def moved(
    model: Model, poses: FloatArray, angles: FloatArray, column: int, by: float
) -> tuple[FloatArray, FloatArray]:
    """Poses (b, 7) and angles (p,) with one coordinate changed by ``by`` [m] or [rad]."""
    poses, angles = poses.copy(), angles.copy()
    _move(model, first_columns(model), column, by, poses, angles)
    second_poses(model, angles, poses)
    return poses, angles


@kernel(**ALLOCATING)
def _fill(model, first, poses, angles, tensions, out, mass, rates, geometric, damping):
    """Write a Tangent's matrices; first (b + 1,) as of `first_columns`."""
    size, bodies = len(mass), len(poses)
    pose, angle, force = np.empty((bodies, 7)), np.empty(len(angles)), np.empty((2, size))
    unit, lengths = np.zeros(len(tensions)), np.empty(len(tensions))
    for column in range(size):
        for side in range(2):
            pose[:], angle[:] = poses, angles
            _move(model, first, column, STEP if side else -STEP, pose, angle)
            second_poses(model, angle, pose)
            spring_geometry(model, pose, angle, out, lengths)
            split_rod_inertia(model, pose, out)
            generalised_forces(model, first, tensions, out, force[side])
        for row in range(size):
            geometric[row, column] = (force[0, row] - force[1, row]) / (2 * STEP)
    pose[:], angle[:] = poses, angles
    second_poses(model, angle, pose)
    spring_geometry(model, pose, angle, out, lengths)
    split_rod_inertia(model, pose, out)
    for c in range(len(tensions)):
        unit[c] = -1.0
        generalised_forces(model, first, unit, out, rates[c])
        unit[c] = 0.0
    for b in range(bodies):
        at, body = first[b], model.body_params[b]
        axis = out.rotations[b, 0, 2], out.rotations[b, 1, 2], out.rotations[b, 2, 2]
        for i in range(3):
            for j in range(3):
                damping[at + 3 + i, at + 3 + j] += body[SPIN_DAMPING] * axis[i] * axis[j]
        if model.other_half[b] < 0:
            for i in range(3):
                turned = inertia_times(body, axis, (1.0 * (i == 0), 1.0 * (i == 1), 1.0 * (i == 2)))
                mass[at + i, at + i] = 1 / body[INVERSE_MASS]
                for j in range(3):
                    mass[at + 3 + j, at + 3 + i] = turned[j]
    for p in range(len(model.pin_bodies)):
        at = first[model.pin_bodies[p, 0]]
        mass[at : at + 7, at : at + 7] = out.pin_mass[p]


@kernel(**KERNEL)
def _move(model, first, column, by, poses, angles):
    """Change coordinate ``column`` by ``by``, in the poses (b, 7) of whole bodies and first halves and angles (p,)."""
    for p in range(len(angles)):
        if first[model.pin_bodies[p, 0]] + 6 == column:
            angles[p] += by
    for b in range(len(poses)):
        i = column - first[b]
        if 0 <= i < 3:
            poses[b, i] += by
        elif 3 <= i < 6:
            s, w = np.sin(0.5 * by), np.cos(0.5 * by)
            x, y, z = s * (i == 3), s * (i == 4), s * (i == 5)
            a, b0, c, d = poses[b, 3], poses[b, 4], poses[b, 5], poses[b, 6]
            poses[b, 3], poses[b, 4] = w * a + x * d + y * c - z * b0, w * b0 + y * d + z * a - x * c
            poses[b, 5], poses[b, 6] = w * c + z * d + x * b0 - y * a, w * d - x * a - y * b0 - z * c


@kernel(**ALLOCATING)
def generalised_forces(model, first, tensions, out, force):
    """Write the generalised forces (n,) of tensions (s,) at the geometry in ``out``."""
    tension_wrenches(model.spring_bodies, out, tensions)
    force[:] = 0.0
    for b in range(len(out.wrenches)):
        if model.other_half[b] < 0:
            for i in range(6):
                force[first[b] + i] = out.wrenches[b, i]
    for p in range(len(model.pin_bodies)):
        at = first[model.pin_bodies[p, 0]]
        for side in range(2):
            wrench = out.wrenches[model.pin_bodies[p, side]]
            add_generalised(out.pin_geometry[p], side == 1, wrench[:3], wrench[3:], force[at : at + 7])
