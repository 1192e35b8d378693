"""The element: gradient, Hessian, rigid motion."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.flexure.fem import beam

SIZE = (0.01, 0.8, 0.6, 9e4, 5e-3)  # l0, direction at rest, EA, EI


def _all(q):
    out = np.zeros(20)
    eps = beam.strain(*q, *SIZE[:3])[5]
    beam.element(*q, *SIZE, SIZE[3] * eps, out)
    xx, xy, yy, x1, y1, x2, y2, k11, k12, k22 = out[4:14]
    return out[:4].copy(), np.array([[xx, xy, x1, x2], [xy, yy, y1, y2], [x1, y1, k11, k12], [x2, y2, k12, k22]]), out


STATE = st.tuples(*(st.floats(-0.4, 0.4) for _ in range(4)))


@given(STATE)
@settings(max_examples=30, deadline=None)
def test_gradient_and_hessian_are_the_energys(change):
    q = np.array([0.008, 0.006, 0, 0]) * [1 + change[0], 1 + change[1], 1, 1] + [0, 0, change[2], change[3]]
    step = np.array([1e-8, 1e-8, 1e-6, 1e-6])
    gradient, hessian, _ = _all(q)
    for i in range(4):
        up, down = q + step * np.eye(4)[i], q - step * np.eye(4)[i]
        slope = (beam.energy(*up, *SIZE) - beam.energy(*down, *SIZE)) / (2 * step[i])
        assert slope == pytest.approx(gradient[i], rel=1e-5, abs=1e-5 * np.abs(gradient).max() + 1e-6)
        row = (_all(up)[0] - _all(down)[0]) / (2 * step[i])
        np.testing.assert_allclose(row, hessian[i], rtol=1e-5, atol=2e-6 * np.abs(hessian[i]).max())


@given(st.floats(-7, 7))
def test_rigid_turn_stores_nothing(angle):
    c, s = np.cos(angle), np.sin(angle)
    x, y = 0.008, 0.006
    assert beam.energy(c * x - s * y, s * x + c * y, angle, angle, *SIZE) == pytest.approx(0, abs=1e-18)


def test_gradient_of_the_strain_matches():
    q = np.array([0.0081, 0.0058, 0.1, -0.05])
    out = _all(q)[2]
    step = np.array([1e-8, 1e-8, 1e-6, 1e-6])
    for i in range(4):
        up = beam.strain(*(q + step * np.eye(4)[i]), *SIZE[:3])[5]
        down = beam.strain(*(q - step * np.eye(4)[i]), *SIZE[:3])[5]
        assert (up - down) / (2 * step[i]) == pytest.approx(out[14 + i], rel=1e-6)
