"""Model, State and Out: the arrays of a substep. What never changes, what a step updates, what it only writes.

Rows of per-body arrays (b) are the rods in their order, then the payload, then the second halves of split rods, whose
first halves stand in the rods' rows. Spring rows (s) are the elastic cables, the stiff cables, the payload's cables,
then a row for each flexure: a torsion spring whose length is the angle of its pin [rad] and whose tension is its moment
[N m]. Pins (p) are those of the split rods, nodes (n) the ends of the rods, each with a foot; drives (w) wind the stiff
cables.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray, IntArray

from .drives import STATE_SIZE

# Kernels take these numbers, so this file is counted among their sources (tensegym.compiled)
# Columns of a spring's parameters
END_A, END_B, STIFFNESS, DAMPING, TWO_WAY = slice(0, 3), slice(3, 6), 6, 7, 8
# Columns of a body's parameters; every body is symmetric about its z axis
INVERSE_MASS, INVERSE_TRANSVERSE, INVERSE_AXIAL, SPIN_DAMPING = range(4)
# Columns of a pin's parameters: the pin in the frames of the first and the second half, its axis in either
PIN_IN_FIRST, PIN_IN_SECOND, PIN_AXIS = slice(0, 3), slice(3, 6), slice(6, 9)
# Entries of the totals
DRIVE_WORK, ELECTRICAL_ENERGY, CENTRE_PATH, FOOT_PATH, FOOT_PATH_SUM, PEAK_TENSION = range(6)
BLOCK = 8  # columns that a processor takes together; whole blocks leave no remainder to take one by one
# Rows of a pin's geometry
FIRST_TO_PIN, SECOND_TO_PIN, AXIS_IN_WORLD, FIRST_Z, SECOND_Z, SECOND_PER_RATE = range(6)


class Model(NamedTuple):
    """A robot as flat arrays."""

    spring_bodies: IntArray
    """(s, 2) body at end a and at end b; of a flexure the first and the second half."""
    spring_params: FloatArray
    """(s, 9) columns END_A..TWO_WAY: ends in their bodies' frames [m], stiffness [N/m], damping [N s/m], and 1 where
    the spring pushes too; of flexures [N m/rad], [N m s/rad]."""
    rest_lengths: FloatArray
    """(s,) natural lengths before any drive winds [m], [rad]."""
    first_driven: int
    """Spring row of the first stiff cable."""
    driven_count: int
    """How many stiff cables there are, each with a drive."""
    drive_params: FloatArray
    """(w, 13) fields of design.Drive in their order, a row a drive, SI units."""
    body_params: FloatArray
    """(b, 4) columns INVERSE_MASS [1/kg], INVERSE_TRANSVERSE, INVERSE_AXIAL [1/(kg m^2)], SPIN_DAMPING [N m s/rad]."""
    other_half: IntArray
    """(b,) body of a split rod's other half, -1 of a whole body."""
    masses: FloatArray
    """(b,) [kg]."""
    inertias: FloatArray
    """(b, 3) principal moments [kg m^2]."""
    rest_poses: FloatArray
    """(b, 7) pose of the standing robot, as in State."""
    pin_bodies: IntArray
    """(p, 2) first and second half."""
    pin_params: FloatArray
    """(p, 9) columns PIN_IN_FIRST, PIN_IN_SECOND [m], PIN_AXIS."""
    joint_bodies: IntArray
    """(j, 2) rods that a ball joint joins: that of a shared node, another one."""
    joint_points: FloatArray
    """(j, 6) the joint in the frame of the first and the second of them [m]."""
    joint_first: IntArray
    """(j,) the first joint, up to each itself, that has a rod with it in common."""
    joined: IntArray
    """(k,) bodies with a joint or more."""
    node_bodies: IntArray
    """(n,) body of each node, of those that share it the first."""
    node_points: FloatArray
    """(n, 3) each node in its body's frame [m]."""
    foot_radii: FloatArray
    """(n,) of the balls on the nodes [m]."""

    @property
    def first_flexure(self) -> int:
        """Spring row of the first flexure; how many cables there are."""
        return len(self.spring_bodies) - len(self.pin_bodies)

    @property
    def driven(self) -> slice:
        """Spring rows of the stiff cables."""
        return slice(self.first_driven, self.first_driven + self.driven_count)


class State(NamedTuple):
    """What a substep reads and updates; the poses of whole bodies and first halves, and the angles, are the engine's.

    Poses are the position [m] of the centre of mass in the world and the quaternion xyzw, body to world.
    """

    poses: FloatArray
    """(b, 7), the second halves' written by the substep."""
    angles: FloatArray
    """(p,) of the pins [rad]."""
    last_poses: FloatArray
    """(b, 7) a substep ago."""
    lengths: FloatArray
    """(s,) [m], [rad]."""
    rates: FloatArray
    """(s,) length now less that a substep ago, over the step [m/s], [rad/s]."""
    tensions: FloatArray
    """(s,) [N], [N m]."""
    natural: FloatArray
    """(s,) natural lengths, the stiff cables' shortened by what is wound in [m], [rad]."""
    drives: FloatArray
    """(w, 8) columns named in drives.py."""
    node_positions: FloatArray
    """(n, 3) in the world, at the poses [m]."""
    totals: FloatArray
    """(6,) since the last reset, entries DRIVE_WORK..PEAK_TENSION, see readings.Totals."""


