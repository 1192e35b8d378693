"""The FEM of whole hinges: energy balance, frames, scales, symmetry, instability, bad input."""

import numpy as np
import pytest

from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.hinge import GROUND, PAPER_HINGES, PRESETS, TIP, Hinge, Leaf, Material, preset

ASYMMETRIC = Hinge("asymmetric", (Leaf(GROUND, (0, -0.01), TIP, (0.04, 0.012), 0.02, 0.0008),
                                  Leaf(TIP, (0.04, -0.005), GROUND, (0, 0.02), 0.02, 0.0006)), 0.04)  # fmt: skip
THETA = np.radians(np.linspace(0.5, 30, 60))


def all_hinges():
    return [*(preset(name) for name in PAPER_HINGES), ASYMMETRIC]


@pytest.mark.parametrize("hinge", all_hinges(), ids=lambda h: h.name)
def test_energy_is_the_work_of_the_loads(hinge):
    """dE = F . dp + M dtheta along a fine sweep, by Simpson's rule: the forces are the energy's gradient."""
    theta = np.linspace(0, 0.4, 401)
    force = np.column_stack([0.3 * np.sin(3 * theta), 0.5 * theta])
    solution = fem.rotate(hinge, theta, force=force)
    assert (solution.status == fem.CONVERGED).all()
    step = theta[1]
    rate = np.gradient(solution.tip, step, axis=0, edge_order=2)
    power = np.sum(solution.force * rate, axis=1) + solution.moment
    work = step / 3 * (power[0] + power[-1] + 4 * power[1::2].sum() + 2 * power[2:-1:2].sum())
    assert work == pytest.approx(solution.energy[-1] - solution.energy[0], rel=2e-5)


@pytest.mark.parametrize("hinge", all_hinges(), ids=lambda h: h.name)
def test_sweep_and_single_paths_agree(hinge):
    together = fem.rotate(hinge, THETA)
    single = fem.rotate(hinge, THETA[::10], from_rest=True)
    assert together.tip[::10] == pytest.approx(single.tip, abs=1e-13)
    assert together.moment[::10] == pytest.approx(single.moment, rel=1e-9)


def test_wrench_control_returns_to_a_state_of_rotation_control():
    hinge = preset("x-hinge")
    turned = fem.rotate(hinge, [0.3], force=[2.0, -1.0])
    loaded = fem.apply_wrench(hinge, [*turned.force[0], turned.moment[0]])
    assert loaded.theta[0] == pytest.approx(0.3, abs=1e-9)
    assert loaded.tip == pytest.approx(turned.tip, abs=1e-11)
    assert loaded.energy == pytest.approx(turned.energy, rel=1e-8)


def test_force_at_the_arms_end_is_force_and_moment_at_the_tip():
    hinge = preset("leaf-spring")
    at_end = fem.apply_wrench(hinge, [0.05, 0.3, 0], arm=0.12)
    lever = 0.12 * (np.cos(at_end.theta) * 0.3 - np.sin(at_end.theta) * 0.05)
    assert at_end.moment == pytest.approx(lever, rel=1e-12)
    turned = fem.rotate(hinge, at_end.theta, force=[0.05, 0.3])
    assert turned.moment == pytest.approx(lever, rel=1e-8)


@pytest.mark.parametrize("name", [*PAPER_HINGES, "cross-spring"])
def test_mirror_image(name):
    """Hinges symmetric about their axis: turning the other way mirrors the tip."""
    up = fem.rotate(preset(name), THETA[::12], force=[0.2, 0.3])
    down = fem.rotate(preset(name), -THETA[::12], force=[0.2, -0.3])
    assert down.tip == pytest.approx(up.tip * [1, -1], abs=1e-12)
    assert down.moment == pytest.approx(-up.moment, rel=1e-9)


def test_scales_with_modulus_and_size():
    """Twice E: twice the moment, the same shape. Twice every length: 8 times the moment, twice the shape."""
    base = fem.rotate(preset("trls2"), THETA[::12])
    stiff = fem.rotate(preset("trls2").with_material(Material(2 * 2.95e9)), THETA[::12])
    assert stiff.moment == pytest.approx(2 * base.moment, rel=1e-9)
    assert stiff.tip == pytest.approx(base.tip, abs=1e-13)
    large = fem.rotate(preset("trls2", length=0.08, width=0.08, thickness=0.0016, rib=0.0016), THETA[::12])
    assert large.moment == pytest.approx(8 * base.moment, rel=1e-9)
    assert large.tip == pytest.approx(2 * base.tip, abs=1e-12)


