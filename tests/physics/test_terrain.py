"""Rough ground: its statistics, the robot on it against the engine's own contacts, and what is refused."""

import math

import numpy as np
import pytest

from tensegym.engine import GROUND
from tensegym.errors import DesignError, SimulationError
from tensegym.physics.terrain import FLAT, Ground, Terrain, distance_to_ground, distances_to_ground
from tensegym.robot.gait import GaitMeter
from tensegym.robot.robot import TensegrityRobot

ROUGH = Terrain(roughness=0.03, reach=4.0, seed=2)


@pytest.fixture(scope="module")
def settled():
    """A robot that was thrown off its clearing and has come to rest on the bumps."""
    with TensegrityRobot(dt=2e-3, ground=ROUGH) as robot:
        robot.push([2.0, 0.5, 2.0])
        robot.step(2000)
        yield robot


def test_bumps_have_the_height_and_the_length_asked_for():
    terrain = Terrain(roughness=0.03, correlation_length=0.4, reach=30.0)
    heights = terrain.heights(0.0)
    lag = round(terrain.correlation_length / terrain.cell)
    assert heights.std() == pytest.approx(0.03, rel=0.01)
    for axis in (0, 1):
        there = np.roll(heights, lag, axis=axis)
        assert (heights * there).mean() / heights.var() == pytest.approx(math.exp(-1), abs=0.03)


def test_bumps_come_from_their_seed_and_leave_a_clearing():
    heights = ROUGH.heights(0.5)
    np.testing.assert_array_equal(heights, ROUGH.heights(0.5))
    assert not np.array_equal(heights, Terrain(roughness=0.03, reach=4.0, seed=3).heights(0.5))
    angles = np.linspace(0, 2 * math.pi, 50)
    rim = 0.5 * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    np.testing.assert_array_equal(distances_to_ground(rim, Ground(heights, ROUGH.cell)), 0)


def test_distance_to_a_tilted_plane():
    """Heights 0.3 x + 0.4 y + 0.01: the distance is along the normal (-0.3, -0.4, 1) / sqrt(1.25)."""
    x = np.arange(-5, 6) * 0.1
    ground = Ground(0.3 * x[:, None] + 0.4 * x + 0.01, 0.1)
    for point in np.random.default_rng(0).uniform(-0.5, 0.5, (20, 3)):
        expected = (point[2] - 0.3 * point[0] - 0.4 * point[1] - 0.01) / math.sqrt(1.25)
        assert distance_to_ground(point, ground) == pytest.approx(expected, abs=1e-12)
    assert math.isnan(distance_to_ground(np.array([0.51, 0.0, 0.0]), ground))


def test_a_table_of_zeros_counts_feet_as_the_plane_does():
    accounts = []
    for ground in (FLAT, Ground(np.zeros((81, 81)), 0.1)):
        with TensegrityRobot(dt=2e-3) as robot:
            robot._ground = ground  # to the engine it is a plane, so that only the lookup differs
            robot.push([1.0, 0, 0])
            robot.step(250)
            accounts.append(robot.totals())
    assert accounts[0] == accounts[1]
    assert accounts[0].foot_path > 0


def test_a_robot_at_rest_on_bumps_stays_and_does_not_slip(settled):
    meter, account = GaitMeter(settled, np.array([1.0, 0.0])), settled.totals()
    begin = settled.node_positions_in_world()
    for _ in range(10):
        settled.step(50)
        meter.update()
    assert np.ptp(begin[settled.foot_contacts() > 0, 2]) > 0.01  # on bumps, not on the clearing
    assert np.abs(settled.node_positions_in_world() - begin).max() < 1e-3
    assert settled.totals().foot_path - account.foot_path < 1e-3
    assert meter.tips == 0
    assert meter.metrics().audit_passed


def test_foot_contacts_are_those_of_the_engine(settled):
    world, feet = settled.world, settled.node_positions_in_world()
    loaded = np.zeros(len(feet))
    for contact in world.contacts():
        if contact.other != GROUND or contact.push <= 0:
            continue
        assert abs(settled.heights_of(contact.place[None])[0]) < 1e-4
        near = np.linalg.norm(feet - contact.place, axis=1)
        assert near.min() < 1.1 * settled.model.foot_radii[0]
        loaded[near.argmin()] = 1.0
    assert loaded.sum() >= 3
    np.testing.assert_array_equal(settled.foot_contacts(), loaded)


@pytest.mark.parametrize("seed", [0, 1])
def test_no_contact_hides_another(seed):
    """With the engine's own merging of contacts feet sink in near the edges of triangles, and stay under the ground."""
    rng, least = np.random.default_rng(seed), math.inf
    with TensegrityRobot(dt=2e-3, ground=ROUGH) as robot:
        robot.reset(seed)
        for _ in range(100):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            robot.step(20)
            heights = robot.heights_of(robot.node_positions_in_world())
            least = min(least, heights.min())
        assert least > 0.5 * robot.model.foot_radii[0]


def test_rough_ground_leaves_other_worlds_as_they_are():
    """The engine has one contact setting a process, which rough ground changes while it steps."""

    def slide():
        with TensegrityRobot(dt=2e-3) as robot:
            robot.push([0.5, 0, 2.5])  # down again at 5 mm a step
            robot.step(350)
            return robot.poses_in_world.copy()

    alone = slide()
    with TensegrityRobot(dt=2e-3, ground=ROUGH) as rough:
        rough.step(10)
        np.testing.assert_array_equal(slide(), alone)


def test_a_robot_over_the_edge_or_under_the_ground_is_an_error():
    with TensegrityRobot(dt=2e-3, ground=Terrain(reach=1.0)) as robot:
        robot.push([4.0, 0, 2.0])
        with pytest.raises(SimulationError, match="over the edge of the ground"):
            robot.step(300)
        robot.reset(0)
        poses = robot.poses_in_world.copy()
        poses[:, 2] -= 0.1
        robot.world.place(poses, np.zeros((len(poses), 6)))
        with pytest.raises(SimulationError, match=r"foot \d+ went through the ground by t = 0.002 s"):
            robot.step()


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"roughness": 0.0}, r"Terrain.roughness = 0.0 is outside \(0, 0.2\] m"),
        ({"correlation_length": 9.0}, r"Terrain.correlation_length = 9.0 is outside"),
        ({"reach": 80.0}, r"Terrain.reach = 80.0 is over 75 m"),
    ],
)
def test_bad_terrain_is_refused(fields, words):
    with pytest.raises(DesignError, match=words):
        Terrain(**fields)
