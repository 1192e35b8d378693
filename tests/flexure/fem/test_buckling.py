"""Buckling load of a rod with a hinge in it, and the pin that stands for the hinge, against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from tensegym.errors import FlexureError
from tensegym.flexure.fem.buckling import buckling_load
from tensegym.flexure.fem.mesh import PROFILED
from tensegym.flexure.hinge import PRESETS, Hinge, Leaf, Material, preset, symmetry_of
from tensegym.flexure.hinge.presets import leaf_spring, parallel_guide, tapered_leaf
from tensegym.flexure.models.rod_pin import rod_pin

STEEL = Material(210e9, 0.3)
LENGTHS = st.floats(0.0, 0.5)


def bending(hinge):
    (leaf,) = hinge.leaves
    return hinge.material.effective_modulus * leaf.width * leaf.thickness**3 / 12


def closed_form(hinge, part):
    """tan(k l / 2) = 1 / (k a), k = sqrt(P / EI)."""
    half = 0.5 * hinge.length
    k = brentq(lambda k: np.cos(k * half) - k * part * np.sin(k * half), 1e-3, np.pi / hinge.length * (1 + 1e-9))
    return bending(hinge) * k * k


@pytest.mark.parametrize("part", [0.0, 0.01, 0.04, 0.33])
def test_leaf_between_equal_parts(part):
    hinge = leaf_spring(thickness=0.3e-3)
    assert buckling_load(hinge, part, part) == pytest.approx(closed_form(hinge, part), rel=1e-4)


def test_short_leaf_is_a_pin_with_a_spring():
    hinge = leaf_spring(length=1e-4, thickness=1e-6)
    pin = bending(hinge) / hinge.length
    assert buckling_load(hinge, 0.2, 0.2) == pytest.approx(4 * pin / 0.4, rel=1e-3)
    assert buckling_load(hinge, 0.1, 0.4) == pytest.approx(pin * 0.5 / (0.1 * 0.4), rel=1e-3)


@settings(max_examples=20, deadline=None)
@given(LENGTHS, LENGTHS, st.sampled_from(sorted(PRESETS)))
def test_turned_end_for_end(before, after, name):
    """All presets are symmetric end for end, but for the taper, which has to be turned too."""
    hinge = preset(name)
    (first, *_), tapered = hinge.leaves, symmetry_of(hinge) == "axis"
    swapped = tapered_leaf(thickness=first.end_thicknesses[1], end_thickness=first.thickness) if tapered else hinge
    assert buckling_load(hinge, before, after) == pytest.approx(buckling_load(swapped, after, before), rel=1e-6)


@settings(max_examples=20, deadline=None)
@given(st.floats(0, 0.3), st.floats(0.2, 5), st.floats(0.2, 5), st.sampled_from(["leaf-spring", "x-hinge", "tfch"]))
def test_scales_with_modulus_and_size(part, modulus, size, name):
    """P is a modulus times a length squared."""
    hinge = preset(name)
    sizes = ("length", "width", "thickness") if name == "leaf-spring" else ("length", "height", "width", "thickness")
    rest = {"length": 0.04, "height": 0.04, "width": 0.04, "thickness": 0.8e-3}
    other = PRESETS[name](**{key: size * rest[key] for key in sizes}).with_material(Material(modulus * 2.95e9))
    expected = modulus * size**2 * buckling_load(hinge, part, 0.1)
    assert buckling_load(other, size * part, size * 0.1) == pytest.approx(expected, rel=1e-6)


@settings(max_examples=20, deadline=None)
@given(LENGTHS, LENGTHS, st.floats(0.01, 0.2))
def test_a_longer_rod_buckles_sooner(before, after, more):
    assert buckling_load(leaf_spring(), before + more, after) < buckling_load(leaf_spring(), before, after)


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_converges_with_the_elements(name):
    """The elements' error falls with the fourth power of their length, and is below 1e-5 at 24; with the second where
    the thickness changes along a leaf, and is below 1e-3 at as many."""
    hinge = preset(name)
    profiled = any(leaf.profile for leaf in hinge.leaves)
    counts = (12 // PROFILED, 24 // PROFILED, 96 // PROFILED) if profiled else (12, 24, 96)
    loads = [buckling_load(hinge, 0.02, 0.05, elements) for elements in counts]
    errors = np.abs(np.array(loads[:2]) / loads[2] - 1)
    assert errors[1] < (1e-3 if profiled else 1e-5)
    assert errors[0] > (3.5 if profiled else 10) * errors[1]


def test_a_bent_hinge_and_bad_lengths_are_refused():
    one = Leaf("ground", (0.0, 0.0), "tip", (0.04, 0.01), 0.04, 0.8e-3)
    with pytest.raises(FlexureError, match="not symmetric about its axis"):
        buckling_load(Hinge("slanted", (one,), 0.04), 0.1, 0.1)
    for bad in (-0.1, np.nan, np.inf):
        with pytest.raises(FlexureError, match="before = "):
            buckling_load(leaf_spring(), bad, 0.1)


def test_pin_of_a_leaf_bent_by_moments():
    """K = EI / L about the middle: the leaf is an arc."""
    hinge = leaf_spring(width=0.02, thickness=1e-3, material=STEEL)
    pin = rod_pin(hinge, 0.33, 0.33, 0.3)
    assert pin.fraction == pytest.approx(0.5, abs=1e-9)
    assert pin.stiffness == pytest.approx(bending(hinge) / hinge.length, rel=1e-9)
    assert pin.moment_error < 1e-9
    # the arc's chord 2 sin(theta / 2) / theta against the two links' cos(theta / 2)
    gap = hinge.length * (np.sin(0.15) / 0.15 - np.cos(0.15))
    assert pin.tip_error == pytest.approx(gap, rel=0.02)


@pytest.mark.parametrize("name", ["leaf-spring", "x-hinge", "trls2", "tfch", "cross-spring"])
def test_pin_fitted_near_the_buckling_load_buckles_there(name):
    hinge = preset(name)
    load = buckling_load(hinge, 0.3, 0.3)
    free, pressed = rod_pin(hinge, 0.3, 0.3, 0.02), rod_pin(hinge, 0.3, 0.3, 0.02, 0.999 * load)
    assert abs(pressed.buckling_ratio - 1) < 2e-4 < 5e-3 < abs(free.buckling_ratio - 1)
    assert pressed.moment_error < 1e-3


def test_no_pin_stands_for_a_parallel_guide():
    assert rod_pin(parallel_guide(), 0.3, 0.3, 1e-4).buckling_ratio > 100


def test_pin_refuses():
    hinge = leaf_spring()
    for angle in (0.0, 1.6, np.nan):
        with pytest.raises(FlexureError, match="max_angle"):
            rod_pin(hinge, 0.1, 0.1, angle)
    limit = buckling_load(hinge, 0.1, 0.1)
    for load in (-1.0, limit, np.nan):
        with pytest.raises(FlexureError, match="compression"):
            rod_pin(hinge, 0.1, 0.1, 0.1, load)
    with pytest.raises(FlexureError, match=r"parallel-guide: .* lower max_angle"):
        rod_pin(parallel_guide(), 0.1, 0.1, 1.5)
