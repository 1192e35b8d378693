"""Builders against closed forms: twist, force densities, lengths; and that what they say pulls alike is in balance."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.errors import StructureError
from tensegym.structures import BUILDERS, Octahedron, Prism, Spine, Stack, ThreeRodRobot, Tower, Truncated, blueprint
from tensegym.structures.truncated import SOLIDS

GOLDEN = (1 + np.sqrt(5)) / 2
KINDS = (
    Prism(3), Prism(7, 0.2, 0.9), Octahedron(), *(Truncated(solid) for solid in SOLIDS), Truncated("cube", ratio=3.0),
    Tower(3), Tower(4), Stack(1), Stack(4, rods=5), Spine(3), ThreeRodRobot(),
)  # fmt: skip


def rod_densities(plan):
    """(r,) the rods' force densities that balance the cables best, and what is left on the nodes."""
    pairs = np.concatenate([plan.all_cables, plan.rods])
    spans = plan.nodes[pairs[:, 1]] - plan.nodes[pairs[:, 0]]
    forces = np.zeros((len(plan.nodes), 3, len(pairs)))
    columns = np.arange(len(pairs))
    forces[pairs[:, 0], :, columns] = spans
    forces[pairs[:, 1], :, columns] -= spans
    forces = forces.reshape(-1, len(pairs))
    pull = forces[:, : len(plan.all_cables)] @ plan.densities()
    rods, *_ = np.linalg.lstsq(forces[:, len(plan.all_cables) :], -pull, rcond=None)
    return rods, pull + forces[:, len(plan.all_cables) :] @ rods


def stress_matrix(plan):
    """(n, n), of rank n - 4 and without a negative eigenvalue where the structure is super-stable (Connelly 1999)."""
    pairs, density = np.concatenate([plan.all_cables, plan.rods]), np.append(plan.densities(), rod_densities(plan)[0])
    matrix = np.zeros((len(plan.nodes),) * 2)
    for (a, b), q in zip(pairs, density, strict=True):
        matrix[[a, b], [a, b]] += q
        matrix[[a, b], [b, a]] -= q
    return matrix


@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_the_tensions_that_a_builder_names_balance_its_nodes(kind):
    plan = kind.build()
    assert set(plan.tensions) == set(plan.cables)
    assert np.abs(rod_densities(plan)[1]).max() < 1e-9 * plan.densities().max()


@pytest.mark.parametrize("kind", [kind for kind in KINDS if not isinstance(kind, Spine | Tower)], ids=str)
def test_and_hold_them_at_any_stiffness(kind):
    """Affine motions alone cost no energy; of a stack, those of each prism, which may be of any height."""
    values = np.linalg.eigvalsh(stress_matrix(kind.build()))
    free = 4 + (kind.stages - 1 if isinstance(kind, Stack) else 0)
    assert (values > -1e-9 * values[-1]).all()
    assert (values > 1e-9 * values[-1]).sum() == len(values) - free


@given(st.integers(3, 40), st.floats(0.05, 2), st.floats(0.05, 5))
@settings(max_examples=30, deadline=None)
def test_a_prism_of_any_height(rods, radius, height):
    """Twist pi/2 - pi/n, q of an upright cable 2 sin(pi/n) of one around, of a rod minus that (Connelly, Terrell)."""
    plan = Prism(rods, radius, height).build()
    low, high = plan.nodes[0], plan.nodes[rods]
    assert np.arctan2(high[1], high[0]) - np.arctan2(low[1], low[0]) == pytest.approx(np.pi / 2 - np.pi / rods)
    assert np.ptp(plan.nodes[:, 2]) == pytest.approx(height)
    around, upright = plan.densities()[[0, -1]]
    found, left = rod_densities(plan)
    assert upright / around == pytest.approx(2 * np.sin(np.pi / rods))
    assert found == pytest.approx(-upright)
    assert np.abs(left).max() < 1e-9 * around * max(radius, height)


def test_a_prism_of_another_twist_names_no_tensions():
    assert Prism(4, twist=10.0).build().tensions == {}
    assert Prism(4, twist=45.0).build().tensions


def test_the_four_rod_prism_and_the_three_rod_robot():
    """A four-rod prism wants q sqrt(2) upright; the robot's cables around are sqrt(3) of those between, alike tense."""
    assert Prism(4).build().densities()[-1] / Prism(4).build().densities()[0] == pytest.approx(np.sqrt(2))
    robot = ThreeRodRobot(0.325).build()
    around, upright = robot.lengths(robot.all_cables)[[0, -1]]
    assert around / upright == pytest.approx(np.sqrt(3))
    assert robot.tensions["upright"] == pytest.approx(1)
    assert robot.lengths(robot.rods) == pytest.approx(0.325)
    assert {tuple(sorted(pair)) for pair in robot.stiff_cables} == {tuple(sorted(p)) for p in robot.cables["around"]}


