"""The planner on tables whose shortest plan is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tensegym.control.bearing import Bearing
from tensegym.control.planner import Planner, PlannerSettings, Pose, _after
from tensegym.control.table import make_controller
from tensegym.control.tipping import Pull, Tip
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot


@pytest.fixture(scope="module")
def robot():
    with TensegrityRobot(dt=2e-3) as robot:
        yield robot


def planner(robot, *tips: Tip, reach: float = 0.05) -> Planner:
    found = Planner([*tips, Tip(Pull((5,), 0.45), 19, 19, (0.0, 0.0), 1.0, 0.0)], PlannerSettings(reach=reach))
    found.begin(robot)
    return found


def tip(drive: int, start: int, end: int, travel, turn: float = 0.0) -> Tip:
    return Tip(Pull((drive,), 0.45), start, end, travel, 1.0, turn)


def test_poses_are_chained_by_their_turns():
    step = tip(0, 0, 1, (1.0, 0.0), math.pi / 2)
    pose = Pose(0, 0.0, 0.0, 0.0)
    for _ in range(4):  # around a square
        pose = _after(pose._replace(face=0), step)
    np.testing.assert_allclose(pose[1:3], 0, atol=1e-12)
    assert pose.angle == pytest.approx(2 * math.pi)


def test_the_shortest_plan_is_found_where_the_nearest_pull_leads_astray(robot):
    length = robot.design.length
    ahead = tip(0, 0, 1, (0.3 * length, 0.0))  # points at the goal, but from face 1 nothing leads on
    aside = tip(1, 0, 2, (0.0, 0.4 * length))
    on = tip(2, 2, 3, (1.0 * length, -0.4 * length))
    plan = planner(robot, ahead, aside, on)._plan(Pose(0, 0.0, 0.0, 0.0), np.array([length, 0.0]), length)
    assert [step.pull.drives for step in plan] == [(1,), (2,)]


def test_a_place_out_of_reach_is_approached(robot):
    length = robot.design.length
    to, fro = tip(0, 0, 1, (0.4 * length, 0.0)), tip(1, 1, 0, (0.4 * length, 0.0))
    plan = planner(robot, to, fro)._plan(Pose(0, 0.0, 0.0, 0.0), np.array([2.0, 0.7]) * length, length)
    assert [step.pull.drives for step in plan] == [(0,), (1,), (0,), (1,), (0,)]


def test_it_takes_the_robot_nearer_to_a_place(robot):
    controller = make_controller({"kind": "planner", "period": 0.1})
    robot.reset(face=0)
    robot.step(150)
    controller.begin(robot, 0)
    place = robot.centre_of_mass_in_world()[:2] + np.array([0.9, 0.3])
    start = math.hypot(0.9, 0.3)
    for _ in range(110):
        to_go = place - robot.centre_of_mass_in_world()[:2]
        distance = float(np.linalg.norm(to_go))
        robot.command(controller.angles(robot, Bearing(to_go / distance, distance)))
        robot.step(50)
    assert distance < 0.6 * start


def test_a_table_without_turns_is_refused(robot):
    with pytest.raises(DesignError, match="has no turns"):
        Planner([Tip(Pull((drive,), 0.45), face, 1, (0.1, 0.0), 1.0) for drive, face in ((0, 0), (5, 19))]).begin(robot)
    with pytest.raises(DesignError, match="reach"):
        make_controller({"kind": "planner", "reach": -1})
