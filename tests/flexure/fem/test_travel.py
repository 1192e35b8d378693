"""Along a hinge's travel: stiffness, stress, buckling and stiffness out of plane, against closed forms."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.fem.mesh_error import too_coarse_for
from tensegym.flexure.fem.out_of_plane import out_of_plane_stiffness
from tensegym.flexure.fem.push import push
from tensegym.flexure.fem.stress import largest_stress
from tensegym.flexure.fem.tangent import load_factor, memory_at, tip_stiffness
from tensegym.flexure.fem.travel import pushed, turned
from tensegym.flexure.hinge import GROUND, TIP, Hinge, Leaf, preset
from tensegym.flexure.hinge.presets import leaf_spring, notch_hinge, parallel_guide

LENGTH, WIDTH, THICK, E, NU = 0.04, 0.04, 0.8e-3, 2.95e9, 0.38
EI = E * WIDTH * THICK**3 / 12
ASYMMETRIC = Hinge("asymmetric", (Leaf(GROUND, (0, -0.01), TIP, (0.04, 0.012), 0.02, 0.0008),
                                  Leaf(TIP, (0.04, -0.005), GROUND, (0, 0.02), 0.02, 0.0006)), 0.04)  # fmt: skip


def state(hinge, wrench, elements=fem.ELEMENTS):
    found = fem.apply_wrench(hinge, wrench, elements=elements, keep_nodes=True)
    assert found.status[0] == fem.CONVERGED
    mesh = fem.mesh_of(hinge, elements)
    return mesh, memory_at(mesh, found, 0)


@pytest.mark.parametrize("hinge", [preset("x-hinge"), preset("trls2"), ASYMMETRIC, preset("notch-hinge")],
                         ids=lambda h: h.name)  # fmt: skip
def test_stiffness_is_the_slope_of_the_load(hinge):
    wrench = np.array([1.2, -0.4, 0.02])
    stiffness = tip_stiffness(*state(hinge, wrench))
    assert stiffness == pytest.approx(stiffness.T, rel=1e-6, abs=1e-6 * np.abs(stiffness).max())
    for change in 1e-3 * np.diag(np.abs(wrench)):
        more, less = (fem.apply_wrench(hinge, wrench + sign * change) for sign in (1, -1))
        moved = np.array([*(more.tip - less.tip)[0], (more.theta - less.theta)[0]])
        assert stiffness @ moved == pytest.approx(2 * change, rel=1e-3, abs=1e-3 * 2 * change.max())


@pytest.mark.parametrize("share", [0.1, 0.99, 1.5])
def test_a_cantilever_buckles_at_eulers_load(share):
    """pi^2 EI / (4 L^2); a state held past it, by its turn, has a factor below 1."""
    euler = np.pi**2 * EI / (4 * LENGTH**2)
    if share < 1:
        mesh, mem = state(leaf_spring(), [-share * euler, 0, 0])
    else:
        held = fem.rotate(leaf_spring(), [1e-6], force=[-share * euler, 0], keep_nodes=True)
        mesh = fem.mesh_of(leaf_spring())
        mem = memory_at(mesh, held, 0)
    assert share * load_factor(mesh, mem) == pytest.approx(1, abs=3e-4)


def test_a_guide_buckles_sideways_at_two_columns():
    """Both leaves are clamped at the ends and free to sway: pi^2 EI / L^2 each."""
    load = 2 * np.pi**2 * EI / LENGTH**2
    factors = pushed(parallel_guide(), np.array([0.0]), axial=-0.5 * load).load_factor
    assert 0.5 * factors[0] == pytest.approx(1, abs=5e-4)


def test_bodies_turning_counts_in_buckling():
    """A rigid bar on a short leaf: the load that the body carries past the leaf's end buckles it, P a = K."""
    hinge = Hinge("bar", (Leaf(GROUND, (0, 0), TIP, (1e-3, 0), WIDTH, 1e-5),), 0.1)
    stiffness = E * WIDTH * 1e-5**3 / 12 / 1e-3
    mesh, mem = state(hinge, [-0.5 * stiffness / 0.1, 0, 0])
    assert 0.5 * load_factor(mesh, mem) == pytest.approx(1, abs=0.01)  # the leaf's own length is 1 % of the bar's


def test_a_pull_never_buckles():
    assert np.isinf(turned(leaf_spring(arm=0), np.array([0.1, 0.3]), axial=5.0).load_factor).all()


def test_stress_of_a_leaf_bent_by_a_moment_and_pulled():
    turn = fem.rotate(leaf_spring(), [0.5], keep_nodes=True)
    mesh = fem.mesh_of(leaf_spring())
    bent = largest_stress(leaf_spring(), mesh, memory_at(mesh, turn, 0))
    assert bent.size == pytest.approx(6 * turn.moment[0] / (WIDTH * THICK**2), rel=1e-9)
    assert bent.size == pytest.approx(E * THICK / 2 * 0.5 / LENGTH, rel=1e-6)  # E times half of t over the radius
    pulled = largest_stress(leaf_spring(), *state(leaf_spring(), [20.0, 0, 0]))
    assert pulled.size == pytest.approx(20 / (WIDTH * THICK), rel=1e-9)


def test_stress_of_a_cantilever_is_at_its_clamp_and_of_a_notch_at_its_web():
    clamp = largest_stress(leaf_spring(), *state(leaf_spring(), [0, 1e-3, 0]))
    assert (clamp.size, clamp.share) == (pytest.approx(6 * 1e-3 * LENGTH / (WIDTH * THICK**2), rel=1e-6), 0.0)
    web = largest_stress(notch_hinge(), *state(notch_hinge(), [0, 0, 1e-3]))
    assert (web.size, web.share) == (pytest.approx(6 * 1e-3 / (WIDTH * 0.5e-3**2), rel=1e-6), pytest.approx(0.5))


