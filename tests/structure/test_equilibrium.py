import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tensegym.errors import StructureError
from tensegym.structure.equilibrium import check_balance, count_states, equilibrium_matrix, feasible_self_stress
from tensegym.structure.structure import paper, six_rod


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


def test_unbalanced_nodes_are_named():
    with pytest.raises(StructureError, match=r"out of balance: 1 \(.* N\).*12 .*no self-stress.*form_finding"):
        check_balance(paper(), 10.0)
