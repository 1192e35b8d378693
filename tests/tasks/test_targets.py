"""Targets against paths whose legs are known in closed form."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tensegym.control.bearing import Bearing
from tensegym.tasks.targets import Target, Targets


class Point:
    """A robot that is a point in the plane."""

    def __init__(self) -> None:
        self.at = np.zeros(3)

    def centre_of_mass_in_world(self) -> np.ndarray:
        return self.at.copy()


def goal_of(point: Point, *targets: Target, reach: float = 0.5, within: float = 0.3) -> Targets:
    return Targets(point, itertools.chain(targets, itertools.repeat(Target(0.0, math.inf, 1e9, 0.0))), reach, within)


def move(goal: Targets, point: Point, speed: float, seconds: float = 0.4) -> Bearing:
    """A control step straight along the bearing."""
    bearing, before = goal.bearing(point), point.at[:2].copy()
    point.at[:2] += speed * seconds * bearing.direction
    goal.update(point, goal.made(bearing, before, point.at[:2]), seconds)
    return bearing


def test_a_direction_holds_for_its_time_and_turns_by_its_drift():
    point = Point()
    goal = goal_of(point, Target(0.0, math.inf, 2.0, 0.25), Target(math.pi / 2, math.inf, 4.0, 0.0))
    seen = [move(goal, point, 1.0).direction for _ in range(6)]
    for step in range(5):
        np.testing.assert_allclose(seen[step], [math.cos(0.1 * step), math.sin(0.1 * step)])
    np.testing.assert_allclose(seen[5], [0, 1], atol=1e-12)
    (leg,) = goal.legs
    assert (leg.place, leg.seconds, leg.way) == (False, pytest.approx(2.0), pytest.approx(2.0))


def test_places_are_chained_from_one_another_and_reached_from_within_reach():
    point = Point()
    goal = goal_of(point, Target(0.0, 2.0, 0.0, 0.0), Target(math.pi / 2, 2.0, 0.0, 0.0))
    while goal.places == 0:
        move(goal, point, 0.5)
    assert goal.arrived
    assert np.linalg.norm(point.at[:2] - [2, 0]) <= 0.5
    to_go = np.array([2.0, 2.0]) - point.at[:2]  # from the place before, not from where the robot is
    assert goal.bearing(point).distance == pytest.approx(np.linalg.norm(to_go))
    np.testing.assert_allclose(goal.bearing(point).direction, to_go / np.linalg.norm(to_go))
    move(goal, point, 0.5)
    assert not goal.arrived
    assert goal.legs[0].way == pytest.approx(1.6)
    assert goal.legs[0].seconds == pytest.approx(3.2)


def test_a_stay_is_told_beforehand_and_its_share_counts_the_time_near_enough():
    point = Point()
    goal = goal_of(point, Target(0.0, 1.0, 2.0, 0.0))
    assert goal.bearing(point).stay
    while not goal.arrived:
        move(goal, point, 0.5)
    assert goal.bearing(point).distance <= 0.3
    for step in range(5):  # 2 s, of which it is away in the last two steps
        if step == 3:
            point.at[:2] += 1.0
        goal.update(point, 0.0, 0.4)
    assert goal.stays == pytest.approx(2.0)
    assert goal.stayed == pytest.approx(1.2)
    assert goal.places == 1
    assert math.isinf(goal.bearing(point).distance)  # the next target


@given(st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=1, max_size=20))
def test_way_made_towards_a_place_adds_up_to_how_much_nearer_it_is(steps):
    point, place = Point(), np.array([50.0, 0.0])
    goal, way = goal_of(point, Target(0.0, 50.0, 0.0, 0.0)), 0.0
    for step in steps:
        bearing, before = goal.bearing(point), point.at[:2].copy()
        point.at[:2] += step
        way += goal.made(bearing, before, point.at[:2])
    assert way == pytest.approx(50 - np.linalg.norm(place - point.at[:2]), abs=1e-9)
