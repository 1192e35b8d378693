"""Leaves whose thickness changes: closed forms of notches and tapers, and a mesh that knows when it is too coarse."""

import math

import numpy as np
import pytest

from tensegym.flexure import fem
from tensegym.flexure.fem.mesh_error import load_error, too_coarse, too_coarse_for
from tensegym.flexure.fem.tangent import memory_at, tip_stiffness
from tensegym.flexure.hinge import GROUND, PRESETS, TIP, Hinge, Leaf, Taper, preset
from tensegym.flexure.hinge.presets import leaf_spring, notch_hinge, tapered_leaf
from tensegym.flexure.models.notch_formulas import notch_compliance, thin_notch_compliance

WIDTH, E = 0.04, 2.95e9


def compliance(hinge, elements=fem.ELEMENTS):
    turned = fem.rotate(hinge, [1e-5], elements=elements)
    return float(turned.theta[0] / turned.moment[0])


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.4])
@pytest.mark.parametrize("depth", [0.005, 0.002])
def test_notches_are_those_of_paros_and_weisbord(ratio, depth):
    hinge = notch_hinge(thickness=ratio * 0.005, depth=depth)
    exact = notch_compliance(E, WIDTH, ratio * 0.005, 0.005, depth)
    assert compliance(hinge) == pytest.approx(exact, rel=1e-6)


def test_the_approximation_for_thin_webs_errs_in_proportion_to_the_web():
    ratios = np.array([0.01, 0.02, 0.04])
    exact = np.array([compliance(notch_hinge(thickness=ratio * 0.005)) for ratio in ratios])
    thin = np.array([thin_notch_compliance(E, WIDTH, ratio * 0.005, 0.005) for ratio in ratios])
    assert thin / exact - 1 == pytest.approx(ratios / 8, rel=0.05)


def test_a_straight_web_adds_its_own_compliance():
    """Of two corner-filleted leaves with the same circles the longer one has more straight web, 12 l / (E b t^3)."""
    shorter, longer = (compliance(notch_hinge(length=length, radius=2e-3)) for length in (0.006, 0.010))
    assert longer - shorter == pytest.approx(12 * 0.004 / (E * WIDTH * 0.5e-3**3), rel=2e-3)


def test_tapered_cantilever_under_an_end_force():
    """t = a + (b - a) s / L: deflection F / E times the integral of 12 (L - s)^2 / (w t^3), by hand."""
    a, b, length, force = 0.8e-3, 0.4e-3, 0.04, 1e-5
    slope = (b - a) / length
    tip = length + a / slope  # from the taper's own apex: t = slope (s + a / slope)
    ends = (tip - length, tip)

    def antiderivative(u):  # of (tip - u)^2 / u^3
        return math.log(abs(u)) + 2 * tip / u - tip**2 / (2 * u**2)

    exact = 12 * force / (E * WIDTH * slope**3) * (antiderivative(ends[1]) - antiderivative(ends[0]))
    errors = [abs(fem.apply_wrench(tapered_leaf(), [0, force, 0], elements=n).tip[0, 1] / exact - 1) for n in (8, 16)]
    assert errors[1] < 2e-4
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)


def test_a_taper_from_either_end_is_the_same_leaf():
    turned = Leaf(TIP, (0.04, 0.0), GROUND, (0.0, 0.0), WIDTH, 0.4e-3, Taper(0.8e-3))
    one, two = (fem.rotate(h, [0.4], force=[0.2, 0.1]) for h in (tapered_leaf(), Hinge("h", (turned,), 0.04)))
    assert one.tip == pytest.approx(two.tip, abs=1e-12)
    assert one.moment == pytest.approx(two.moment, rel=1e-9)


def test_a_taper_to_its_own_thickness_is_a_uniform_leaf():
    uniform, tapered = leaf_spring(), tapered_leaf(end_thickness=0.8e-3)
    wrench = [0.3, 0.5, 0.02]
    one, two = fem.apply_wrench(uniform, wrench, elements=64), fem.apply_wrench(tapered, wrench, elements=16)
    assert one.tip == pytest.approx(two.tip, abs=1e-12)


@pytest.mark.parametrize("name", PRESETS)
def test_the_default_mesh_is_fine_for_every_preset(name):
    hinge = preset(name)
    assert too_coarse(hinge, hinge.max_angle) == ""


@pytest.mark.parametrize("elements", [16, 500])
def test_a_thick_end_does_not_drown_a_thin_web(elements):
    """The ends are a thousand times as thick as the web: 10^9 times as stiff. Elements of one length seem to buckle."""
    hinge, web = notch_hinge(thickness=1e-5), 1e-5
    turned = fem.rotate(hinge, [1e-3], elements=elements)
    assert turned.status[0] == fem.CONVERGED
    exact = notch_compliance(E, WIDTH, web, 0.005, 0.005)
    assert turned.theta[0] / turned.moment[0] == pytest.approx(exact, rel=1e-5)
    mesh = fem.mesh_of(hinge, 16)
    held = memory_at(mesh, fem.rotate(hinge, [1e-3], keep_nodes=True), 0)
    assert np.linalg.inv(tip_stiffness(mesh, held))[2, 2] == pytest.approx(exact, rel=1e-5)


def test_a_coarse_mesh_says_which_to_take():
    hinge = leaf_spring()
    said = too_coarse(hinge, 0.5, 1)
    assert said.startswith("the mesh is too coarse: elements = 1 is off by") and said.endswith("elements = 2")
    assert too_coarse(hinge, 0.5, 2) == ""
    assert too_coarse_for(hinge, [0, 6.0, 0], 2).endswith("elements = 4")


def test_the_estimate_is_the_error():
    """Against a mesh of 128 elements, whose own error is 1e-10 L."""
    hinge, wrench = leaf_spring(), [0, 3.0, 0.0]
    exact = fem.apply_wrench(hinge, wrench, elements=128)
    for elements in (2, 4, 8):
        found = fem.apply_wrench(hinge, wrench, elements=elements)
        apart = max(np.linalg.norm(found.tip - exact.tip) / 0.04, abs(found.theta - exact.theta)[0]) / 1e-4
        assert load_error(hinge, wrench, elements) == pytest.approx(apart, rel=0.15)
