import numpy as np
import pytest

from tensegym.errors import StructureError
from tensegym.structure.equilibrium import check_balance, feasible_self_stress
from tensegym.structure.form_finding import form_find
from tensegym.structure.rod_balance import Kept, Law, RodBalance
from tensegym.structure.structure import PAPER_ROD_LENGTH, Structure, paper, six_rod


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


KEPT = Kept(np.array([[0, 2], [4, 0]]), np.array([[0, 7], [2, 9]]), np.arange(24) % 3 - 1, True)


@pytest.mark.parametrize("payload", [0.0, 0.3])
@pytest.mark.parametrize("kept", [None, KEPT])
def test_the_jacobian_is_the_residuals(payload, kept):
    shifts = np.random.default_rng(0).normal(0, 0.03, (12, 3))
    law = Law(np.linspace(0.8, 1, 24), np.linspace(0, 2, 24))
    balance = RodBalance(six_rod().with_nodes(six_rod().nodes + shifts), law, payload, kept)
    state, step = balance.start, 1e-6
    count = state.rows.size + state.logs.size
    sides = [[np.concatenate([balance.residual(moved).ravel(), balance.missed(moved)])
              for row in np.eye(count) for moved in [balance.moved(state, sign * step * row)]]
             for sign in (1, -1)]  # fmt: skip
    differences = np.subtract(*sides).T / (2 * step)
    np.testing.assert_allclose(balance.jacobian(state), differences, atol=1e-8)


@pytest.mark.parametrize("spacing", [0.33, 0.6, PAPER_ROD_LENGTH * 0.89])
def test_any_spacing_comes_back_to_the_closed_form(spacing):
    """Two motions are without stiffness there, so a residual of 1e-15 alone would allow 1e-7 m."""
    found = form_find(six_rod(spacing=spacing), 10.0)
    np.testing.assert_allclose(found.lengths(found.cables), six_rod().lengths(six_rod().cables), atol=1e-10)
    np.testing.assert_allclose(found.nodes, six_rod().nodes, atol=1e-10)


def test_form_finding_from_random_nodes_balances_what_it_returns():
    rng, found = np.random.default_rng(3), 0
    for _ in range(10):
        given = six_rod().with_nodes(six_rod().nodes + rng.normal(0, 0.03, (12, 3)))
        try:
            shape = form_find(given, 10.0)
        except StructureError:
            continue
        found += 1
        check_balance(shape, 10.0)
        np.testing.assert_allclose(shape.rod_lengths, given.rod_lengths, rtol=1e-12)
    assert found >= 8


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


def test_form_finding_refuses_cables_that_cannot_hold_the_rods():
    whole = six_rod()
    bare = Structure(whole.nodes, whole.rods, whole.cables[:5], [])
    with pytest.raises(StructureError, match="form finding found no shape"):
        form_find(bare, 10.0)


def test_form_finding_refuses_no_tension():
    with pytest.raises(StructureError, match="tension = 0"):
        form_find(six_rod(), 0)
