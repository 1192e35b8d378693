"""Readings of a robot's state as functions of its arrays: velocities, nodes, momentum, energy; and totals by name.

Poses (b, 7) are position and xyzw, velocities (b, 6) linear and angular.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray

from .cable_geometry import cable_geometry, points_in_world, rotation_matrix
from .cable_law import STIFFNESS, TWO_WAY
from .rod_rotation import angular_velocity, step_back


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
class Account:
    """What has added up since the last reset. Lengths are horizontal [m], energies [J].

    foot_path is the mean over the grounded feet of the path of their centres, foot_path_sum the sum over them.
    """

    drive_work: float
    electrical_energy: float
    centre_path: float
    foot_path: float
    foot_path_sum: float


@njit(cache=True)
def velocities_between(last_poses, poses, dt):
    """(b, 6) linear and angular velocities that took ``last_poses`` (b, 7) to ``poses`` in dt [s]."""
    out = np.empty((len(poses), 6))
    for b in range(len(poses)):
        for i in range(3):
            out[b, i] = (poses[b, i] - last_poses[b, i]) / dt
        out[b, 3:] = angular_velocity(poses[b], last_poses[b], dt)
    return out


@njit(cache=True)
def nodes_in_world(poses, velocities, feet, foot_points):
    """Positions (n, 3) [m] and velocities (n, 3) [m/s] of points fixed in bodies ``feet`` (n,) at ``foot_points``."""
    positions, speeds = np.empty((len(feet), 3)), np.empty((len(feet), 3))
    points_in_world(poses, feet, foot_points, positions)
    for p in range(len(feet)):
        body = feet[p]
        r0 = positions[p, 0] - poses[body, 0]
        r1 = positions[p, 1] - poses[body, 1]
        r2 = positions[p, 2] - poses[body, 2]
        v = velocities[body]
        speeds[p, 0] = v[0] + v[4] * r2 - v[5] * r1
        speeds[p, 1] = v[1] + v[5] * r0 - v[3] * r2
        speeds[p, 2] = v[2] + v[3] * r1 - v[4] * r0
    return positions, speeds


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


@njit(cache=True)
def mechanical_energy(poses, velocities, masses, inertias, gravity, ends, cables, natural):
    """Kinetic, gravity (zero at z = 0) and elastic energy [J]."""
    kinetic, potential, elastic = 0.0, 0.0, 0.0
    rotation = np.empty((3, 3))
    for b in range(len(poses)):
        rotation_matrix(poses[b, 3:], rotation)
        v = velocities[b]
        kinetic += 0.5 * masses[b] * (v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
        for i in range(3):
            spin = rotation[0, i] * v[3] + rotation[1, i] * v[4] + rotation[2, i] * v[5]
            kinetic += 0.5 * inertias[b, i] * spin * spin
        potential += masses[b] * gravity * poses[b, 2]
    count = len(ends)
    turns, directions, lengths = np.empty((count, 2, 3)), np.empty((count, 3)), np.empty(count)
    cable_geometry(poses, ends, cables, turns, directions, lengths)
    for c in range(count):
        stretch = lengths[c] - natural[c]
        if stretch > 0 or cables[c, TWO_WAY] == 1:
            elastic += 0.5 * cables[c, STIFFNESS] * stretch * stretch
    return kinetic, potential, elastic