@pytest.mark.parametrize("length", [0.1, 1.9])
def test_an_octahedron_of_any_size(length):
    """Cables of sqrt(3/8) rods; rods' force densities -3/2 of the cables'."""
    plan = Octahedron(length).build()
    assert plan.lengths(plan.rods) == pytest.approx(length)
    assert plan.lengths(plan.all_cables) == pytest.approx(np.sqrt(3 / 8) * length)
    assert rod_densities(plan)[0] / plan.densities()[0] == pytest.approx(-1.5)


def test_two_stages_of_three_rods_are_the_octahedron():
    tower = Tower(3, 0.7).build()
    assert tower.lengths(tower.all_cables) == pytest.approx(np.sqrt(3 / 8) * 0.7)
    assert np.ptp(tower.nodes[:, 2]) == pytest.approx(np.sqrt(3) / 2 * 0.7)


@given(st.floats(0.1, 10))
@settings(max_examples=20, deadline=None)
def test_a_truncated_tetrahedron(ratio):
    """The sum of 1 / (3 + 2 q_b), 1 / (3 + 2 q_e + 2 q_b) and 1 / (3 + 2 q_e) is 1: the module's matrix is a dyad less
    a diagonal, as the three turns permute the axes, or change their signs."""
    plan = Truncated("tetrahedron", ratio=ratio).build()
    corner = plan.densities()[0]
    rods = rod_densities(plan)[0] / corner
    assert np.ptp(rods) < 1e-9
    terms = np.array([3 + 2 * rods[0], 3 + 2 * ratio + 2 * rods[0], 3 + 2 * ratio])
    assert (1 / terms).sum() == pytest.approx(1)
    assert plan.densities()[-1] / corner == pytest.approx(ratio)


def test_a_truncated_icosahedron_of_equal_densities_has_equal_cables():
    """Then a rod's force density is -1 over the golden ratio squared."""
    plan = Truncated("icosahedron").build()
    assert np.ptp(plan.lengths(plan.all_cables)) < 1e-9
    assert rod_densities(plan)[0] / plan.densities()[0] == pytest.approx(-(GOLDEN**-2))
    assert len(plan.rods) == 30


@pytest.mark.parametrize(("solid", "rods"), [("tetrahedron", 6), ("cube", 12), ("octahedron", 12)])
def test_truncated_solids_have_a_rod_and_three_cables_at_every_node(solid, rods):
    plan = Truncated(solid, 0.9).build()
    assert len(plan.rods) == rods
    assert plan.lengths(plan.rods) == pytest.approx(0.9)
    assert (np.bincount(plan.all_cables.ravel()) == 3).all()
    assert plan.joint_class == 1


def test_which_structures_share_nodes():
    classes = {name: builder().build().joint_class for name, builder in BUILDERS.items()}
    assert {name: k for name, k in classes.items() if k > 1} == {"stack": 2, "spine": 3}


@given(st.integers(2, 6), st.floats(0.05, 1), st.floats(0.15, 0.9))
@settings(max_examples=20, deadline=None)
def test_a_spine_hangs_by_three_cables_and_is_tied_by_three(vertebrae, edge, pitch):
    plan = Spine(vertebrae, edge, pitch).build()
    hanger, tie = (plan.tensions[name] / plan.lengths(plan.cables[name])[0] for name in ("hanger", "tie"))
    assert tie / hanger == pytest.approx((1 - pitch) / pitch)
    assert plan.lengths(plan.rods) == pytest.approx(edge)
    assert np.ptp(plan.nodes[:, 2]) == pytest.approx(edge * np.sqrt(2 / 3) * (1 + pitch * (vertebrae - 1)))


def test_what_is_no_structure_is_refused_by_name():
    with pytest.raises(StructureError, match=r"structure.builder = 'pyramid' is not one of prism, octahedron"):
        blueprint({"builder": "pyramid"})
    with pytest.raises(StructureError, match="rods = 2 is outside"):
        blueprint({"builder": "prism", "rods": 2})
    with pytest.raises(StructureError, match=r"unknown .*'sides'"):
        blueprint({"builder": "prism", "sides": 2})
