import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.design.design import ElasticCable, RobotDesign, paper_design
from tensegym.errors import DesignError
from tensegym.physics import cable_law as kernel
from tensegym.physics.geometry import spring_geometry
from tensegym.physics.model import DAMPING, STIFFNESS, new_out
from tensegym.physics.robot_arrays import explicit_step_limit, mobility_at_rest, robot_model
from tensegym.robot.robot import TensegrityRobot

finite = st.floats(-3, 3)


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(0.1, 2), finite, st.floats(0.1, 2)), min_size=1, max_size=20))
def test_explicit_tension_is_never_negative_and_zero_when_slack(cables):
    lengths, rates, natural = (np.array(column) for column in zip(*cables, strict=True))
    params = np.zeros((len(cables), 9))
    params[:, STIFFNESS], params[:, DAMPING] = 300, 5
    tensions = np.full(len(cables), np.nan)
    kernel.explicit_tensions(params, lengths, rates, natural, tensions)
    assert (tensions >= 0).all()
    assert (tensions[lengths <= natural] == 0).all()
    law = 300 * (lengths - natural) + 5 * rates
    taut = (lengths > natural) & (law > 0)
    np.testing.assert_array_equal(tensions[taut], law[taut])


def test_implicit_tensions_solve_the_complementarity_problem():
    design = RobotDesign()
    arrays = robot_model(design)
    rng = np.random.default_rng(0)
    count, dt = len(arrays.spring_bodies), 2e-3
    out, lengths = new_out(arrays), np.empty(count)
    spring_geometry(arrays, arrays.rest_poses, np.zeros(0), out, lengths)
    natural = arrays.rest_lengths + rng.normal(0, 0.02, count)
    rates = rng.normal(0, 0.3, count)
    tensions = np.zeros(count)
    kernel.implicit_tensions(arrays, out, lengths, rates, natural, dt, tensions)
    mobility = mobility_at_rest(arrays)
    k, c = arrays.spring_params[:, STIFFNESS], arrays.spring_params[:, DAMPING]
    stretch_after = lengths + dt * rates - natural
    # tension of the law at the end of the step, were these tensions to act during it
    end_rates = rates - dt * mobility @ tensions
    law = k * (lengths + dt * end_rates - natural) + c * end_rates
    active = stretch_after > 0
    assert 0 < active.sum() < count
    scale = tensions.max()
    assert (tensions >= 0).all()
    assert (tensions[~active] == 0).all()
    pulling = active & (tensions > 0)
    np.testing.assert_allclose(tensions[pulling], law[pulling], atol=2e-3 * scale)
    assert (law[active & (tensions == 0)] <= 2e-3 * scale).all()


def test_mobility_is_the_effect_of_tensions_on_length_rates():
    """A = J M^-1 J^T against finite differences of the lengths."""
    arrays = robot_model(RobotDesign())
    poses, count = arrays.rest_poses, len(arrays.spring_bodies)

    def lengths_at(changed):
        out, lengths = new_out(arrays), np.empty(count)
        spring_geometry(arrays, changed, np.zeros(0), out, lengths)
        return out.moment_arms, out.directions, lengths

    turns, directions, lengths = lengths_at(poses)
    mobility = mobility_at_rest(arrays)
    np.testing.assert_allclose(mobility, mobility.T)
    assert np.linalg.eigvalsh(mobility)[0] > -1e-9

    from scipy.spatial.transform import Rotation

    cable, step = 7, 1e-7
    moved = poses.copy()
    for side, sign in ((0, 1), (1, -1)):
        body = arrays.spring_bodies[cable, side]
        force = sign * directions[cable]
        moved[body, :3] += step * force / arrays.masses[body]
        turn = Rotation.from_quat(poses[body, 3:])
        torque = turn.inv().apply(-turns[cable, side])
        rotated = Rotation.from_rotvec(step * turn.apply(torque / arrays.inertias[body])) * turn
        moved[body, 3:] = rotated.as_quat()
    change = (lengths_at(moved)[2] - lengths) / step
    np.testing.assert_allclose(-change, mobility[:, cable], atol=1e-4 * np.abs(mobility).max())


def test_step_limit_separates_stable_from_unstable():
    limit = explicit_step_limit(robot_model(RobotDesign()))
    assert 1e-3 < limit < 2.07e-3
    assert explicit_step_limit(robot_model(paper_design())) < 0.242e-3
    with pytest.raises(DesignError, match="over the explicit limit"):
        TensegrityRobot(dt=2e-3, integrator="explicit")


@pytest.mark.parametrize("dt", [5e-4, 1e-3])
def test_implicit_and_explicit_agree_as_the_step_shrinks(dt):
    """Same short pull by both; the difference is first order in the step."""

    def final(step, integrator):
        with TensegrityRobot(RobotDesign(), dt=step, integrator=integrator, ground=False) as robot:
            robot.command(0.2 * robot.command_limit)
            robot.step(round(0.2 / step))
            return robot.poses_in_world[:, :3].copy()

    coarse = np.abs(final(dt, "implicit") - final(dt, "explicit")).max()
    fine = np.abs(final(dt / 2, "implicit") - final(dt / 2, "explicit")).max()
    assert coarse < 2e-3
    assert 1.5 < coarse / fine < 3


def test_papers_damping_needs_the_implicit_solve_and_holds_with_it():
    with TensegrityRobot(paper_design(), dt=1e-3) as robot:
        assert robot.implicit
        robot.step(1000)
        assert np.abs(robot.rates).max() < 0.1
    with TensegrityRobot(RobotDesign(elastic_cable=ElasticCable(damping=150.0)), dt=1e-3) as robot:
        assert robot.implicit
        robot.step(500)
        assert robot.tensions[:24].min() > 5
