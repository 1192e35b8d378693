"""Statics of steps: a robot at rest in closed form, and what its symmetry says of depths."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tensegym.control.hold import Hold, turned
from tensegym.control.poise import beyond, shapes
from tensegym.design.design import RobotDesign
from tensegym.structure.faces import face_by_nodes, hull_faces, tip_geometry

DESIGN = RobotDesign()
FACES = hull_faces(DESIGN.standing)


def test_at_rest_the_centre_of_mass_is_inside_every_face():
    """Below the 3-fold axis the face is an equilateral triangle and the centre over its middle."""
    rest = shapes(DESIGN, [np.zeros(6)])
    for face in range(len(FACES.triangles)):
        assert beyond(rest, FACES, face).max() < 0
    face = face_by_nodes(FACES, "3-5-12")
    a, b, _ = DESIGN.standing.nodes[FACES.triangles[face]]
    np.testing.assert_allclose(beyond(rest, FACES, face), -np.linalg.norm(b - a) / (2 * math.sqrt(3)), rtol=1e-4)


def test_a_slow_tip_goes_as_far_as_the_geometry_of_rigid_bodies_has_it():
    """Undeformed, the two distances to the common edge add up to the travel of a rigid tip."""
    rest = shapes(DESIGN, [np.zeros(6)])
    face, nodes = face_by_nodes(FACES, "3-5-12"), rest.nodes[0]
    for edge, to in enumerate(FACES.neighbours[face]):
        back = int(np.flatnonzero(FACES.neighbours[to] == face)[0])
        travel = tip_geometry(FACES, nodes, rest.centres[0], face, int(to)).travel
        one = -beyond(rest, FACES, face)[edge, 0]
        corners = nodes[FACES.triangles[to]]
        side = np.roll(corners, -1, axis=0)[back] - corners[back]
        arm = rest.centres[0] - corners[back]
        normal = FACES.normals[to]
        other = abs(float(arm @ np.cross(side, normal))) / np.linalg.norm(side)
        assert one + other == pytest.approx(travel, rel=1e-3)


def test_symmetry_turns_depths_with_the_faces():
    parts = (0.2, 0.9, 0.0, 0.6, 1.0, 0.4)
    images = turned([Hold(face_by_nodes(FACES, "1-3-6"), parts)], DESIGN, FACES)
    found = [np.sort(beyond(shapes(DESIGN, [np.array(image.parts)]), FACES, image.from_face)[:, 0]) for image in images]
    assert len(found) == 3
    for other in found[1:]:
        np.testing.assert_allclose(other, found[0], atol=1e-6)
