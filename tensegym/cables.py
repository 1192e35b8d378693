"""CableArrays: a design flattened into the arrays the force kernel reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from . import cable_forces as kernel
from . import rotation
from .design import RobotDesign
from .structure import FloatArray, IntArray


@dataclass(frozen=True)
class CableArrays:
    """Bodies are the rods in their order, then the payload; cables the elastic, the stiff, the payload's.

    ends (c, 2) bodies; params (c, 9) rows of the kernel's cable parameters; natural (c,) [m] at rest; bodies (b, 4)
    rows of the kernel's body parameters; rest_poses (b, 7); masses (b,) [kg]; inertias (b, 3) principal [kg m^2];
    feet (n,) body of each node; foot_points (n, 3) in the body's frame [m]; foot_radii (n,) [m]; first_driven the row
    of the first stiff cable.
    """

    ends: IntArray
    params: FloatArray
    natural: FloatArray
    bodies: FloatArray
    rest_poses: FloatArray
    masses: FloatArray
    inertias: FloatArray
    feet: IntArray
    foot_points: FloatArray
    foot_radii: FloatArray
    first_driven: int


def cable_arrays(design: RobotDesign) -> CableArrays:
    """Flatten ``design`` at its standing structure."""
    structure, payload = design.standing, design.payload
    nodes, rods = structure.nodes, structure.rods
    middles, axes = nodes[rods].mean(axis=1), nodes[rods[:, 1]] - nodes[rods[:, 0]]
    centre = middles.mean(axis=0)
    turns = [_turn_of_z_onto(axis) for axis in axes]
    poses = np.array([[*m, *t.as_quat()] for m, t in zip(middles, turns, strict=True)])
    masses = [design.rod(i).mass for i in range(len(rods))]
    inertias = []
    for i, length in enumerate(structure.rod_lengths):
        across = design.rod(i).transverse_inertia(float(length))
        inertias.append([across, across, design.rod(i).axial_inertia])

    body_of_node = np.empty(len(nodes), dtype=np.int64)
    local_of_node = np.zeros((len(nodes), 3))
    for i, (a, b) in enumerate(rods):
        body_of_node[[a, b]] = i
        local_of_node[a, 2], local_of_node[b, 2] = -structure.rod_lengths[i] / 2, structure.rod_lengths[i] / 2
    kinds = [design.rod(body) for body in body_of_node.tolist()]
    foot_radii = np.array([max(rod.foot_radius, rod.tube_outer_radius) for rod in kinds])

    ends, params, natural = [], [], []
    for pairs, cable, lengths in (
        (structure.cables, design.elastic_cable, design.cable_natural_lengths),
        (structure.stiff_cables, design.stiff_cable, design.stiff_cable_lengths),
    ):
        two_way = float(getattr(cable, "two_way", False))
        for (a, b), length in zip(pairs, lengths, strict=True):
            # tied on the line between the two nodes, so that the rest position balances as if tied to the axis
            along = (nodes[b] - nodes[a]) / np.linalg.norm(nodes[b] - nodes[a])
            body_a, body_b = body_of_node[a], body_of_node[b]
            local_a = local_of_node[a] + turns[body_a].inv().apply(design.attachment_radius * along)
            local_b = local_of_node[b] - turns[body_b].inv().apply(design.attachment_radius * along)
            ends.append([body_a, body_b])
            params.append([*local_a, *local_b, cable.stiffness, cable.damping, two_way])
            natural.append(length)
    if payload:
        for i, middle in enumerate(middles):
            outward = (middle - centre) / np.linalg.norm(middle - centre)
            ends.append([i, len(rods)])
            params.append([0, 0, 0, *payload.radius * outward, payload.stiffness, payload.damping, payload.two_way])
            natural.append(design.payload_natural_length)
        poses = np.vstack([poses, [*centre, 0, 0, 0, 1]])
        masses.append(payload.mass)
        inertias.append([0.4 * payload.mass * payload.radius**2] * 3)

    bodies = np.zeros((len(masses), 4))
    bodies[:, rotation.INVERSE_MASS] = 1 / np.array(masses)
    bodies[:, rotation.INVERSE_TRANSVERSE] = 1 / np.array(inertias)[:, 0]
    bodies[:, rotation.INVERSE_AXIAL] = 1 / np.array(inertias)[:, 2]
    bodies[: len(rods), rotation.SPIN_DAMPING] = design.spin_damping
    return CableArrays(
        ends=np.array(ends, dtype=np.int64).reshape(-1, 2),
        params=np.array(params, dtype=float).reshape(-1, 9),
        natural=np.array(natural, dtype=float),
        bodies=bodies,
        rest_poses=poses,
        masses=np.array(masses),
        inertias=np.array(inertias),
        feet=body_of_node,
        foot_points=local_of_node,
        foot_radii=foot_radii,
        first_driven=len(structure.cables),
    )


def _turn_of_z_onto(axis: FloatArray) -> Rotation:
    """The shortest rotation that takes the z axis onto ``axis``: a quaternion from two vectors."""
    x, y, z = axis / np.linalg.norm(axis)
    if z < -1 + 1e-12:
        return Rotation.from_quat([1, 0, 0, 0])
    return Rotation.from_quat([-y, x, 0, 1 + z])


def explicit_step_limit(arrays: CableArrays) -> float:
    """Largest time step [s] at which explicit forces are stable about rest.

    With A = J M^-1 J^T, the stretched-cable modes obey x'' + A C x' + A K x = 0. Symplectic Euler with rates that are
    differenced in time, and so lag half a step, is stable while dt^2 lambda(A K) + 4 dt lambda(A C) < 4 holds for the
    largest eigenvalues; that is sufficient, so a little below the true limit.
    """
    count = len(arrays.ends)
    if not count:
        return np.inf
    arms, directions, lengths = np.empty((count, 2, 3)), np.empty((count, 3)), np.empty(count)
    kernel.cable_geometry(arrays.rest_poses, arrays.ends, arrays.params, arms, directions, lengths)
    mobility = np.empty((count, count))
    kernel.mobility_matrix(arrays.rest_poses, arrays.ends, arrays.bodies, arms, directions, mobility)
    stiff = np.sqrt(arrays.params[:, kernel.STIFFNESS])
    damp = np.sqrt(arrays.params[:, kernel.DAMPING])
    k = np.linalg.eigvalsh(stiff[:, None] * mobility * stiff)[-1]
    c = np.linalg.eigvalsh(damp[:, None] * mobility * damp)[-1]
    return float((-2 * c + np.sqrt(4 * c * c + 4 * k)) / k)
