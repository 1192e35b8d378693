"""Boxes: how far a point is from one, and a robot's feet beside the engine's own contacts on one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tensegym.engine import GROUND
from tensegym.errors import DesignError, SimulationError
from tensegym.physics.box import Box, box_rows, boxes_of, distance_to_box
from tensegym.physics.terrain import FLAT, distance_to_ground
from tensegym.robot.robot import TensegrityRobot

PLATFORM = Box.between((-3, -3, -0.5), (3, 3, 0.2))


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10**6), st.floats(0.05, 4.0))
def test_the_distance_is_that_of_the_box_turned_back(seed, size):
    rng = np.random.default_rng(seed)
    turn, centre, half = Rotation.random(random_state=rng), rng.uniform(-1, 1, 3), size * rng.uniform(0.1, 1, 3)
    box = Box(tuple(centre), tuple(half), tuple(turn.as_quat()))
    point = rng.uniform(-2, 2, 3)
    beyond = np.abs(turn.inv().apply(point - centre)) - half
    expected = beyond.max() if beyond.max() <= 0 else np.linalg.norm(np.maximum(beyond, 0))
    (row,) = box_rows([box])
    assert distance_to_box(point, row, np.inf) == pytest.approx(expected, abs=1e-9)
    near = min(expected, point[2])
    assert distance_to_ground(point, FLAT.holding([box])) == pytest.approx(near, abs=1e-9)


def test_boxes_come_back_from_their_rows():
    boxes = (Box((1, 2, 3), (0.1, 0.2, 0.3), (0, 0.6, 0, 0.8)), PLATFORM)
    assert boxes_of(box_rows(boxes)) == boxes
    assert FLAT.obstacles == ()


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_a_robot_on_a_box_stands_on_its_feet_as_on_the_ground(engine):
    """It was dropped there: contacts are the engine's, and neither its feet nor its heights know a difference."""
    with TensegrityRobot(dt=2e-3, ground=FLAT.holding([PLATFORM]), engine=engine) as robot:
        robot.reset(0, height=0.21)
        robot.step(800)
        feet, loaded = robot.node_positions_in_world(), np.zeros(12)
        for contact in robot.world.contacts():
            assert contact.other == GROUND
            assert contact.place[2] == pytest.approx(0.2, abs=1e-3)
            loaded[np.linalg.norm(feet - contact.place, axis=1).argmin()] += contact.push
        np.testing.assert_array_equal(robot.foot_contacts(), loaded > 0.1)
        assert loaded.sum() == pytest.approx(robot.design.mass * robot.design.gravity, rel=0.05)
        assert robot.level(feet) == pytest.approx(0.2, abs=1e-3)
        before = robot.totals()
        robot.push([0.3, 0, 0])
        robot.step(20)
        assert robot.totals().foot_path > before.foot_path  # they slip, and it is seen


def test_a_foot_in_a_box_is_an_error():
    with TensegrityRobot(dt=2e-3, ground=FLAT.holding([PLATFORM])) as robot, pytest.raises(
        SimulationError, match=r"foot \d+ went through the ground"
    ):
        robot.step()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (((0, 0, 0), (0.1, 0.0, 0.1)), r"Box.half\[2\] = 0.0 is outside \[0.001, 10000\] m"),
        (((0, 0), (0.1, 0.1, 0.1)), r"Box.centre = .* must be a list of 3"),
        (((0, 0, float("nan")), (0.1, 0.1, 0.1)), r"Box.centre\[3\]"),
        (((0, 0, 0), (0.1, 0.1, 0.1), (0, 0, 0, 0.5)), "Box.turn = .* is no unit quaternion"),
    ],
)
def test_what_is_no_box_is_refused(arguments, words):
    with pytest.raises(DesignError, match=words):
        Box(*arguments)
