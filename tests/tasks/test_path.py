"""Paths: their shapes in closed form, a point that follows them, and the task."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tensegym import as_task
from tensegym.errors import InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.episode import Episode
from tensegym.tasks.path import SHAPES, Path, sampled

LEMNISCATE = 5.244115108584239  # length of Bernoulli's lemniscate of half width 1, 2 * lemniscate constant


class Point:
    def __init__(self, at) -> None:
        self.at = np.array([*at, 0.0])

    def centre_of_mass_in_world(self):
        return self.at.copy()


def walk(path: Path, point: Point, step: float, most: int = 5000) -> int:
    for count in range(1, most):
        point.at[:2] += step * path.bearing(point).direction
        path.update(point, 0.0, 0.4)
        if path.ended:
            return count
    raise AssertionError(f"came along {path.share:.0%} only")


@pytest.mark.parametrize(
    ("shape", "length"), [("line", 1.0), ("arc", math.pi / 2), ("triangle", 3.0), ("eight", LEMNISCATE / 2)]
)
def test_shapes_are_as_long_as_they_should_be_and_begin_along_x(shape, length):
    points = sampled(SHAPES[shape]())
    path = Path(points, 0.1, 0.05)
    assert path.length == pytest.approx(length, rel=2e-3)
    np.testing.assert_allclose(points[0], 0, atol=1e-12)
    first = points[1] - points[0]
    assert first[0] > 0.99 * np.linalg.norm(first)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_point_that_goes_by_the_bearing_follows_to_the_end(shape):
    path = Path(6 * sampled(SHAPES[shape]()), 1.0, 0.5)
    steps = walk(path, Point([0.0, 0.0]), 0.16)
    assert path.share == 1
    assert path.off < 0.25  # it cuts corners by looking ahead
    assert steps * 0.16 == pytest.approx(path.length, rel=0.2)


@given(st.floats(0.2, 2.0), st.floats(-3, 3))
def test_off_a_straight_line_is_the_distance_to_it(step, away):
    path = Path(sampled(np.array([[0.0, 0.0], [40.0, 0.0]])), 2.5, 0.5)
    point = Point([0.0, away])
    for _ in range(10):
        point.at[0] += step
        path.update(point, 0.0, 0.4)
    assert path.off == pytest.approx(abs(away), abs=0.011)  # points stand 0.02 apart


def test_at_a_crossing_it_goes_on_the_way_it_came():
    path = Path(6 * sampled(SHAPES["eight"]()), 0.5, 0.2)
    point, middle = Point([0.0, 0.0]), np.array([0.0, 3.0])
    shares = []
    for _ in range(1000):
        point.at[:2] += 0.1 * path.bearing(point).direction
        path.update(point, 0.0, 0.4)
        if np.linalg.norm(point.at[:2] - middle) < 0.15:
            shares.append(path.share)
        if path.ended:
            break
    assert path.ended
    assert min(shares) == pytest.approx(0.25, abs=0.05)
    assert max(shares) == pytest.approx(0.75, abs=0.05)


def test_the_path_begins_under_the_robot_towards_the_starts_direction():
    task = as_task({"motion": "path", "shape": "line", "size": 4.0})
    with TensegrityRobot(dt=task.dt) as robot:
        episode = Episode(robot, task, np.random.default_rng(0), {"direction": 0.7})
        np.testing.assert_allclose(episode.bearing.direction, [math.cos(0.7), math.sin(0.7)], atol=0.02)
        end = episode.goal.points[-1] - episode.goal.points[0]
        np.testing.assert_allclose(end, 4 * robot.design.length * np.array([math.cos(0.7), math.sin(0.7)]))
        episode.advance(robot.angles_of(np.ones(6)), 200)
        measured = task.measures(episode)
        assert measured["followed"] < 0.1
        assert measured["cross_track"] < 0.2


def test_an_environment_for_each_shape_and_a_path_of_ones_own():
    for table in ({"shape": "triangle"}, {"corners": [[0, 0], [2, 0], [2, 2]]}):
        env = gym.make("tensegym/SixRodRolling-v0", task={"motion": "path", **table}, observation="full-goal")
        env.reset(seed=0)
        info = env.step(np.ones(6))[4]
        assert set(info["measures"]) == {"cross_track", "followed", "path_speed"}
        env.close()


@pytest.mark.parametrize(
    ("corners", "words"),
    [
        ([[0, 0]], "two or more"),
        ([[0, 0], [0, 0], [1, 0]], "another one than the one before"),
        ([[0, 0], [2, 0], [2, 2], [0, 0]], "comes within 0.5 rod lengths of its own start again"),
        ([[0, 0], [2, 0], [2, 2], [0, 2], [0, -2]], "comes within 0.5 rod lengths of its own start again"),
        ([[0, 0], [0.1, 0]], "never leaves it"),
        ([[0, 0], [1, float("nan")]], "corners row 2"),
        ([[0, 0], [1, 2, 3]], "corners row 2"),
        ([[0, 0], [1e6, 0]], "within 1e4"),
        ("round", "corners"),
    ],
)
def test_corners_that_are_no_path_are_named(corners, words):
    with pytest.raises(InputError, match=words):
        as_task({"motion": "path", "corners": corners})
