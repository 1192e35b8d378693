"""MuJoCo as the engine of a whole robot."""

import sys

import numpy as np
import pytest

from tensegym.design.design import Payload, RobotDesign, flexible_design
from tensegym.errors import DesignError, SimulationError
from tensegym.mujoco import c_interface
from tensegym.physics.terrain import Terrain
from tensegym.robot.rendering import render
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation.flight import free_flight

DESIGNS = pytest.mark.parametrize("design", [RobotDesign(), flexible_design()], ids=["rigid", "split rods"])


def roll(design, dt, compiled):
    rng = np.random.default_rng(1)
    with TensegrityRobot(design, dt=dt, compiled=compiled, engine="mujoco") as robot:
        robot.reset(0, 0.3)
        for _ in range(10):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            robot.step(100)
        return robot.poses_in_world.copy(), robot.tensions.copy(), robot.drives.copy(), robot.flexure_angles


@pytest.mark.skipif(not c_interface.AVAILABLE, reason="MuJoCo's library is not found")
@DESIGNS
def test_both_loops_give_the_same_bits(design):
    first, again, python = (roll(design, 1e-3, compiled) for compiled in (True, True, False))
    for ours, once_more, reference in zip(first, again, python, strict=True):
        np.testing.assert_array_equal(ours, reference)
        np.testing.assert_array_equal(ours, once_more)


@DESIGNS
@pytest.mark.parametrize("dt", [1e-3, 4e-3])
def test_free_flight_keeps_momentum_to_rounding(design, dt):
    """MuJoCo's own Euler does not, nor does its implicitfast: the leapfrog's torques do."""
    seen = free_flight(dt, seconds=1.0, design=design.with_(spin_damping=0.0), engine="mujoco")
    assert max(seen.linear_drift, seen.angular_drift) < 1e-10


@DESIGNS
@pytest.mark.parametrize("dt", [1e-3, 2e-3])
def test_a_robot_at_rest_stands_as_in_pybullet(design, dt):
    heights, weights = [], []
    for engine in ("pybullet", "mujoco"):
        with TensegrityRobot(design, dt=dt, engine=engine) as robot:
            robot.reset(0)
            robot.step(round(3 / dt))
            heights.append(robot.centre_of_mass_in_world()[2])
            weights.append(sum(contact.push * contact.normal[2] for contact in robot.world.contacts()))
            assert sorted(robot.foot_contacts().nonzero()[0]) == sorted(robot.faces.triangles[0])
    assert heights[1] == pytest.approx(heights[0], abs=2e-4)
    np.testing.assert_allclose(weights, design.mass * design.gravity, rtol=0.05)


def test_feet_stand_on_the_bumps_that_pybullet_has():
    with TensegrityRobot(dt=2e-3, ground=Terrain(roughness=0.03, reach=4.0, seed=2), engine="mujoco") as robot:
        robot.push([2.0, 0.5, 2.0])
        robot.step(1500)
        feet = robot.node_positions_in_world()[robot.foot_contacts() > 0]
        assert len(feet) >= 3
        assert np.ptp(feet[:, 2]) > 0.01
        np.testing.assert_allclose(robot.heights_of(feet), robot.model.foot_radii[0], atol=5e-4)
        places = np.array([contact.place for contact in robot.world.contacts()])
        assert np.abs(robot.heights_of(places)).max() < 5e-4


def test_a_reset_forgets_what_was_before():
    with TensegrityRobot(RobotDesign(payload=Payload()), engine="mujoco") as robot:
        seen = []
        for push in (0.0, 3.0, 0.0):
            robot.reset(2, 0.5)
            robot.push([push, 0, push])
            robot.step(200)
            seen.append(robot.poses_in_world.copy())
    np.testing.assert_array_equal(seen[0], seen[2])
    assert np.abs(seen[0] - seen[1]).max() > 0.1


def test_what_diverges_is_an_error_and_leaves_no_file(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    with TensegrityRobot(engine="mujoco") as robot:
        robot.push([1e12, 0, 0])
        with pytest.raises(SimulationError, match="diverged"):
            robot.step(10)
        robot.reset(0)
        robot.step(10)
        assert np.isfinite(robot.poses_in_world).all()
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr().err == ""


def test_a_closed_world_is_an_error():
    robot = TensegrityRobot(engine="mujoco")
    robot.close()
    with pytest.raises(SimulationError, match="closed"):
        robot.step()
    robot.close()


def test_pictures_are_of_where_the_bodies_are():
    with TensegrityRobot(flexible_design(), engine="mujoco") as robot, TensegrityRobot(flexible_design()) as other:
        apart = np.abs(render(robot).astype(int) - render(other))
        assert (apart > 1).mean() < 1e-3  # but for pixels that the last bit decides
        robot.push([5.0, 0, 0])
        before = render(robot)
        robot.step(20)
        assert (render(robot) != before).any()


def test_a_window_is_refused():
    with pytest.raises(DesignError, match="engine 'mujoco' has no window"):
        TensegrityRobot(engine="mujoco", gui=True)


def test_without_mujoco_one_line_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    monkeypatch.delitem(sys.modules, "tensegym.mujoco.world", raising=False)
    monkeypatch.delitem(sys.modules, "tensegym.mujoco.c_interface", raising=False)
    with pytest.raises(SimulationError, match=r"not installed; it comes with the extra mujoco"):
        TensegrityRobot(engine="mujoco")
