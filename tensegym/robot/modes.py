"""Free modes of a whole design: what the force law itself does about the standing robot.

Coordinates are those of the bodies: six of a whole one, seven of a split rod (pins.py). Stiffness is the change of the
generalised forces, differenced about rest, so prestress, attachment radius, flexures and payload are in it; stiff
cables, slack at rest, are left out, and so is all damping. `modes.free_modes` is the closed form for plain rods.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.physics.cable_geometry import cable_geometry, flexure_geometry, points_in_world
from tensegym.physics.cable_law import explicit_tensions, wrenches_of
from tensegym.physics.robot_arrays import CableArrays, cable_arrays
from tensegym.physics.split_rods import add_generalised, pinned_inertia, second_poses
from tensegym.structure.modes import Modes

STEP = 1e-5  # m and rad, of the differences: their error is of its square


def design_modes(design: RobotDesign) -> Modes:
    """Modes of a design in free flight, the six rigid motions left out; shapes are displacements of the nodes.

    Frequencies of motions that nothing holds, such as the spin of rods whose cables end on the axis, are 0. An unstable
    motion shows as NaN.
    """
    arrays = cable_arrays(design)
    first = _columns(arrays)
    size = int(first[-1])
    mass, stiffness = np.zeros((size, size)), np.empty((size, size))
    points = np.empty((size, len(arrays.feet), 3))
    for body, column in enumerate(first[:-1]):
        if arrays.pins.partner[body] < 0:
            turn = Rotation.from_quat(arrays.rest_poses[body, 3:]).as_matrix()
            mass[column : column + 3, column : column + 3] = arrays.masses[body] * np.eye(3)
            mass[column + 3 : column + 6, column + 3 : column + 6] = (turn * arrays.inertias[body]) @ turn.T
    for pin, (body, _) in enumerate(arrays.pins.bodies):
        _, own = _pinned(arrays, arrays.rest_poses, pin)
        mass[first[body] : first[body] + 7, first[body] : first[body] + 7] = own
    for column in range(size):
        sides = []
        for sign in (-1, 1):
            q = np.zeros(size)
            q[column] = sign * STEP
            sides.append(_forces_and_nodes(arrays, first, q))
        stiffness[:, column] = -(sides[1][0] - sides[0][0]) / (2 * STEP)
        points[column] = (sides[1][1] - sides[0][1]) / (2 * STEP)
    values, vectors = eigh((stiffness + stiffness.T) / 2, mass)
    order = np.argsort(np.abs(values))
    rest = np.sort(order[6:])
    with np.errstate(invalid="ignore"):
        zero = np.abs(values[rest]) < 1e-6 * values[-1]
        frequencies = np.where(zero, 0.0, np.sqrt(values[rest])) / (2 * np.pi)
    return Modes(frequencies, np.einsum("cni,ck->kni", points, vectors[:, rest]))


def _columns(arrays: CableArrays) -> np.ndarray:
    """(b + 1,) first coordinate of every body, and their count; a second half has its first half's."""
    sizes = np.where(arrays.pins.partner < 0, 6, 7)
    sizes[arrays.pins.bodies[:, 1]] = 0
    return np.concatenate([[0], np.cumsum(sizes)])


def _pinned(arrays: CableArrays, poses: FloatArray, pin: int) -> tuple[FloatArray, FloatArray]:
    """Geometry and mass matrix of a split rod (pins.pinned_inertia)."""
    geometry, mass, inverse = np.empty((6, 3)), np.empty((7, 7)), np.empty((7, 7))
    pinned_inertia(poses, arrays.bodies, arrays.pins.bodies, arrays.pins.params, pin, geometry, mass, inverse)
    return geometry, mass


def _forces_and_nodes(arrays: CableArrays, first: np.ndarray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Generalised forces and node positions at coordinates q from rest."""
    poses, pins, flexures = arrays.rest_poses.copy(), arrays.pins, arrays.first_flexure
    seconds = set(pins.bodies[:, 1].tolist())
    for body in range(len(poses)):
        if body not in seconds:
            own = q[first[body] :]
            poses[body, :3] += own[:3]
            poses[body, 3:] = (Rotation.from_rotvec(own[3:6]) * Rotation.from_quat(poses[body, 3:])).as_quat()
    angles = q[first[pins.bodies[:, 0]] + 6] if len(pins.bodies) else np.zeros(0)
    second_poses(pins.bodies, pins.params, angles, poses)
    turns, directions = np.empty((len(arrays.ends), 2, 3)), np.empty((len(arrays.ends), 3))
    lengths, tensions = np.empty(len(arrays.ends)), np.empty(len(arrays.ends))
    cable_geometry(poses, arrays.ends[:flexures], arrays.params, turns, directions, lengths)
    flexure_geometry(poses, pins.bodies, pins.params, angles, flexures, turns, directions, lengths)
    explicit_tensions(arrays.params, lengths, np.zeros_like(lengths), arrays.natural, tensions)
    tensions[arrays.first_driven : arrays.first_driven + arrays.driven] = 0.0
    wrenches = np.zeros((len(poses), 6))
    wrenches_of(arrays.ends, turns, directions, tensions, wrenches)
    forces = np.zeros(len(q))
    for body, column in enumerate(first[:-1]):
        if pins.partner[body] < 0:
            forces[column : column + 6] = wrenches[body]
    for pin, (one, two) in enumerate(pins.bodies):
        geometry, _ = _pinned(arrays, poses, pin)
        own = forces[first[one] : first[one] + 7]
        add_generalised(geometry, False, wrenches[one, :3], wrenches[one, 3:], own)
        add_generalised(geometry, True, wrenches[two, :3], wrenches[two, 3:], own)
    nodes = np.empty((len(arrays.feet), 3))
    points_in_world(poses, arrays.feet, arrays.foot_points, nodes)
    return forces, nodes
