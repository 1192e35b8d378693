"""Ball joints linearised: which motions they leave, their forces at rest, and what these stiffen."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import null_space
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray

from .model import Model
from .tangent import Tangent, first_columns


class JointTangent(NamedTuple):
    """Over the coordinates (n,) of a tangent."""

    free: FloatArray
    """(n, m) orthonormal motions that keep all joints together."""
    geometric: FloatArray
    """(n, n) stiffness of the joints' forces, which turn no rod but push on what turns."""
    forces: FloatArray
    """(j, 3) on the first rod of each joint [N]."""


def joint_tangent(model: Model, at: Tangent, poses: FloatArray, tensions: FloatArray) -> JointTangent:
    """Of the joints where tensions (s,) and they are in balance, at poses (b, 7)."""
    first, size, count = first_columns(model), len(at.mass), len(model.joint_bodies)
    turns = Rotation.from_quat(poses[:, 3:]).as_matrix()
    apart = np.zeros((count, 3, size))
    arms = np.zeros((count, 2, 3))
    for j, bodies in enumerate(model.joint_bodies):
        for side, (body, sign) in enumerate(zip(bodies, (-1.0, 1.0), strict=True)):
            arms[j, side] = turns[body] @ model.joint_points[j, 3 * side : 3 * side + 3]
            column = first[body]
            apart[j, :, column : column + 3] += sign * np.eye(3)
            apart[j, :, column + 3 : column + 6] += sign * np.cross(np.eye(3), arms[j, side]).T
    rows = apart.reshape(3 * count, size)
    forces = np.linalg.lstsq(rows.T, -at.rates.T @ tensions, rcond=None)[0].reshape(count, 3)
    geometric = np.zeros((size, size))
    for j, bodies in enumerate(model.joint_bodies):
        for side, (body, sign) in enumerate(zip(bodies, (1.0, -1.0), strict=True)):
            force, arm, turn = sign * forces[j], arms[j, side], slice(first[body] + 3, first[body] + 6)
            # a force f at an end r of what turns by w: -(f . w)(r . w) / 2 + (f . r) w^2 / 2, as in design.shape
            geometric[turn, turn] += (force @ arm) * np.eye(3) - (np.outer(force, arm) + np.outer(arm, force)) / 2
    free = np.asarray(null_space(rows) if count else np.eye(size), dtype=float)
    return JointTangent(free, geometric, np.asarray(forces, dtype=float))
