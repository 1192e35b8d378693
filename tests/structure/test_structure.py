import re

import numpy as np
import pytest

from tensegym.errors import StructureError
from tensegym.structure.structure import PAPER_SPACING, Structure, paper, six_rod


def test_paper_nodes_are_the_printed_table():
    nodes = paper().nodes
    assert nodes.shape == (12, 3)
    np.testing.assert_allclose(nodes[0], [-0.3125, -0.3508, 0])
    np.testing.assert_allclose(nodes[11], [0.3508, 0, -0.3125])
    np.testing.assert_allclose(paper().rod_lengths, 0.7016)


def test_elastic_cables_are_the_24_shortest_pairs():
    structure = six_rod(spacing=PAPER_SPACING)
    lengths = {
        (i, j): np.linalg.norm(structure.nodes[i] - structure.nodes[j]) for i in range(12) for j in range(i + 1, 12)
    }
    shortest = sorted(lengths, key=lengths.get)[:24]
    assert set(shortest) == {tuple(sorted(c)) for c in structure.cables.tolist()}


def test_every_node_carries_four_elastic_cables_and_one_stiff_one_starts_at_each_active_end():
    structure = six_rod()
    assert (np.bincount(structure.cables.ravel()) == 4).all()
    assert sorted(structure.stiff_cables[:, 0] + 1) == [3, 4, 5, 6, 11, 12]


PAIR = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"cables": [(0, 0)]}, "joins node 1 to itself"),
        ({"cables": [(0, 9)]}, "outside 1..4"),
        ({"cables": [(0, 2, 3), (1, 2, 3)]}, "cables row 1 = (0, 2, 3) has 3 entries; a row holds two node numbers"),
        ({"cables": [(0, 2), (1, 2.5)]}, "cables row 2 = [1.0, 2.5]: entry 2 is no whole number"),
        ({"cables": [(0, 2), (1,)]}, "cables row 2 = (1,) has 1 entries"),
        ({"cables": [0, 2]}, "cables row 1 = 0; a row holds two node numbers"),
        ({"nodes": PAIR * 1000}, "rod 1-2 is 1000 m long, outside [0.01, 30] m; coordinates are in m, these look like"),
        ({"nodes": PAIR / 1000}, "rod 1-2 is 0.001 m long, outside [0.01, 30] m"),
        ({"cables": [(0, 2), (2, 0)]}, "3-1 is listed twice"),
        ({"rods": [(0, 1)]}, "node 3 is on no rod"),
        ({"rods": [(0, 1), (1, 2)]}, "node 4 is on no rod"),
        ({"nodes": PAIR * [1, 1, np.nan]}, "nodes row 1[3] = nan is no finite number"),
        ({"nodes": PAIR[:, :2]}, "nodes row 1 = [0.0, 0.0] has 2 entries; a row holds x, y, z in m"),
        ({"nodes": np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 1.0]])}, "nodes 1 and 3 coincide"),
    ],
)
def test_refuses_what_is_no_structure(changes, words):
    parts = {"nodes": PAIR, "rods": [(0, 1), (2, 3)], "cables": [(0, 2)], "stiff_cables": []} | changes
    with pytest.raises(StructureError, match=re.escape(words)):
        Structure(**parts)


def test_arrays_cannot_be_written():
    with pytest.raises(ValueError, match="read-only"):
        six_rod().nodes[0, 0] = 1.0
