"""CableArrays: a design flattened into the arrays the force kernel reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.design import RobotDesign

from . import cable_law as law
from . import rod_rotation as rotation
from .cable_geometry import cable_geometry, flexure_geometry
from .mobility import mobility_matrix
from .split_rods import PinArrays


@dataclass(frozen=True)
class CableArrays:
    """Bodies are the rods in their order, then the payload, then the second halves of split rods, whose first halves
    stand in the rods' rows; cables the elastic, the stiff, the payload's, then a row for each flexure.

    ends (c, 2) bodies; params (c, 9) rows of the kernel's cable parameters; natural (c,) at rest [m], [rad] for
    flexures; bodies (b, 4) rows of the kernel's body parameters; rest_poses (b, 7); masses (b,) [kg]; inertias (b, 3)
    principal [kg m^2]; feet (n,) body of each node; foot_points (n, 3) in the body's frame [m]; foot_radii (n,) [m];
    first_driven the row of the first stiff cable, driven how many there are.
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
    driven: int
    pins: PinArrays

    @property
    def first_flexure(self) -> int:
        """Row of the first flexure among the cables; how many true cables there are."""
        return len(self.ends) - len(self.pins.bodies)


def cable_arrays(design: RobotDesign) -> CableArrays:
    """Flatten ``design`` at its standing structure."""
    structure, payload = design.standing, design.payload
    nodes, rods = structure.nodes, structure.rods
    split = design.flexible_rods.tolist()
    second = {rod: len(rods) + (payload is not None) + i for i, rod in enumerate(split)}
    middles = nodes[rods].mean(axis=1)
    centre = middles.mean(axis=0)

    count = len(rods) + (payload is not None) + len(split)
    poses, masses, inertias = np.zeros((count, 7)), np.zeros(count), np.zeros((count, 3))
    body_of_node = np.empty(len(nodes), dtype=np.int64)
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
            body_of_node[[a, b]] = i
            local_of_node[a, 2], local_of_node[b, 2] = -length / 2, length / 2
            continue
        assert design.flexure is not None
        axis = _pin_axis(along, middles[i] - centre, design.flexure.plane)
        turn = Rotation.from_matrix(np.column_stack([np.cross(axis, along), axis, along]))
        half, pin = kind.half(design.half_length(i)), design.rod_pin(i)
        place = design.half_length(i) + pin.place * design.flexure.length  # of the pin, from node a
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
    elastic, stiff = design.elastic_cable, design.stiff_cable
    rows = len(structure.cables) * [(elastic.stiffness, elastic.damping, elastic.two_way)]
    rows += len(structure.stiff_cables) * [(stiff.stiffness, stiff.damping, False)]
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

    bodies = np.zeros((count, 4))
    bodies[:, rotation.INVERSE_MASS] = 1 / masses
    bodies[:, rotation.INVERSE_TRANSVERSE] = 1 / inertias[:, 0]
    bodies[:, rotation.INVERSE_AXIAL] = 1 / inertias[:, 2]
    bodies[: len(rods), rotation.SPIN_DAMPING] = design.spin_damping
    partner = np.full(count, -1)
    for first, last in pins:
        partner[first], partner[last] = last, first
        bodies[[first, last], rotation.SPIN_DAMPING] = design.spin_damping / 2
    return CableArrays(
        ends=np.concatenate(ends),
        params=np.concatenate(params),
        natural=np.concatenate(natural),
        bodies=bodies,
        rest_poses=poses,
        masses=masses,
        inertias=inertias,
        feet=body_of_node,
        foot_points=local_of_node,
        foot_radii=foot_radii,
        first_driven=len(structure.cables),
        driven=len(structure.stiff_cables),
        pins=PinArrays(
            np.array(pins, dtype=np.int64).reshape(-1, 2), np.array(pin_params, dtype=float).reshape(-1, 9), partner
        ),
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


def explicit_step_limit(arrays: CableArrays) -> float:
    """Largest time step [s] at which explicit forces are stable about rest.

    With A = J M^-1 J^T, the stretched-cable modes obey x'' + A C x' + A K x = 0. Symplectic Euler with rates that are
    differenced in time, and so lag half a step, is stable while dt^2 lambda(A K) + 4 dt lambda(A C) < 4 holds for the
    largest eigenvalues; that is sufficient, so a little below the true limit.
    """
    count = len(arrays.ends)
    if not count:
        return np.inf
    mobility = mobility_at_rest(arrays)
    stiff = np.sqrt(arrays.params[:, law.STIFFNESS])
    damp = np.sqrt(arrays.params[:, law.DAMPING])
    k = np.linalg.eigvalsh(stiff[:, None] * mobility * stiff)[-1]
    c = np.linalg.eigvalsh(damp[:, None] * mobility * damp)[-1]
    return float((-2 * c + np.sqrt(4 * c * c + 4 * k)) / k)


def mobility_at_rest(arrays: CableArrays) -> FloatArray:
    """A = J M^-1 J^T (c, c) of all rows, the standing robot."""
    count, flexures = len(arrays.ends), arrays.first_flexure
    turns, directions, lengths = np.empty((count, 2, 3)), np.empty((count, 3)), np.empty(count)
    poses, pins = arrays.rest_poses, arrays.pins
    cable_geometry(poses, arrays.ends[:flexures], arrays.params, turns, directions, lengths)
    angles = np.zeros(len(pins.bodies))
    flexure_geometry(poses, pins.bodies, pins.params, angles, flexures, turns, directions, lengths)
    mobility = np.empty((count, count))
    mobility_matrix(poses, arrays.ends, arrays.bodies, pins.partner, pins.bodies, pins.params, turns, directions,
                           mobility)  # fmt: skip
    return mobility
