"""Tables and policies on the robot that they were made for, and on others, which refuse them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym import structures
from tensegym.control.made_for import MadeFor
from tensegym.control.table import make_controller
from tensegym.control.tabled import TIPS
from tensegym.control.tipping import Pull, Tip
from tensegym.control.walker import Walker, save_table
from tensegym.design.design_file import design_from_dict
from tensegym.errors import DesignError, InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import hull_faces
from tensegym.structure.structure import six_rod

ROBOTS = {
    "six_rod": {},
    "three_rod_robot": {"structure": {"builder": "three_rod_robot"}},
    "four_rod": {"structure": {"builder": "prism", "rods": 4, "radius": 0.154, "height": 0.154, "wound": "around"}},
    "wound_elsewhere": {"structure": {"stiff_cables": [[3, 7], [4, 9], [5, 10], [6, 2], [11, 8], [12, 2]]}},
    "solid": {"structure": {"builder": "truncated"}},  # six rods and 20 faces, too, but others, and no drive
}
MADE = [  # a controller's table, and the robots that it is for
    *(({"kind": kind, "tips": tips}, {tips or "six_rod"}) for kind in ("walker", "planner") for tips in TIPS),
    ({"kind": "stepper"}, {"six_rod"}),
    ({"kind": "policy", "policy": "onboard"}, {"six_rod"}),
    ({"kind": "cpg", "policy": "onboard"}, {"six_rod"}),
    ({"kind": "policy", "policy": "four_rod"}, {"four_rod"}),
]


@pytest.fixture(scope="module", params=ROBOTS)
def named_robot(request):
    with TensegrityRobot(design_from_dict(ROBOTS[request.param]), dt=4e-3) as robot:
        yield request.param, robot


def test_what_was_made_for_another_robot_is_refused_in_one_line(named_robot):
    name, robot = named_robot
    for table, fits in MADE:
        controller = make_controller(table)
        if name in fits:
            controller.begin(robot, 0)
            continue
        with pytest.raises(DesignError) as refusal:
            controller.begin(robot, 0)
        text = str(refusal.value)
        assert len(text) <= 300 and "\n" not in text and ("this one has" in text or "the robot has" in text), text


@settings(max_examples=30, deadline=None)
@given(st.integers(3, 6), st.randoms(use_true_random=False), st.sampled_from(["rods", "drives", "faces"]))
def test_any_other_order_of_members_is_another_robot(rods, random, kind):
    structure = structures.Prism(rods, wound="around").build().structure
    own = MadeFor.of(structure, hull_faces(structure))
    order = list(getattr(own, kind))
    random.shuffle(order)
    other = replace(own, **{kind: tuple(order)})
    assert bool(own.differs(other)) == (other != own)
    if kind == "faces":  # a policy does not number them
        assert not replace(own, faces=()).differs(other)


def test_rods_of_another_length_are_no_other_members():
    long, short = (MadeFor.of(robot, hull_faces(robot)) for robot in (six_rod(0.9), six_rod(0.3)))
    assert not long.differs(short)


@pytest.mark.parametrize("said", [True, False])
def test_a_file_of_tips_for_another_robot_is_refused_also_where_it_does_not_say_so(tmp_path, said):
    """Its rows name all faces of three rods, eight, and all six drives, as many as the six-rod robot's."""
    three = structures.ThreeRodRobot().build().structure
    made_for, path = MadeFor.of(three, hull_faces(three)), tmp_path / "tips.json"
    rows = [Tip(Pull((face % 6,), 0.3), face, (face + 1) % 8, (0.1, 0.0), 10.0, 0.0) for face in range(8)]
    save_table(rows, path, made_for)
    walker = make_controller({"kind": "walker", "tips": str(path)}) if said else Walker(rows)
    with TensegrityRobot(dt=4e-3) as robot, pytest.raises(DesignError, match=r"8 faces.* 20.*tensegym step -"):
        walker.begin(robot)


def test_its_own_table_is_made_anew_for_a_robot_with_other_members(monkeypatch):
    made = []

    def tip_table(robot):
        made.append(len(robot.faces.triangles))
        return [Tip(Pull((len(robot.drives) - 1,), 0.3), made[-1] - 1, 0, (0.1, 0.0), 10.0, 0.0)]

    monkeypatch.setattr("tensegym.control.walker.tip_table", tip_table)
    walker = make_controller({"kind": "walker", "tips": "own"})
    with (TensegrityRobot(dt=4e-3) as six, TensegrityRobot(design_from_dict(ROBOTS["four_rod"]), dt=4e-3) as four):
        for robot in (six, six, four, four, six):
            walker.begin(robot)
            np.testing.assert_array_equal(list(walker._by_face), [len(robot.faces.triangles) - 1])
    assert made == [20, 12, 20]


def test_a_file_that_says_nonsense_of_its_robot_is_refused(tmp_path):
    path = tmp_path / "tips.json"
    path.write_text('{"made_for": {"rods": 6}, "tips": []}')
    with pytest.raises(InputError, match=r"tips"):
        make_controller({"kind": "walker", "tips": str(path)})
    save_table([Tip(Pull((0,), 0.3), 0, 1, (0.1, 0.0), 1.0)], path, MadeFor.of(six_rod()))
    path.write_text(path.read_text().replace('"1-2"', "12"))
    with pytest.raises(InputError, match=r"made_for\.rods\[1\] = 12"):
        make_controller({"kind": "walker", "tips": str(path)})
