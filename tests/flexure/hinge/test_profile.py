"""Profiles of leaves: their thickness, and what a mirror image does to it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tensegym.flexure.hinge import GROUND, TIP, Hinge, Leaf, Notch, Taper, symmetry_of
from tensegym.flexure.hinge.presets import notch_hinge


def leaf(profile, swapped=False):
    ends = (GROUND, (0.0, 0.0), TIP, (0.04, 0.0))
    return Leaf(*(ends[2:] + ends[:2] if swapped else ends), 0.04, 0.8e-3, profile)


def test_circle():
    """Two circles of radius r whose nearest points are the web apart: t = web + 2 r - 2 sqrt(r^2 - x^2)."""
    hinge = notch_hinge(length=0.01, thickness=0.5e-3)
    x = np.linspace(-0.005, 0.005, 41)
    wanted = 0.5e-3 + 2 * 0.005 - 2 * np.sqrt(0.005**2 - x**2)
    assert hinge.leaves[0].thickness_at(0.5 + x / 0.01) == pytest.approx(wanted, rel=1e-9)


@given(st.floats(1e-4, 0.02), st.floats(1e-4, 0.05), st.floats(0, 1))
def test_notches_are_webs_with_wider_ends(along, across, share):
    notched = leaf(Notch(along, across))
    here, mirrored = notched.thickness_at(np.array([share, 1 - share]))
    assert here == pytest.approx(mirrored, rel=1e-6)
    assert 0.8e-3 <= here <= notched.end_thicknesses[0]
    assert notched.thickness_at(np.array([0.0, 1.0])) == pytest.approx(notched.end_thicknesses, rel=1e-9)
    assert notched.thinnest == notched.thickness_at(np.array([0.5]))[0]


def test_tapers():
    tapered = leaf(Taper(0.2e-3))
    assert tapered.thickness_at(np.array([0, 0.5, 1])) == pytest.approx([0.8e-3, 0.5e-3, 0.2e-3])
    assert tapered.thinnest == pytest.approx(0.2e-3)


def test_a_taper_has_a_direction():
    """The same two leaves, one drawn from the tip to the ground, are symmetric end to end only as a pair."""
    assert symmetry_of(Hinge("h", (leaf(Taper(0.2e-3)),), 0.04)) == "axis"
    assert symmetry_of(Hinge("h", (leaf(Taper(0.2e-3)), leaf(Taper(0.2e-3), swapped=True)), 0.04)) == "both"
    assert symmetry_of(Hinge("h", (leaf(Notch(1e-3, 1e-3)), leaf(None)), 0.04)) == "both"
