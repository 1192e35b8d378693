"""A design flattened into the arrays of the kernel's model, and how stiff they are against a time step."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign

from .drives import DRIVE_FIELDS, drive_constants
from .geometry import spring_geometry
from .mobility import mobility_matrix
from .model import (
    DAMPING,
    INVERSE_AXIAL,
    INVERSE_MASS,
    INVERSE_TRANSVERSE,
    SPIN_DAMPING,
    STIFFNESS,
    Model,
    new_out,
)
from .split_rods import split_rod_inertia


def robot_model(design: RobotDesign) -> Model:
    """Flatten ``design`` at its standing structure."""
    structure, payload = design.standing, design.payload
    nodes, rods = structure.nodes, structure.rods
    split = design.flexible_rods.tolist()
    second = {rod: len(rods) + (payload is not None) + i for i, rod in enumerate(split)}
    middles = nodes[rods].mean(axis=1)
    centre = middles.mean(axis=0)

    count = len(rods) + (payload is not None) + len(split)
    poses, masses, inertias = np.zeros((count, 7)), np.zeros(count), np.zeros((count, 3))
    body_of_node = np.full(len(nodes), -1)
    joints, joint_points = [], []
    local_of_node = np.zeros((len(nodes), 3))
    pins, pin_params, springs = [], [], []
    for i, (a, b) in enumerate(rods):
        kind, length = design.rod(i), float(structure.rod_lengths[i])
        along = (nodes[b] - nodes[a]) / length
        if i not in second:
            poses[i] = [*middles[i], *_turn_of_z_onto(along)]
            masses[i] = kind.mass
            across = kind.transverse_inertia(length)
            inertias[i] = [across, across, kind.axial_inertia]
            for node, z in ((a, -length / 2), (b, length / 2)):
                if body_of_node[node] < 0:
                    body_of_node[node], local_of_node[node, 2] = i, z
                else:
                    joints.append([body_of_node[node], i])
                    joint_points.append([*local_of_node[node], 0, 0, z])
            continue
        assert design.flexure is not None
        axis = _pin_axis(along, middles[i] - centre, design.flexure.plane)
        turn = Rotation.from_matrix(np.column_stack([np.cross(axis, along), axis, along]))
        half, pin = kind.half(design.half_length(i)), design.rod_pins[i]
        place = design.half_length(i) + pin.fraction * design.flexure.length  # of the pin, from node a
        for body, node, sign in ((i, a, 1), (second[i], b, -1)):
            poses[body] = [*(nodes[node] + sign * half.centre * along), *turn.as_quat()]
            masses[body] = half.mass
            inertias[body] = [half.transverse_inertia, half.transverse_inertia, half.axial_inertia]
            body_of_node[node] = body
            local_of_node[node, 2] = -sign * half.centre
        pins.append([i, second[i]])
        pin_params.append([0, 0, place - half.centre, 0, 0, place - (length - half.centre), 0, 1, 0])
        springs.append([0] * 6 + [pin.stiffness, design.flexure.loss_time * pin.stiffness, 1])
    radii = np.array([max(kind.foot_radius, kind.tube_outer_radius) for kind in map(design.rod, range(len(rods)))])
    foot_radii = np.empty(len(nodes))
    foot_radii[rods] = radii[:, None]

    pairs = np.concatenate([structure.cables, structure.stiff_cables])
    rows = [(cable.stiffness, cable.damping, cable.two_way) for cable in design.each_cable]
    rows += [(cable.stiffness, cable.damping, False) for cable in design.each_stiff_cable]
    # tied on the line between the two nodes, so that the rest position balances as if tied to the axis
    lines = (nodes[pairs[:, 1]] - nodes[pairs[:, 0]]) / structure.lengths(pairs)[:, None]
    offset, turns = design.attachment_radius * lines, Rotation.from_quat(poses[body_of_node, 3:]).as_matrix()
    ties = [local_of_node[node] + np.einsum("cji,cj->ci", turns[node], own)
            for node, own in zip(pairs.T, (offset, -offset), strict=True)]  # fmt: skip
    ends, natural = [body_of_node[pairs]], [design.cable_natural_lengths, design.stiff_cable_lengths]
    params = [np.column_stack([*ties, np.reshape(rows, (-1, 3))])]
    if payload:
        row = len(rods)
        outward = (middles - centre) / np.linalg.norm(middles - centre, axis=1)[:, None]
        inner = np.zeros((row, 3))
        for (first, _), own in zip(pins, pin_params, strict=True):
            inner[first] = own[:3]
        ends.append(np.column_stack([np.arange(row), np.full(row, row)]))
        spring = [payload.stiffness, payload.damping, payload.two_way]
        params.append(np.column_stack([inner, payload.radius * outward, np.tile(spring, (row, 1))]))
        natural.append(np.full(row, design.payload_natural_length))
        poses[row] = [*centre, 0, 0, 0, 1]
        masses[row] = payload.mass
        inertias[row] = 0.4 * payload.mass * payload.radius**2
    if pins:
        ends.append(np.array(pins))
        params.append(np.array(springs, dtype=float))
        natural.append(np.zeros(len(pins)))

    body_params = np.zeros((count, 4))
    body_params[:, INVERSE_MASS] = 1 / masses
    body_params[:, INVERSE_TRANSVERSE] = 1 / inertias[:, 0]
    body_params[:, INVERSE_AXIAL] = 1 / inertias[:, 2]
    body_params[: len(rods), SPIN_DAMPING] = design.spin_damping
    other_half = np.full(count, -1)
    for first, last in pins:
        other_half[first], other_half[last] = last, first
        body_params[[first, last], SPIN_DAMPING] = design.spin_damping / 2
    return Model(
        spring_bodies=np.concatenate(ends),
        spring_params=np.concatenate(params),
        rest_lengths=np.concatenate(natural),
        first_driven=len(structure.cables),
        driven_count=len(structure.stiff_cables),
        drive_params=np.array([drive_constants(drive) for drive in design.each_drive]).reshape(-1, DRIVE_FIELDS),
        body_params=body_params,
        other_half=other_half,
        masses=masses,
        inertias=inertias,
        rest_poses=poses,
        pin_bodies=np.array(pins, dtype=np.int64).reshape(-1, 2),
        pin_params=np.array(pin_params, dtype=float).reshape(-1, 9),
        joint_bodies=(joined := np.array(joints, dtype=np.int64).reshape(-1, 2)),
        joint_points=np.array(joint_points, dtype=float).reshape(-1, 6),
        joint_first=np.array([np.isin(joined, pair).any(axis=1).argmax() for pair in joined], dtype=np.int64),
        joined=np.unique(joined),
        node_bodies=body_of_node,
        node_points=local_of_node,
        foot_radii=foot_radii,
    )


def _pin_axis(along: FloatArray, outward: FloatArray, plane: str) -> FloatArray:
    """Unit axis (3,) across a rod with the direction ``along``: the rod bends in the plane it names."""
    outward = outward - (outward @ along) * along
    if np.linalg.norm(outward) < 1e-9:  # a rod through the centre has no such plane: any will do
        outward = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    outward = outward / np.linalg.norm(outward)
    return np.cross(along, outward) if plane == "radial" else outward


def _turn_of_z_onto(axis: FloatArray) -> FloatArray:
    """The shortest rotation that takes the z axis onto a unit ``axis``, xyzw: a quaternion from two vectors."""
    x, y, z = axis
    turn = np.array([-y, x, 0, 1 + z] if z > -1 + 1e-12 else [1.0, 0, 0, 0])
    return turn / np.linalg.norm(turn)


def explicit_step_limit(model: Model) -> float:
    """Largest time step [s] at which explicit forces are stable about rest.

    With A = J M^-1 J^T, the stretched-cable modes obey x'' + A C x' + A K x = 0. Symplectic Euler with rates that are
    differenced in time, and so lag half a step, is stable while dt^2 lambda(A K) + 4 dt lambda(A C) < 4 holds for the
    largest eigenvalues; that is sufficient, so a little below the true limit.
    """
    if not len(model.spring_bodies):
        return np.inf
    mobility = mobility_at_rest(model)
    stiff = np.sqrt(model.spring_params[:, STIFFNESS])
    damp = np.sqrt(model.spring_params[:, DAMPING])
    k = np.linalg.eigvalsh(stiff[:, None] * mobility * stiff)[-1]
    c = np.linalg.eigvalsh(damp[:, None] * mobility * damp)[-1]
    return float((-2 * c + np.sqrt(4 * c * c + 4 * k)) / k)


def mobility_at_rest(model: Model) -> FloatArray:
    """A = J M^-1 J^T (s, s) of all spring rows, the standing robot [1/kg]."""
    out = new_out(model)
    spring_geometry(model, model.rest_poses, np.zeros(len(model.pin_bodies)), out, np.empty(len(model.spring_bodies)))
    split_rod_inertia(model, model.rest_poses, out)
    count = len(model.spring_bodies)
    out.rows[:] = np.arange(count)
    mobility_matrix(model, out, count)
    return out.mobility[:, :count]
