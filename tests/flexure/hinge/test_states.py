"""States: shapes and gaps."""

import numpy as np
import pytest

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States, join


def _states(n):
    return States(np.zeros(n), np.zeros((n, 2)), np.zeros((n, 2)), np.zeros(n))


def test_wrong_shape_names_the_field():
    with pytest.raises(FlexureError, match=r"force has shape \(3,\)"):
        States(np.zeros(3), np.zeros((3, 2)), np.zeros(3), np.zeros(3))


def test_angle_must_be_finite_but_a_moment_may_be_missing():
    with pytest.raises(FlexureError, match="theta of state 1"):
        States(np.array([0, np.nan]), np.zeros((2, 2)), np.zeros((2, 2)), np.zeros(2))
    states = States(np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2)), np.array([0, np.nan]))
    assert len(states.whole()) == 1


def test_join_and_pick():
    assert len(join([_states(2), _states(3)]).pick(slice(1, 4))) == 3
