"""Readings of a robot's state as functions of its arrays: velocities, nodes, momentum, energy; and totals by name.

Poses (b, 7) are position and xyzw, velocities (b, 6) linear and angular.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.compiled import kernel

from .geometry import points_at, rotations_of, span
from .model import STIFFNESS, TWO_WAY
from .vectors import ALLOCATING, angular_velocity


@dataclass(frozen=True)
class Energies:
    """Mechanical energy of the robot [J]; gravity's is zero with every body centre at z = 0."""

    kinetic: float
    gravity: float
    elastic: float

    @property
    def total(self) -> float:
        return self.kinetic + self.gravity + self.elastic


@dataclass(frozen=True)
class Totals:
    """What has added up since the last reset. Lengths are horizontal [m], energies [J].

    foot_path is the mean over the grounded feet of the path of their centres, foot_path_sum the sum over them.
    peak_tension is the most that any cable has borne [N], since a GaitMeter began where one did.
    """

    drive_work: float
    electrical_energy: float
    centre_path: float
    foot_path: float
    foot_path_sum: float
    peak_tension: float


@kernel(**ALLOCATING)
def velocities_between(last_poses, poses, dt):
    """(b, 6) linear and angular velocities that took ``last_poses`` (b, 7) to ``poses`` in dt [s]."""
    out = np.empty((len(poses), 6))
    for b in range(len(poses)):
        for i in range(3):
            out[b, i] = (poses[b, i] - last_poses[b, i]) / dt
        out[b, 3:] = angular_velocity(poses[b], last_poses[b], dt)
    return out


@kernel(**ALLOCATING)
def nodes_in_world(poses, velocities, bodies, points):
    """Positions (n, 3) [m] and velocities (n, 3) [m/s] of the nodes at ``points`` (n, 3) [m] in ``bodies`` (n,)."""
    positions, speeds = points_at(poses, bodies, points), np.empty((len(bodies), 3))
    for p in range(len(positions)):
        body = bodies[p]
        r0 = positions[p, 0] - poses[body, 0]
        r1 = positions[p, 1] - poses[body, 1]
        r2 = positions[p, 2] - poses[body, 2]
        v = velocities[body]
        speeds[p, 0] = v[0] + v[4] * r2 - v[5] * r1
        speeds[p, 1] = v[1] + v[5] * r0 - v[3] * r2
        speeds[p, 2] = v[2] + v[3] * r1 - v[4] * r0
    return positions, speeds


def step_back(poses: FloatArray, velocities: FloatArray, dt: float) -> None:
    """Move poses (b, 7) back along velocities (b, 6) by ``dt`` [s], in place."""
    poses[:, :3] -= dt * velocities[:, :3]
    back = Rotation.from_rotvec(-dt * velocities[:, 3:]) * Rotation.from_quat(poses[:, 3:])
    poses[:, 3:] = back.as_quat()


def momentum(
    poses: FloatArray, velocities: FloatArray, masses: FloatArray, inertias: FloatArray, dt: float
) -> tuple[FloatArray, FloatArray]:
    """Linear [kg m/s] and angular [kg m^2/s] about the world origin, each (3,), of bodies with principal ``inertias``
    (b, 3): half a step of ``dt`` [s] ago, where the velocities live."""
    linear = masses[:, None] * velocities[:, :3]
    middle = poses.copy()
    step_back(middle, velocities, dt / 2)
    turns = Rotation.from_quat(middle[:, 3:])
    spin = turns.apply(inertias * turns.inv().apply(velocities[:, 3:]))
    return linear.sum(axis=0), (np.cross(poses[:, :3], linear) + spin).sum(axis=0)


@kernel(**ALLOCATING)
def mechanical_energy(poses, velocities, masses, inertias, gravity, ends, params, natural):
    """Kinetic, gravity (zero at z = 0) and the cables' elastic energy [J].

    masses (b,), inertias (b, 3), ends (c, 2), params (c, 9): the model's, the latter two of cables alone; natural (c,)
    their natural lengths [m]; gravity [m/s^2] downward.
    """
    kinetic, potential, elastic = 0.0, 0.0, 0.0
    rotations = np.empty((len(poses), 3, 3))
    rotations_of(poses, rotations)
    for b in range(len(poses)):
        v, rotation = velocities[b], rotations[b]
        kinetic += 0.5 * masses[b] * (v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
        for i in range(3):
            spin = rotation[0, i] * v[3] + rotation[1, i] * v[4] + rotation[2, i] * v[5]
            kinetic += 0.5 * inertias[b, i] * spin * spin
        potential += masses[b] * gravity * poses[b, 2]
    for c in range(len(ends)):
        x, y, z = span(poses, rotations, ends, params, c)[0]
        stretch = np.sqrt(x * x + y * y + z * z) - natural[c]
        if stretch > 0 or params[c, TWO_WAY] == 1:
            elastic += 0.5 * params[c, STIFFNESS] * stretch * stretch
    return kinetic, potential, elastic
