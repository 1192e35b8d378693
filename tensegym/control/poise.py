"""Statics of a step: for any depths of the drives, how far the centre of mass lies beyond an edge of the face below.

The robot comes to rest between its springs with the drives wound in (`tensegym.physics.pulled`), without weight and
contacts. A robot set down on a face then tips over an edge where the foot of its centre of mass lies beyond it, and
over no other one first. Where no depths do that for an edge, no slow pull makes that step.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.physics.geometry import points_at
from tensegym.physics.pulled import pulled_state
from tensegym.physics.robot_arrays import robot_model
from tensegym.structure.faces import Faces

_UNDER = 1e-3  # m: a node so far below the face's plane stands in its place


class Shapes(NamedTuple):
    """Robots at rest with their drives wound in."""

    parts: FloatArray
    """(k, w) of each drive's deepest pull."""
    nodes: FloatArray
    """(k, n, 3) [m]."""
    centres: FloatArray
    """(k, 3) centres of mass [m]."""


def shapes(design: RobotDesign, parts: Iterable[FloatArray]) -> Shapes:
    """Where depths (w,) each bring the robot."""
    model, tried = robot_model(design), np.array(list(parts))
    poses = [pulled_state(design, model, part)[0] for part in tried]
    nodes = np.array([points_at(pose, model.node_bodies, model.node_points) for pose in poses])
    centres = np.array([model.masses @ pose[:, :3] / model.masses.sum() for pose in poses])
    return Shapes(tried, nodes, centres)


def beyond(at: Shapes, faces: Faces, face: int) -> FloatArray:
    """(3, k) how far the centre of mass lies beyond each edge of a face, node i to i + 1, and inside the other two [m].

    The lesser of both: positive where the robot tips over that edge alone; -inf where another node has come below.
    """
    triangle = faces.triangles[face]
    corners = at.nodes[:, triangle]
    sides = np.roll(corners, -1, axis=1) - corners
    normal = _unit(np.cross(sides[:, 0], sides[:, 1]))
    outward = _unit(np.cross(sides, normal[:, None]))  # counter-clockwise from outside
    past = ((at.centres[:, None] - corners) * outward).sum(axis=2).T
    heights = -((at.nodes - corners[:, :1]) * normal[:, None]).sum(axis=2)
    stands = np.delete(heights, triangle, axis=1).min(axis=1) > -_UNDER
    alone = [np.minimum(past[edge], -np.delete(past, edge, axis=0).max(axis=0)) for edge in range(3)]
    return np.where(stands, np.array(alone), -np.inf)


def _unit(vectors: FloatArray) -> FloatArray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