class Out(NamedTuple):
    """What a substep writes and does not read from the one before: its result and, after it, its workspace."""

    wrenches: FloatArray
    """(b, 6) force [N] and moment about the centre [N m], world axes."""
    velocities: FloatArray
    """(b, 6) linear [m/s] and angular [rad/s], over the last step."""
    rotations: FloatArray
    """(b, 3, 3) rotation matrices, body to world."""
    directions: FloatArray
    """(s, 3) unit vectors from end a to end b in the world; 0 of flexures."""
    moment_arms: FloatArray
    """(s, 2, 3) what a unit length's rate takes from each end's angular velocity, world axes [m]; see geometry.py."""
    pin_geometry: FloatArray
    """(p, 6, 3) rows FIRST_TO_PIN..SECOND_PER_RATE, see split_rods.py."""
    pin_mass: FloatArray
    """(p, 7, 7) mass matrix of a split rod."""
    pin_inverse: FloatArray
    """(p, 7, 7) its inverse."""
    pin_work: FloatArray
    """(2, 7, 7) workspace of the inversion."""
    rows: IntArray
    """(s,) spring rows of an implicit solve, the slack ones left out; of what follows a column for each, padded to
    whole blocks."""
    response: FloatArray
    """(b, 6, k) accelerations of the bodies by a unit tension in each of them."""
    mobility: FloatArray
    """(s, k) rates of their lengths by them, J M^-1 J^T [1/kg], see mobility.py."""
    solve: FloatArray
    """(4, k) workspace of the implicit solve, see cable_law.py."""
    last_tensions: FloatArray
    """(w,) of the stiff cables, a substep ago [N]."""
    new_positions: FloatArray
    """(n, 3) of the nodes [m]."""
    joint_forces: FloatArray
    """(j, 3) on the first rod of each joint, against the second [N]."""
    joint_arms: FloatArray
    """(j, 4, 3) from both rods' centres to their ends, then to the middle between those [m]."""
    joint_motion: FloatArray
    """(b, 6) velocities that the step ends with."""
    joint_apart: FloatArray
    """(3 j,) how far apart it leaves the ends [m]."""
    joint_matrix: FloatArray
    """(3 j, 3 j) factor of the joints' mobility."""


def new_state(model: Model, poses: FloatArray, angles: FloatArray) -> State:
    """State at the engine's poses (b, 7) and pin angles (p,), which it shares; all else zero."""
    springs, nodes = len(model.spring_bodies), len(model.node_bodies)
    lengths, rates, tensions, natural = np.zeros((4, springs))
    return State(
        poses=poses,
        angles=angles,
        last_poses=np.zeros_like(poses),
        lengths=lengths,
        rates=rates,
        tensions=tensions,
        natural=natural,
        drives=np.zeros((model.driven_count, STATE_SIZE)),
        node_positions=np.zeros((nodes, 3)),
        totals=np.zeros(6),
    )


def new_out(model: Model) -> Out:
    """Room for a substep's results."""
    bodies, springs, pins = len(model.masses), len(model.spring_bodies), len(model.pin_bodies)
    padded, joints = BLOCK * -(-springs // BLOCK), len(model.joint_bodies)
    return Out(
        wrenches=np.zeros((bodies, 6)),
        velocities=np.zeros((bodies, 6)),
        rotations=np.zeros((bodies, 3, 3)),
        directions=np.zeros((springs, 3)),
        moment_arms=np.zeros((springs, 2, 3)),
        pin_geometry=np.zeros((pins, 6, 3)),
        pin_mass=np.zeros((pins, 7, 7)),
        pin_inverse=np.zeros((pins, 7, 7)),
        pin_work=np.zeros((2, 7, 7)),
        rows=np.zeros(springs, dtype=np.int64),
        response=np.zeros((bodies, 6, padded)),
        mobility=np.zeros((springs, padded)),
        solve=np.zeros((4, padded)),
        last_tensions=np.zeros(model.driven_count),
        new_positions=np.zeros((len(model.node_bodies), 3)),
        joint_forces=np.zeros((joints, 3)),
        joint_arms=np.zeros((joints, 4, 3)),
        joint_motion=np.zeros((bodies, 6)),
        joint_apart=np.zeros(3 * joints),
        joint_matrix=np.zeros((3 * joints, 3 * joints)),
    )
