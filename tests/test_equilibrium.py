import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tensegym.equilibrium import check_balance, count_states, equilibrium_matrix, feasible_self_stress, form_find
from tensegym.errors import StructureError
from tensegym.structure import PAPER_ROD_LENGTH, Structure, paper, six_rod


@settings(max_examples=20, deadline=None)
@given(
    st.integers(0, 2**31),
    st.floats(0.1, 10),
    st.tuples(*[st.floats(-5, 5)] * 3),
)
def test_counts_do_not_change_under_motion_and_scale(seed, scale, shift):
    structure = six_rod(1.0)
    turn = Rotation.random(random_state=np.random.default_rng(seed))
    moved = structure.with_nodes(scale * turn.apply(structure.nodes.copy()) + shift)
    before, after = count_states(structure), count_states(moved)
    assert (before.rank, before.self_stress_states, before.mechanisms) == (
        after.rank, after.self_stress_states, after.mechanisms)  # fmt: skip


def test_self_stress_leaves_no_force_on_any_node():
    structure = six_rod()
    stress = feasible_self_stress(structure)
    assert stress is not None
    assert (stress[:24] > 0).all()
    np.testing.assert_allclose(equilibrium_matrix(structure) @ stress, 0, atol=1e-9)


def test_form_finding_keeps_rods_and_leaves_a_balanced_structure_alone():
    found = form_find(paper(), 10.0)
    np.testing.assert_allclose(found.rod_lengths, 0.7016, rtol=1e-12)
    check_balance(found, 10.0)
    balanced = six_rod()
    assert form_find(balanced, 10.0) is balanced


@pytest.mark.parametrize("payload_tension", [0.5, 2.0, 4.0])
def test_payload_draws_the_rods_together_as_the_closed_form_says(payload_tension):
    found = form_find(six_rod(), 10.0, payload_tension)
    middles = found.nodes[found.rods].mean(axis=1)
    d, h = np.linalg.norm(middles[0] - middles[1]) / 2, PAPER_ROD_LENGTH / 2
    cable = found.lengths(found.cables).mean()
    assert 4 * 10 / cable * (h - 2 * d) == pytest.approx(payload_tension, rel=1e-6)


def three_rod_prism(twist: float) -> Structure:
    angle = 2 * np.pi / 3 * np.arange(3)
    bottom = np.c_[np.cos(angle), np.sin(angle), 0 * angle]
    top = np.c_[np.cos(angle + twist), np.sin(angle + twist), 0 * angle + 1.5]
    cables = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 4), (1, 5), (2, 3)]
    return Structure(np.vstack([bottom, top]), [(0, 3), (1, 4), (2, 5)], cables, [])


def test_prism_holds_stress_at_150_degrees_between_rod_ends_only():
    """The triplex's twist, pi/2 - pi/3 past the straight prism's verticals: 150 degrees along a rod."""
    assert feasible_self_stress(three_rod_prism(np.radians(-140))) is None
    assert feasible_self_stress(three_rod_prism(np.radians(-150))) is not None
    found = form_find(three_rod_prism(np.radians(-140)), 10.0)
    rod = found.nodes[found.rods]
    axis = np.cross(found.nodes[1] - found.nodes[0], found.nodes[2] - found.nodes[0])
    axis /= np.linalg.norm(axis)
    centre = found.nodes.mean(axis=0)
    arms = rod - centre - ((rod - centre) @ axis)[..., None] * axis
    cosine = (arms[:, 0] * arms[:, 1]).sum(axis=1) / np.prod(np.linalg.norm(arms, axis=2), axis=1)
    np.testing.assert_allclose(np.degrees(np.arccos(cosine)), 150, atol=1e-4)


def test_unbalanced_nodes_are_named():
    with pytest.raises(StructureError, match=r"out of balance: 1 \(.* N\).*12 .*no self-stress.*form_finding"):
        check_balance(paper(), 10.0)


def test_form_finding_refuses_cables_that_cannot_hold_the_rods():
    whole = six_rod()
    bare = Structure(whole.nodes, whole.rods, whole.cables[:5], [])
    with pytest.raises(StructureError, match="form finding found no shape"):
        form_find(bare, 10.0)


def test_form_finding_refuses_no_tension():
    with pytest.raises(StructureError, match="tension = 0"):
        form_find(six_rod(), 0)
