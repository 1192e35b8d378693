"""Courses: where obstacles lie, what passes them, and what is refused."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest

from tensegym import as_task
from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError, TensegymError
from tensegym.physics.terrain import distances_to_ground
from tensegym.tasks.course import Course
from tensegym.tasks.episode import Episode
from tensegym.tasks.lane import Lane
from tensegym.tasks.obstacles import OBSTACLES

DESIGN = RobotDesign()
L = DESIGN.length


def heights(course: Course, xs, y: float = 0.0):
    """Of the ground with all that stands on it, at x, y [m], to 1 mm: where a falling point first touches."""
    ground, top = course.ground(DESIGN), []
    for x in xs:
        column = np.array([[x, y, z] for z in np.arange(1.5, -0.2, -1e-3)])
        top.append(column[int((distances_to_ground(column, ground) <= 0).argmax()), 2])
    return np.array(top)


def test_an_incline_rises_at_its_angle_has_a_level_top_and_falls_again():
    course = Course(obstacle="incline", incline=15.0)
    (begin,), (end,) = course.layout(L).begins, course.layout(L).ends
    assert end - begin == pytest.approx((2 * course.ramp + course.summit) * L)
    share = np.array([-0.01, 0.1, 0.5, 0.9])
    rise = course.ramp * L * math.tan(math.radians(15.0))
    expected = rise * np.maximum(share, 0)
    np.testing.assert_allclose(heights(course, begin + share * course.ramp * L), expected, atol=3e-3)
    np.testing.assert_allclose(heights(course, end - share * course.ramp * L), expected, atol=3e-3)
    np.testing.assert_allclose(heights(course, [0.5 * (begin + end)]), rise, atol=3e-3)


def test_blocks_stand_over_half_of_the_lane_and_a_corridor_is_as_wide_as_it_says():
    course = Course(obstacle="blocks")
    (begin,), (end,) = course.layout(L).begins, course.layout(L).ends
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(begin, end, 4000), rng.uniform(-1, 1, 4000) * course.lane / 2 * L,
                              np.full(4000, 1e-3)])  # fmt: skip
    assert (distances_to_ground(points, course.ground(DESIGN)) < 0).mean() == pytest.approx(0.5, abs=0.03)
    course = Course(obstacle="corridor", corridor=1.8)
    middle = np.array([[float(course.layout(L).ends[0] - 0.5 * L), 0.0, 0.3 * L]])
    assert distances_to_ground(middle, course.ground(DESIGN))[0] == pytest.approx(min(0.9, 0.3) * L)
    middle[0, 2] = 0.49 * L
    middle[0, 1] = 0.5 * L
    assert distances_to_ground(middle, course.ground(DESIGN))[0] == pytest.approx(0.4 * L)


def test_all_stand_in_a_row_and_only_their_own_stretch_is_rough():
    course = Course(obstacle="all")
    layout, ground = course.layout(L), course.ground(DESIGN)
    assert course.names == tuple(OBSTACLES)
    assert (layout.begins[1:] - layout.ends[:-1]) / L == pytest.approx(course.before)
    x = (np.arange(len(ground.heights)) - len(ground.heights) // 2) * ground.cell
    inside = (x > layout.begins[-1]) & (x < layout.ends[-1])
    assert not ground.heights[~inside].any()
    assert ground.heights[inside].std() > 0.4 * course.bumps * L
    assert x[-1] > layout.ends[-1] + L


def test_a_robot_that_lies_still_is_given_up():
    task = as_task({"motion": "course", "obstacle": "bar", "stuck": 1.0})
    with task.robot(DESIGN) as robot:
        episode, steps = Episode(robot, task, np.random.default_rng(0)), 0
        while not episode.ended and steps < 30:
            episode.advance(np.zeros(6), 100)
            steps += 1
        assert (episode.ended, task.measures(episode)["success"]) == ("stuck", 0)
        assert 5 < steps < 30  # of 0.2 s


class Anywhere:
    """A robot that is put where it is wanted."""

    def __init__(self, place) -> None:
        self.place = np.array([*place, 0.3])

    def centre_of_mass_in_world(self):
        return self.place

    def node_positions_in_world(self):
        return self.place + np.array([[-0.4, 0, 0], [0.4, 0, 0]])


def test_an_obstacle_is_passed_by_the_whole_robot_and_not_from_outside_the_lane():
    lane, robot = Lane(np.zeros(2), np.array([2.0, 4.0]), 1.0, 0.5), Anywhere([2.3, 0.0])
    lane.update(robot, 0.0, 0.4)
    assert (lane.passed, lane.done, lane.left) == (0, False, False)
    robot.place[0] = 2.5
    lane.update(robot, 0.0, 0.4)
    robot.place[0] = 1.0
    lane.update(robot, 0.0, 0.4)
    assert lane.passed == 1  # and stays so
    robot.place[:2] = 4.5, 1.1
    lane.update(robot, 0.0, 0.4)
    assert (lane.passed, lane.left, lane.seconds) == (1, True, pytest.approx(1.6))


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_a_robot_that_is_pushed_along_the_lane_passes_a_bar(engine):
    task = as_task({"motion": "course", "obstacle": "bar", "bar_height": 0.02, "engine": engine})
    with task.robot(DESIGN) as robot:
        episode = Episode(robot, task, np.random.default_rng(1))
        np.testing.assert_allclose(episode.bearing.direction, [1, 0], atol=0.02)
        for _ in range(20):
            robot.push([1.0, 0, 1.0])
            episode.advance(np.zeros(6), 200)
            if episode.ended:
                break
        assert episode.ended == "passed"
        found = task.measures(episode)
        assert (found["success"], found["passed"]) == (1, 1)
        assert found["passing_time"] == pytest.approx(episode.gait.duration)
        assert found["cross_track"] < 1


def test_the_environment_takes_an_obstacle_by_name():
    env = gym.make("tensegym/SixRodCourse-v0", obstacle="incline", render_mode="rgb_array")
    env.reset(seed=0)
    info = env.step(np.zeros(6))[4]
    assert set(info["measures"]) == set(Course.MEASURES)
    assert len(env.unwrapped.robot.world.scene.boxes) == 3
    env.close()


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"obstacle": "ditch"}, "obstacle = 'ditch' is not one of blocks, corridor, bar, incline, rough, all"),
        ({"bar_height": -0.1}, r"bar_height = -0.1 is outside \[0.005, 1\] L"),
        ({"incline": 50}, r"incline = 50 is outside \[0, 45\] deg"),
        ({"corridor": 5.0}, "Course.corridor = 5 is wider than lane = 4"),
        ({"roughness": 0.02}, "a course is rough by its bumps"),
        ({"bumps": "high"}, "bumps"),
    ],
)
def test_bad_courses_are_named(table, words):
    with pytest.raises(TensegymError, match=words):
        as_task({"motion": "course", **table})


def test_an_obstacle_of_a_task_that_has_none_is_refused():
    with pytest.raises(DesignError, match="unknown field 'obstacle' in the task 'roll'"):
        gym.make("tensegym/SixRodRolling-v0", obstacle="bar")
