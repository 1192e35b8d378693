"""Rotations of prisms: the group that their closed form has, each element once."""

import warnings

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tensegym.design.design_file import design_from_dict
from tensegym.design.symmetry import symmetries


@settings(max_examples=15, deadline=None)
@given(st.integers(3, 6), st.floats(0.1, 0.25), st.floats(0.1, 0.25))
@example(3, 0.12, 0.22)
def test_a_prism_has_turns_about_its_axis_and_half_turns_across_it_each_once(rods, radius, height):
    prism = {"builder": "prism", "rods": rods, "radius": radius, "height": height, "wound": "around"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = symmetries(design_from_dict({"structure": prism}))
    assert len({tuple(each.nodes.tolist()) for each in found}) == len(found) == 2 * rods
    assert found[0].nodes.tolist() == list(range(2 * rods))
    along = np.array([each.rotation[2, 2] for each in found])
    assert sorted(along.round(9).tolist()) == [-1.0] * rods + [1.0] * rods
    assert [np.linalg.det(each.rotation) for each in found] == pytest.approx([1.0] * len(found))
