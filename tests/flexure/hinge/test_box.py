"""Boxes of loads: two ends an axis, what they hold, and the axial force that a certificate has to bear."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box

ENDS = st.tuples(st.floats(-50, 50), st.floats(0.1, 50)).map(lambda pair: (pair[0], pair[0] + pair[1]))


def test_without_ends_a_box_is_symmetric():
    box = Box(0.5, 2.0)
    assert box.symmetric and box.ends.tolist() == [[-2, 2], [-2, 2]]
    assert box.told() == "+-2 N on each axis"
    assert box == Box(0.5, 2.0, None, None)


def test_a_pivot_that_is_only_pulled():
    box = Box(0.5, 2.0, force_x=(0, 40))
    assert box.centre.tolist() == [20, 0] and box.half.tolist() == [20, 2]
    assert box.holds(np.array([[0, 0], [40, 2], [-1, 0], [41, 0], [3, -2.1]])).tolist() == [1, 1, 0, 0, 0]
    assert box.told() == "Fx in [0, 40] N and Fy in [-2, 2] N"


@given(ENDS, ENDS, st.floats(0.01, 1.5))
def test_axial_ends_are_those_of_the_box(x, y, angle):
    """cos(theta / 2) Fx + sin(theta / 2) Fy of many samples never passes them, and comes near."""
    box = Box(angle, 1.0, x, y)
    low, high = box.axial
    turn = np.linspace(-angle / 2, angle / 2, 101)
    corners = np.array([[a, b] for a in x for b in y])
    along = np.outer(np.cos(turn), corners[:, 0]) + np.outer(np.sin(turn), corners[:, 1])
    size = np.abs(corners).max()
    assert along.min() == pytest.approx(low, abs=1e-3 * size) and along.min() >= low - 1e-9 * size
    assert along.max() == pytest.approx(high, abs=1e-3 * size) and along.max() <= high + 1e-9 * size


@given(st.floats(0.1, 50), st.floats(0.01, 1.5))
def test_ends_that_are_symmetric_are_the_same_box(force, angle):
    given_ends = Box(angle, 99.0, (-force, force), (-force, force)).axial
    assert given_ends == pytest.approx(Box(angle, force).axial, rel=1e-12)


@pytest.mark.parametrize(("ends", "words"), [
    ((40, 0), r"force_y = \(40, 0\) N: the ends are swapped; give the least force and then a larger one"),
    ((3, 3), "they leave no range"),
    ((0, np.inf), "force_y = .* give 2 finite values"),
    ((0, 1, 2), "force_y = .* give 2 finite values"),
    (("a", 1), "force_y = .* does not hold numbers"),
])  # fmt: skip
def test_refused(ends, words):
    with pytest.raises(FlexureError, match=words):
        Box(0.5, 2.0, force_y=ends)
