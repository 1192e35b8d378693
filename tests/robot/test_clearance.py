"""Rods that stand in one another are refused; how far two of them are apart."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.design.design import Payload, RobotDesign, Rod
from tensegym.errors import DesignError
from tensegym.robot.clearance import check_clear, segment_distance
from tensegym.robot.robot import TensegrityRobot


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**31))
def test_the_distance_of_segments_is_the_least_of_their_points(seed):
    one, two = np.random.default_rng(seed).uniform(-1, 1, (2, 2, 3))
    part = np.linspace(0, 1, 201)[:, None]
    points, others = (s[0] + part * (s[1] - s[0]) for s in (one, two))
    sampled = np.linalg.norm(points[:, None] - others[None], axis=2).min()
    found = segment_distance(one, two)
    assert found <= sampled + 1e-12
    assert found == pytest.approx(sampled, abs=0.02)


def test_a_point_and_parallel_segments():
    segment = np.array([[0.0, 0, 0], [1, 0, 0]])
    assert segment_distance(segment, np.array([[2.0, 1, 0], [2, 1, 0]])) == pytest.approx(np.sqrt(2))
    assert segment_distance(segment, np.array([[0.5, 0, 0.3], [3, 0, 0.3]])) == pytest.approx(0.3)


def test_rods_as_thick_as_they_are_apart_are_refused():
    """Parallel rods stand half a rod length apart, the others cross closer; the nearest pair sets the limit."""
    nodes, rods = RobotDesign().standing.nodes, RobotDesign().standing.rods
    apart = min(segment_distance(nodes[a], nodes[b]) for i, a in enumerate(rods) for b in rods[:i])

    def thick(radius):
        rod = Rod(tube_outer_radius=radius)
        return RobotDesign(passive_rod=rod, active_rod=rod)

    check_clear(thick(0.499 * apart))
    with pytest.raises(DesignError, match=r"rods \d+-\d+ and \d+-\d+ overlap by .* at rest.*tube_outer_radius"):
        TensegrityRobot(thick(0.501 * apart))


def test_a_payload_as_large_as_its_room_is_refused():
    standing = RobotDesign(payload=Payload(stiffness=1e6)).standing
    middles = standing.nodes[standing.rods].mean(axis=1)
    room = np.linalg.norm(middles - middles.mean(axis=0), axis=1).min() - 0.004  # less the rods' radius
    check_clear(RobotDesign(payload=Payload(radius=0.999 * room, stiffness=1e6)))
    with pytest.raises(DesignError, match=r"payload and rod \d+-\d+ overlap by .*Payload\.radius = "):
        check_clear(RobotDesign(payload=Payload(radius=1.001 * room, stiffness=1e6)))
