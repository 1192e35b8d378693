import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.errors import StructureError
from tensegym.structure.faces import face_by_nodes, hull_faces, resting_rotation, supporting_face
from tensegym.structure.structure import Structure, paper, six_rod

FACES = hull_faces(six_rod())


def test_twenty_triangles_close_the_hull():
    assert len(FACES.triangles) == 20
    assert FACES.closed.sum() == 8
    edges = {frozenset((int(t[i]), int(t[(i + 1) % 3]))) for t in FACES.triangles for i in range(3)}
    assert 12 - len(edges) + 20 == 2  # Euler
    for face, others in enumerate(FACES.neighbours):
        for other in others:
            assert face in FACES.neighbours[other]


def test_the_papers_second_pose_stands_on_3_5_12():
    from tensegym.robot.start_poses import PAPER_POSES

    nodes = PAPER_POSES["paper-2"].apply(paper().nodes.copy())
    lowest = sorted(np.argsort(nodes[:, 2])[:3] + 1)
    assert lowest == [3, 5, 12]


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 19), st.floats(-7, 7))
def test_resting_rotation_lays_the_face_flat_and_heading_turns_it(face, heading):
    structure = six_rod()
    turn = resting_rotation(structure.nodes, FACES.triangles[face], heading)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1)
    nodes = structure.nodes @ turn.T
    low = nodes[FACES.triangles[face]]
    np.testing.assert_allclose(low[:, 2], nodes[:, 2].min(), atol=1e-12)
    forward = low[0] - low.mean(axis=0)
    assert np.cos(np.arctan2(forward[1], forward[0]) - heading) == pytest.approx(1)
    assert supporting_face(FACES, nodes, nodes.mean(axis=0)) == face


def test_faces_are_found_by_node_numbers_in_any_order():
    index = face_by_nodes(FACES, "12-3-5")
    assert sorted(FACES.triangles[index] + 1) == [3, 5, 12]
    for wrong in ("1-2-3", "a-b-c", "3-5"):
        with pytest.raises(StructureError, match="the faces are"):
            face_by_nodes(FACES, wrong)


def test_flat_structures_have_no_faces():
    flat = Structure(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]]), [(0, 1), (2, 3)], [(0, 2)], [])
    with pytest.raises(StructureError, match="no volume"):
        hull_faces(flat)


def test_the_halves_of_a_square_are_one_level_face():
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    rods = np.array([[0, 7], [1, 6], [2, 5], [3, 4]])
    faces = hull_faces(Structure(cube, rods, np.array([[0, 1]]), np.zeros((0, 2), dtype=int)))
    assert len(faces.triangles) == 12
    for plane in set(faces.planes.tolist()):
        assert (faces.planes == plane).sum() == 2
        assert faces.normals[faces.planes == plane] == pytest.approx(np.tile(faces.normals[plane], (2, 1)))
    assert FACES.planes.tolist() == list(range(20))
