"""The protocol of engines, on each of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.design.bodies import design_bodies
from tensegym.design.design import Payload, RobotDesign
from tensegym.engine import GROUND, Scene
from tensegym.errors import DesignError
from tensegym.physics.box import Box
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


def tilted(angle):
    """A box whose upper side goes through the origin and falls along x, and the turn of it."""
    turn = Rotation.from_euler("y", angle)
    return Box(tuple(turn.apply([0, 0, -0.1])), (3.0, 0.5, 0.1), tuple(turn.as_quat())), turn


def let_go(engine, body, angle, turn, height):
    """A body at rest on a tilted box, high over the ground; how fast it goes down after 0.3 s, and where it is above
    the box."""
    box, tilt = tilted(angle)
    ground = FLAT.holding([replace(box, centre=tuple(np.add(box.centre, [0, 0, 5])))])
    place = np.add(tilt.apply([0, 0, height]), [0, 0, 5])
    world = one(engine, body, np.array([*place, *(tilt * turn).as_quat()]), ground=ground)
    _, (velocity,) = fall(world, 300)
    down, normal = tilt.apply([1, 0, 0]), tilt.apply([0, 0, 1])
    over = float((world.read()[0][0, :3] - [0, 0, 5]) @ normal)
    others = {contact.other for _ in range(10) for contact in (fall(world, 1), world.contacts())[1]}
    world.close()
    return float(velocity @ down), over, others


@pytest.mark.parametrize("angle", [0.0, 0.2])
def test_a_ball_on_a_box_rests_or_rolls_down_it(engine, angle):
    """Where it does not slip it is slowed by its spin to 5/7 of what would slide without friction."""
    radius = BALL.link.shapes[0].size[0]
    speed, over, others = let_go(engine, BALL, angle, Rotation.identity(), radius)
    assert speed == pytest.approx(5 / 7 * GRAVITY * np.sin(angle) * 0.3, rel=0.01, abs=1e-6)
    assert over == pytest.approx(radius, abs=2e-4)
    assert others == {GROUND}


@pytest.mark.parametrize("angle", [0.3, 0.55])
def test_a_rod_along_a_box_stays_or_slides_by_coulombs_law(engine, angle):
    """It stays where tan a is below the friction, else it goes down at g (sin a - mu cos a)."""
    radius = max(shape.size[0] for shape in ROD.link.shapes if not shape.colour)
    lying = Rotation.from_euler("y", np.pi / 2)
    speed, over, others = let_go(engine, ROD, angle, lying, radius)
    pulled, held = GRAVITY * np.sin(angle) * 0.3, FRICTION * GRAVITY * np.cos(angle) * 0.3
    assert pulled - speed == pytest.approx(min(pulled, held), rel=0.02)
    assert over == pytest.approx(radius, abs=1e-3)  # MuJoCo lifts a little what slides
    assert others == {GROUND}


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
