"""Free modes of a whole design: what the force law itself does about the standing robot.

Coordinates are those of the bodies: six of a whole one, seven of a split rod. Stiffness is the change of the
generalised forces, differenced about rest, so prestress, attachment radius, flexures and payload are in it; stiff
cables, slack at rest, are left out, and so is all damping. `modes.free_modes` is the closed form for plain rods.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.design import RobotDesign
from tensegym.physics.cable_law import explicit_tensions, tension_wrenches
from tensegym.physics.geometry import points_at, spring_geometry
from tensegym.physics.model import Model, Out, new_out
from tensegym.physics.robot_arrays import robot_model
from tensegym.physics.split_rods import add_generalised, second_poses, split_rod_inertia
from tensegym.structure.modes import Modes

STEP = 1e-5  # m and rad, of the differences: their error is of its square


def design_modes(design: RobotDesign) -> Modes:
    """Modes of a design in free flight, the six rigid motions left out; shapes are displacements of the nodes.

    Frequencies of motions that nothing holds, such as the spin of rods whose cables end on the axis, are 0. An unstable
    motion shows as NaN.
    """
    model = robot_model(design)
    out = new_out(model)
    first = _columns(model)
    size = int(first[-1])
    mass, stiffness = np.zeros((size, size)), np.empty((size, size))
    points = np.empty((size, len(model.node_bodies), 3))
    for body, column in enumerate(first[:-1]):
        if model.other_half[body] < 0:
            turn = Rotation.from_quat(model.rest_poses[body, 3:]).as_matrix()
            mass[column : column + 3, column : column + 3] = model.masses[body] * np.eye(3)
            mass[column + 3 : column + 6, column + 3 : column + 6] = (turn * model.inertias[body]) @ turn.T
    split_rod_inertia(model, model.rest_poses, out)
    for (body, _), own in zip(model.pin_bodies, out.pin_mass, strict=True):
        mass[first[body] : first[body] + 7, first[body] : first[body] + 7] = own
    for column in range(size):
        sides = []
        for sign in (-1, 1):
            q = np.zeros(size)
            q[column] = sign * STEP
            sides.append(_forces_and_nodes(model, out, first, q))
        stiffness[:, column] = -(sides[1][0] - sides[0][0]) / (2 * STEP)
        points[column] = (sides[1][1] - sides[0][1]) / (2 * STEP)
    values, vectors = eigh((stiffness + stiffness.T) / 2, mass)
    order = np.argsort(np.abs(values))
    rest = np.sort(order[6:])
    with np.errstate(invalid="ignore"):
        zero = np.abs(values[rest]) < 1e-6 * values[-1]
        frequencies = np.where(zero, 0.0, np.sqrt(values[rest])) / (2 * np.pi)
    return Modes(frequencies, np.einsum("cni,ck->kni", points, vectors[:, rest]))


def _columns(model: Model) -> IntArray:
    """(b + 1,) first coordinate of every body, and their count; a second half has its first half's."""
    sizes = np.where(model.other_half < 0, 6, 7)
    sizes[model.pin_bodies[:, 1]] = 0
    return np.concatenate([[0], np.cumsum(sizes)])


def _forces_and_nodes(model: Model, out: Out, first: IntArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Generalised forces and node positions at coordinates q from rest."""
    poses, pins = model.rest_poses.copy(), model.pin_bodies
    seconds = set(pins[:, 1].tolist())
    for body in range(len(poses)):
        if body not in seconds:
            own = q[first[body] :]
            poses[body, :3] += own[:3]
            poses[body, 3:] = (Rotation.from_rotvec(own[3:6]) * Rotation.from_quat(poses[body, 3:])).as_quat()
    angles = q[first[pins[:, 0]] + 6] if len(pins) else np.zeros(0)
    second_poses(model, angles, poses)
    lengths, tensions = np.empty((2, len(model.spring_bodies)))
    spring_geometry(model, poses, angles, out, lengths)
    explicit_tensions(model.spring_params, lengths, np.zeros_like(lengths), model.rest_lengths, tensions)
    tensions[model.driven] = 0.0
    tension_wrenches(model.spring_bodies, out, tensions)
    split_rod_inertia(model, poses, out)
    forces = np.zeros(len(q))
    for body, column in enumerate(first[:-1]):
        if model.other_half[body] < 0:
            forces[column : column + 6] = out.wrenches[body]
    for (one, two), geometry in zip(pins, out.pin_geometry, strict=True):
        own = forces[first[one] : first[one] + 7]
        for second, wrench in enumerate((out.wrenches[one], out.wrenches[two])):
            add_generalised(geometry, second == 1, wrench[:3], wrench[3:], own)
    return forces, points_at(poses, model.node_bodies, model.node_points)
