"""Holds: what the robot's symmetry makes of them, how they are played, and their file."""

from __future__ import annotations

import numpy as np
import pytest

from tensegym.control.hold import Attempt, Hold, attempt, load_holds, save_holds, turned
from tensegym.control.made_for import MadeFor
from tensegym.control.policy import shipped
from tensegym.control.tipping import current_face
from tensegym.errors import InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import six_rod


@pytest.fixture(scope="module")
def robot():
    with TensegrityRobot(dt=2e-3) as robot:
        yield robot


@pytest.fixture(scope="module")
def holds():
    return load_holds(shipped("walker") / "holds.json")


def test_symmetry_takes_holds_to_the_other_faces_and_they_do_the_same_there(robot, holds):
    one = next(hold for hold in holds if hold.ends[0][1] == 1)
    images = turned([one], robot.design, robot.faces)
    assert len(images) == 3
    assert {tuple(sorted(image.parts)) for image in images} == {tuple(sorted(one.parts))}
    for image in images:
        assert robot.faces.closed[image.from_face] == robot.faces.closed[one.from_face]
        assert attempt(robot, image.from_face, image.parts, heading=0.3) == image.ends[0][0]
    assert len(turned(images, robot.design, robot.faces)) == 3


def test_every_face_has_a_hold_onto_a_neighbour_and_holds_fit_the_robot(robot, holds):
    assert {hold.from_face for hold in holds} == set(range(20))
    for hold in holds:
        assert len(hold.parts) == len(robot.drives)
        assert sum(share for _, share in hold.ends) == pytest.approx(1)


def test_a_hold_is_over_when_the_robot_has_landed_or_is_not_going_to_tip(robot):
    robot.reset(0)
    robot.step(150)
    held, looks = Attempt(robot, np.zeros(6)), 0
    while not held.over(robot):
        robot.step(50)
        looks += 1
    assert looks == 24  # of 0.1 s, until its patience of 2.4 s is over
    assert current_face(robot) == held.face


def test_a_table_comes_back_from_its_file(tmp_path):
    holds = [Hold(3, (0.5, 0.0, 1.0), ((4, 0.75), (3, 0.25)))]
    save_holds(holds, tmp_path / "holds.json", MadeFor.of(six_rod()))
    assert load_holds(tmp_path / "holds.json") == holds
    assert (holds[0].leads_to(4), holds[0].leads_to(9)) == (0.75, 0.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"holds": []}', "must be a list of one row or more"),
        ('{"holds": [{"from_face": 1, "parts": [2.0]}]}', r"holds row 1.parts\[1\] = 2.0 is outside"),
        ('{"holds": [{"parts": [0.5]}]}', "holds row 1 has no 'from_face'"),
        ("[", "holds.json"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, text, words):
    (tmp_path / "holds.json").write_text(text)
    with pytest.raises(InputError, match=words):
        load_holds(tmp_path / "holds.json")
    with pytest.raises(FileNotFoundError, match="no table of holds"):
        load_holds(tmp_path / "none.json")
