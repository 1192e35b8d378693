"""The linearised robot against differences of what it linearises."""

import numpy as np
import pytest

from tensegym.design.design import Payload, RobotDesign, flexible_design
from tensegym.physics.geometry import spring_geometry
from tensegym.physics.model import new_out
from tensegym.physics.robot_arrays import mobility_at_rest, robot_model
from tensegym.physics.tangent import moved, tangent


def lengths_at(model, poses, angles):
    lengths = np.empty(len(model.spring_bodies))
    spring_geometry(model, poses, angles, new_out(model), lengths)
    return lengths


@pytest.mark.parametrize("design", [RobotDesign(payload=Payload()), flexible_design()], ids=lambda d: d.name)
def test_matrices_are_the_derivatives_of_lengths_and_of_the_tensions_work(design):
    """With constant tensions the work sum(T l) has the gradient J^T T and the second derivatives G."""
    model, rng = robot_model(design), np.random.default_rng(0)
    poses, angles = model.rest_poses, np.zeros(len(model.pin_bodies))
    tensions = rng.uniform(1, 20, len(model.spring_bodies))
    at = tangent(model, poses, angles, tensions)
    np.testing.assert_allclose(at.mass, at.mass.T, atol=1e-15)
    assert np.linalg.eigvalsh(at.mass)[0] > 0
    step = 1e-4
    for column in rng.choice(len(at.mass), 10, replace=False):
        ahead, back = (lengths_at(model, *moved(model, poses, angles, column, by)) for by in (step, -step))
        np.testing.assert_allclose(at.rates[:, column], (ahead - back) / (2 * step), atol=1e-6)
        here = lengths_at(model, poses, angles)
        curved = tensions @ (ahead - 2 * here + back) / step**2
        assert at.geometric[column, column] == pytest.approx(curved, rel=1e-4, abs=1e-3)


def test_mass_and_rates_give_the_mobility_of_the_substep():
    model = robot_model(flexible_design())
    at = tangent(model, model.rest_poses, np.zeros(len(model.pin_bodies)), np.zeros(len(model.spring_bodies)))
    np.testing.assert_allclose(
        at.rates @ np.linalg.solve(at.mass, at.rates.T), mobility_at_rest(model), rtol=1e-9, atol=1e-9
    )