def sections(width=WIDTH, thick=THICK):
    """E I about the thick side, shear stiffness, torsion, and torsion of a straight leaf with its warping hindered."""
    shear = E / (2 * (1 + NU))
    torsion = shear * width * thick**3 * (1 / 3 - 0.21 * thick / width * (1 - (thick / width) ** 4 / 12))
    z = LENGTH / 2 * np.sqrt(torsion / (E * (width * thick) ** 3 / 144))
    return E * thick * width**3 / 12, 5 / 6 * shear * thick * width, torsion, torsion / (1 - np.tanh(z) / z)


def test_a_straight_leaf_out_of_plane_is_a_beam():
    bending, shear, _, torsion = sections()
    c = np.linalg.inv(out_of_plane_stiffness(leaf_spring(), *state(leaf_spring(), [0, 0, 0])))
    assert c[0, 0] == pytest.approx(LENGTH**3 / (3 * bending) + LENGTH / shear, rel=1e-9)
    assert c[1, 1] == pytest.approx(LENGTH / torsion, rel=1e-5)
    assert c[2, 2] == pytest.approx(LENGTH / bending, rel=1e-9)
    assert c[0, 2] == pytest.approx(-(LENGTH**2) / (2 * bending), rel=1e-9)  # up at the tip is a turn down about y


def test_a_leaf_bent_to_a_quarter_circle_gives_by_bending_and_torsion():
    """Castigliano: R^3 (pi / 4 / EI + (3 pi / 4 - 2) / GJ) and the shear, for a leaf too narrow to be hindered."""
    narrow = leaf_spring(width=1e-4, thickness=1e-5)
    bending, shear, torsion, _ = sections(1e-4, 1e-5)
    found = fem.rotate(narrow, [np.pi / 2], elements=200, keep_nodes=True)
    mesh = fem.mesh_of(narrow, 200)
    c = np.linalg.inv(out_of_plane_stiffness(narrow, mesh, memory_at(mesh, found, 0)))
    radius = LENGTH / (np.pi / 2)
    exact = radius**3 * (np.pi / 4 / bending + (3 * np.pi / 4 - 2) / torsion) + LENGTH / shear
    assert c[0, 0] == pytest.approx(exact, rel=5e-3)


def test_out_of_plane_is_near_the_solid(monkeypatch):
    """A leaf as wide as long, flat and bent by 30 deg, against hexahedra: within 10 %, too soft each time."""
    monkeypatch.syspath_prepend(str(Path(__file__).parents[3] / "benchmarks"))
    solid = import_module("leaf_solid")
    for bend in (0.0, np.radians(30)):
        exact = solid.free(solid.solid_stiffness(LENGTH, NU, bend, (16, 4))[np.ix_((2, 3, 4), (2, 3, 4))])
        beam = solid.ours(LENGTH, NU, bend)
        assert (0.9 * exact < beam).all() and (beam < exact).all()


@settings(max_examples=20, deadline=None)
@given(st.floats(-1.4, 1.4))
def test_out_of_plane_stiffness_turns_with_the_hinge(angle):
    c, s = np.cos(angle), np.sin(angle)
    slanted = Hinge("slanted", (Leaf(GROUND, (0.05 - 0.04 * c, -0.04 * s), TIP, (0.05, 0), WIDTH, THICK),), 0.05)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    straight = out_of_plane_stiffness(leaf_spring(), *state(leaf_spring(), [0, 0, 0]))
    found = out_of_plane_stiffness(slanted, *state(slanted, [0, 0, 0]))
    assert found == pytest.approx(turn @ straight @ turn.T, rel=1e-6, abs=1e-6 * np.abs(straight).max())


@pytest.mark.parametrize(("force", "elements"), [(0.5, 16), (5.0, 16), (50.0, 32)])
def test_strip_under_tension(force, elements):
    """A clamped strip pulled by F, its end turned: sqrt(EI F) coth(L sqrt(F / EI)). Under 50 N it bends within L/17 of
    its clamps, which 16 elements do not see: they say so, and which do."""
    hinge = leaf_spring(thickness=0.3e-3, arm=0)
    bending = E * WIDTH * 0.3e-3**3 / 12
    exact = np.sqrt(bending * force) / np.tanh(LENGTH * np.sqrt(force / bending))
    along = turned(hinge, np.array([1e-4]), axial=force, elements=elements)
    assert along.drive_stiffness[0] == pytest.approx(exact, rel=1e-3)
    assert along.states.moment[0] / 1e-4 == pytest.approx(exact, rel=1e-3)
    said = too_coarse_for(hinge, [force, 0, 0.3 * exact])
    assert said.endswith(f"take elements = {elements}") if elements > fem.ELEMENTS else said == ""


def test_push_arrives_and_stiffens():
    travel = np.array([0.0, 1e-3, -2e-3, 4e-3])
    found = push(parallel_guide(), travel)
    assert found.tip[:, 1] == pytest.approx(travel, abs=1e-10)
    assert found.force[1:, 1] / travel[1:] == pytest.approx(24 * EI / LENGTH**3, rel=0.02)
    with pytest.raises(FlexureError, match=r"parallel-guide: at 1 mm of travel, .* buckles at .* lower the travel"):
        push(parallel_guide(), [1e-3], axial=-500.0)
    with pytest.raises(FlexureError, match="travel = 50 mm is not below the hinge's length 40 mm"):
        push(parallel_guide(), [0.0, -0.05])


def test_nodes_are_needed():
    with pytest.raises(FlexureError, match="keep_nodes=True"):
        memory_at(fem.mesh_of(leaf_spring()), fem.rotate(leaf_spring(), [0.1]), 0)