def test_plate_modulus_is_the_beams_over_one_minus_nu_squared():
    plate = fem.rotate(preset("tfch").with_material(Material(modulus="plate")), [0.4])
    beam = fem.rotate(preset("tfch"), [0.4])
    assert plate.moment / beam.moment == pytest.approx(1 / (1 - 0.38**2), rel=1e-9)


def test_splitting_a_leaf_by_a_body_changes_nothing():
    """A rigid body of no extent in the middle of a leaf: the graph with inner bodies against the plain leaf."""
    half = (
        Leaf(GROUND, (0, 0), "middle", (0.02, 0), 0.04, 0.0008),
        Leaf(TIP, (0.04, 0), "middle", (0.02, 0), 0.04, 0.0008),
    )
    split = fem.rotate(Hinge("split", half, 0.04, (GROUND, "middle", TIP)), THETA[::12], force=[0.2, 0.3])
    whole = fem.rotate(preset("leaf-spring"), THETA[::12], force=[0.2, 0.3])
    assert split.tip == pytest.approx(whole.tip, abs=1e-12)
    assert split.moment == pytest.approx(whole.moment, rel=1e-8)
    assert split.energy == pytest.approx(whole.energy, rel=1e-8)


def test_parallel_guide_is_two_clamped_leaves():
    """Transverse stiffness 2 * 12 EI / L^3 of two clamped leaves at small deflection."""
    hinge = preset("parallel-guide")
    ei = 2.95e9 * 0.04 * 0.0008**3 / 12
    solution = fem.apply_wrench(hinge, [0, 1e-3, 0])
    assert 1e-3 / solution.tip[0, 1] == pytest.approx(2 * 12 * ei / 0.04**3, rel=2e-3)


def test_cross_spring_in_the_middle_is_the_tfch():
    a, b = fem.rotate(preset("cross-spring"), [0.5], force=[1, -1]), fem.rotate(preset("tfch"), [0.5], force=[1, -1])
    assert a.tip == pytest.approx(b.tip, abs=1e-12)
    assert a.moment == pytest.approx(b.moment, rel=1e-9)


def test_snap_through_is_reported():
    """A shallow arch: past its limit load there is a far, stable state; taking it would be stepping over buckling."""
    rise = 0.004
    leaves = (
        Leaf(GROUND, (0, -rise), TIP, (0.04, 0), 0.04, 0.0008),
        Leaf(GROUND, (0.08, -rise), TIP, (0.04, 0), 0.04, 0.0008),
    )
    solution = fem.apply_wrench(Hinge("arch", leaves, 0.04), [[0, -10.0, 0], [0, -20.0, 0], [0, -1000.0, 0]])
    assert solution.status.tolist() == [fem.CONVERGED, fem.BUCKLED, fem.BUCKLED]
    limit = solution.reached[1] * 20
    assert solution.reached[2] * 1000 == pytest.approx(limit, abs=0.2)
    assert 10 < limit < 14


def test_stability_under_the_dead_load_is_told():
    """Compressed past its column load a leaf can be held at an angle, but not left alone."""
    hinge = preset("leaf-spring")
    euler = np.pi**2 * 2.95e9 * 0.04 * 0.0008**3 / 12 / (4 * 0.04**2)
    solution = fem.rotate(hinge, [0.02], force=[-1.2 * euler, 0])
    assert solution.status[0] == fem.CONVERGED
    assert not solution.stable[0] and solution.moment[0] < 0
    assert fem.rotate(hinge, [0.02], force=[-0.8 * euler, 0]).stable[0]


@pytest.mark.parametrize(("call", "words"), [
    (lambda h: fem.rotate(h, [np.nan]), "theta has a value that is not finite, in row 0"),
    (lambda h: fem.rotate(h, [7.0]), "outside"),
    (lambda h: fem.rotate(h, [0.1], direction=[0, 1, 0]), "no moment"),
    (lambda h: fem.rotate(h, [0.1, 0.2], force=np.zeros((3, 2))), "force has shape"),
    (lambda h: fem.apply_wrench(h, [0, 1]), "wrench has shape"),
    (lambda h: fem.mesh_of(h, 0), "elements = 0"),
])  # fmt: skip
def test_bad_calls(call, words):
    with pytest.raises(FlexureError, match=words):
        call(preset("leaf-spring"))


def test_every_preset_is_at_rest_without_load():
    for name in PRESETS:
        hinge = preset(name)
        solution = fem.apply_wrench(hinge, np.zeros(3))
        assert solution.energy[0] == pytest.approx(0, abs=1e-20)
        assert solution.tip[0] == pytest.approx([hinge.length, 0], abs=1e-15)
