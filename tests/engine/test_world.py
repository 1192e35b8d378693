"""The protocol of engines, on each of them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.design.bodies import design_bodies
from tensegym.design.design import Payload, RobotDesign
from tensegym.engine import GROUND, Scene
from tensegym.errors import DesignError
from tensegym.physics.terrain import FLAT
from tensegym.robot.engines import ENGINES, open_world

BALL = design_bodies(RobotDesign(payload=Payload()))[-1]
ROD = design_bodies(RobotDesign())[0]
FRICTION, GRAVITY, DT = 0.5, 9.81, 1e-3
STILL = np.zeros(6)
pytestmark = pytest.mark.parametrize("engine", ENGINES)


def one(engine, body, pose, velocity=STILL, ground=FLAT):
    """A world with one body in it, placed."""
    pose = np.array([*pose, 0, 0, 0, 1.0]) if len(pose) == 3 else pose
    scene = Scene((body,), np.array([[0, 0, 10, 0, 0, 0, 1.0]]), DT, FRICTION, GRAVITY if ground else 0.0, ground)
    world = open_world(engine, scene)
    world.restart(pose[None], np.asarray(velocity)[None], np.zeros(0))
    return world


def test_a_push_and_a_moment_are_taken_in_world_axes(engine):
    turn = Rotation.from_rotvec([0.3, -0.8, 0.4])
    world = one(engine, BALL, np.array([1, 2, 3, *turn.as_quat()]), ground=None)
    world.read()
    force, moment = np.array([0.3, -0.2, 0.5]), np.array([0.01, 0.03, -0.02])
    world.step(np.array([[*force, *moment]]))
    pose = world.read()[0][0]
    link = BALL.link
    np.testing.assert_allclose((pose[:3] - [1, 2, 3]) / DT**2, force / link.mass, rtol=1e-6)
    turned = (Rotation.from_quat(pose[3:]) * turn.inv()).as_rotvec()
    np.testing.assert_allclose(turned / DT**2, moment / link.inertia[0], rtol=1e-5)
    world.close()


def test_gravity_can_point_anywhere_and_a_push_adds_velocity(engine):
    world = one(engine, BALL, (0, 0, 5))
    world.set_gravity([1.0, -2.0, 0.5])
    world.push([3.0, 0, 0])
    world.read()
    world.step(np.zeros((1, 6)))
    np.testing.assert_allclose(world.read()[0][0, :3], [3e-3 + 1e-6, -2e-6, 5 + 0.5e-6], atol=1e-12)
    world.close()


def fall(world, steps):
    """Step without forces; what there was before the last step, and speeds in it."""
    for _ in range(steps):
        before = world.read()[0].copy()
        world.step(np.zeros((len(world.poses), 6)))
    return before, (world.read()[0] - before)[:, :3] / DT


def test_the_ground_pushes_a_ball_at_rest_up_and_a_sliding_one_back(engine):
    radius, weight = BALL.link.shapes[0].size[0], BALL.link.mass * GRAVITY
    world = one(engine, BALL, (0.3, 0, radius))
    fall(world, 500)
    world.push([0, 0.02, 0])
    (pose,), _ = fall(world, 1)
    (contact,) = world.contacts()
    assert (contact.link, contact.other) == (0, GROUND)
    np.testing.assert_allclose(contact.normal, [0, 0, 1], atol=1e-9)
    np.testing.assert_allclose(contact.place, [*pose[:2], 0], atol=1e-6)
    assert contact.push == pytest.approx(weight, rel=0.25)
    assert contact.friction[1] < -0.5 * FRICTION * weight
    np.testing.assert_allclose(contact.friction[[0, 2]], 0, atol=1e-6 * weight)
    world.close()


def test_a_sliding_ball_is_slowed_by_coulombs_force_until_it_rolls(engine):
    """Its speed is v - mu g t until friction has brought it to 5/7 v, whatever mu is."""
    world = one(engine, BALL, (0, 0, BALL.link.shapes[0].size[0]), [0, 2.0, 0, 0, 0, 0])
    _, ((_, sliding, _),) = fall(world, 80)
    assert sliding == pytest.approx(2.0 - 0.08 * FRICTION * GRAVITY, rel=0.08)
    _, ((_, rolling, _),) = fall(world, 320)
    assert rolling == pytest.approx(5 / 7 * 2.0, rel=2e-3)
    world.close()


def test_bodies_touch_one_another(engine):
    radius = BALL.link.shapes[0].size[0]
    poses = np.array([[0, 0, 5, 0, 0, 0, 1.0], [0, 0, 5 + 1.99 * radius, 0, 0, 0, 1.0]])
    scene = Scene((BALL, BALL), poses + [0, 0, 5, 0, 0, 0, 0] * np.array([[1], [2]]), DT, FRICTION)
    world = open_world(engine, scene)
    world.restart(poses, np.zeros((2, 6)), np.zeros(0))
    world.read()
    world.step(np.zeros((2, 6)))
    (contact,) = world.contacts()
    assert {contact.link, contact.other} == {0, 1}
    assert contact.push > 0
    np.testing.assert_allclose(contact.normal, [0, 0, 1 if contact.link == 1 else -1], atol=1e-9)
    world.close()


def test_what_is_restored_goes_on_in_the_same_bits(engine):
    world = one(engine, ROD, (0, 0, 0.02), [0.3, 0, 0, 0, 2.0, 1.0])

    def go_on():
        for _ in range(200):
            world.read()
            world.step(np.zeros((1, 6)))
        return world.read()[0].copy()

    go_on()
    kept = world.save()
    after = go_on()
    go_on()
    world.restore(kept)
    np.testing.assert_array_equal(go_on(), after)
    world.close()


def test_an_engine_that_is_none_is_refused(engine):
    with pytest.raises(DesignError, match=rf"engine = 'bulet' is not one of .*{engine}"):
        open_world("bulet", Scene((), np.zeros((0, 7)), DT, FRICTION))
