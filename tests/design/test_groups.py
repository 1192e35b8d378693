"""Groups of cables, rods and drives: what a file says, what the robot has, what searches and disturbances reach."""

from dataclasses import replace

import numpy as np
import pytest

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design, design_from_dict, design_to_dict, load_design, save_design
from tensegym.design.groups import Group
from tensegym.design.symmetry import symmetries
from tensegym.design.variation import parse_variation
from tensegym.errors import DesignError
from tensegym.physics.model import DAMPING, STIFFNESS
from tensegym.physics.robot_arrays import robot_model
from tensegym.robot.robot import TensegrityRobot
from tensegym.search.problem import _whole
from tensegym.search.space import space_from
from tensegym.tasks.disturbance import Disturbance

FEW = [[1, 5], [6, 1], [2, 7], [2, 8], [3, 5], [3, 6], [4, 7], [4, 8]]  # the second one is 1-6 of the structure
ROWS, OTHER = [0, 1, 4, 5, 8, 9, 12, 13], 2
GROUPED = {
    "cables": {"soft": {"pairs": FEW, "stiffness": 200.0, "damping": 1.0}},
    "rods": {"heavy": {"pairs": [[1, 2], [3, 4]], "end_mass": 0.3}},
    "drives": {"strong": {"pairs": [[3, 7]], "current_limit": 3.4, "max_pull": 0.3}},
}


@pytest.fixture(scope="module")
def grouped():
    return design_from_dict(GROUPED)


def test_members_have_their_groups_values_and_else_those_of_all(grouped):
    model, plain = robot_model(grouped), robot_model(RobotDesign())
    assert {frozenset(pair) for pair in (grouped.structure.cables[ROWS] + 1).tolist()} == {*map(frozenset, FEW)}
    assert (model.spring_params[ROWS][:, [STIFFNESS, DAMPING]] == [200.0, 1.0]).all()
    others = np.setdiff1d(np.arange(len(model.spring_params)), ROWS)
    np.testing.assert_array_equal(model.spring_params[others], plain.spring_params[others])
    np.testing.assert_allclose(model.masses[:2], [0.028 + 0.6, 0.038 + 0.6])
    assert model.drive_params[0, 9] == 3.4 and (model.drive_params[1:] == plain.drive_params[1:]).all()
    natural = grouped.standing.lengths(grouped.structure.cables) - 2 * grouped.attachment_radius - 10 / 200
    np.testing.assert_allclose(grouped.cable_natural_lengths[ROWS], natural[ROWS])


def test_groups_survive_a_file(grouped, tmp_path):
    save_design(grouped, tmp_path / "grouped.toml")
    assert design_to_dict(load_design(tmp_path / "grouped.toml")) == design_to_dict(grouped)
    assert design_to_dict(grouped)["cables"]["soft"] == GROUPED["cables"]["soft"]


def test_a_group_of_all_with_the_values_of_all_is_the_same_robot():
    every = [tuple(pair) for pair in RobotDesign().structure.cables.tolist()]
    grouped = RobotDesign(cables=(Group("all", every, {"stiffness": 300.0}),), elastic_cable=replace(
        RobotDesign().elastic_cable, stiffness=500.0))  # fmt: skip
    for name, array in robot_model(RobotDesign())._asdict().items():
        np.testing.assert_array_equal(getattr(robot_model(grouped), name), array, err_msg=name)


def test_a_pretension_of_a_groups_own_takes_the_place_of_a_natural_length_of_all():
    """Of the paper's springs, given by length, the pretended ones are cables at rest length."""
    design = as_design("paper").with_(cables=(Group("soft", [(0, 4)], {"pretension": 2.0}),))
    lengths = design.standing.lengths(design.structure.cables)
    assert design.cable_natural_lengths[0] == pytest.approx(lengths[0] - 2.0 / 300)
    assert (design.cable_natural_lengths[1:] == 0.46806).all()


def test_unequal_pretensions_balance_where_form_finding_puts_the_nodes():
    design = design_from_dict({"cables": {"soft": {"pairs": FEW, "pretension": 9.0}}})
    with TensegrityRobot(design, ground=False, dt=1e-3) as robot:
        before = robot.node_positions_in_world()
        robot.step(500)
        np.testing.assert_allclose(robot.node_positions_in_world(), before, atol=1e-9)
        np.testing.assert_allclose(robot.tensions[ROWS], 9.0, rtol=1e-6)
        np.testing.assert_allclose(robot.tensions[[2, 3, 6, 7, *range(14, 24)]], 10.0, rtol=1e-6)


def test_a_rods_length_moves_its_nodes_before_the_shape_is_found():
    long = design_from_dict({"passive_rod": {"length": 0.8}, "rods": {"one": {"pairs": [[3, 4]], "length": 0.75}}})
    np.testing.assert_allclose(long.standing.rod_lengths, [0.8, 0.75, *[RobotDesign().length, 0.8, 0.8],
                                                          RobotDesign().length])  # fmt: skip
    assert long.length == pytest.approx(0.8)


def test_drives_of_two_kinds_are_commanded_by_their_own_radius_and_pull(grouped):
    design = grouped.with_(drives=(Group("wide", [(2, 6)], {"spool_radius": 0.006, "max_pull": 0.3}),))
    with TensegrityRobot(design) as robot:
        turns = robot.command_limit * [0.006, *[0.003] * 5] / design.stiff_cable_lengths
        np.testing.assert_allclose(turns, [0.3, *[0.45] * 5])
        assert design.deepest_pull == 0.3


def test_a_group_breaks_the_symmetry_that_it_does_not_have(grouped):
    assert len(symmetries(RobotDesign())) == 3
    assert len(symmetries(RobotDesign(cables=grouped.cables))) == 1
    assert len(symmetries(RobotDesign(drives=grouped.drives))) == 1


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"cables": {"a": {"pairs": [[1, 2]]}}}, r"cables\.a: 1-2 is none of structure\.cables"),
        ({"cables": {"a": {"pairs": [[1, 5], [5, 1]]}}}, r"cables\.a: 5-1 is twice in it"),
        ({"cables": {"a": {"pairs": [[1, 5]]}, "b": {"pairs": [[1, 5]]}}}, r"cables\.b: 1-5 is in cables\.a too"),
        ({"cables": {"a": {"stiffness": 3.0}}}, r"cables\.a has no 'pairs'"),
        ({"cables": {"a": {"pairs": []}}}, "has no pairs"),
        ({"cables": {"a b": {"pairs": [[1, 5]]}}}, "'a b' names no group"),
        ({"cables": {"a": {"pairs": [[1, 5]], "stifness": 3.0}}}, "unknown field 'stifness' in cables.a; did you mean"),
        ({"cables": {"a": {"pairs": [[1, 5]], "stiffness": -3.0}}}, r"cables\.a\.stiffness = -3.0 is outside \(0, "),
        ({"cables": {"a": {"pairs": [[1, 5, 2]]}}}, r"cables\.a\.pairs row 1"),
        ({"drives": {"a": {"pairs": [[1, 5]]}}}, r"drives\.a: 1-5 is none of structure\.stiff_cables"),
        ({"rods": {"a": {"pairs": [[1, 2]], "tube_inner_radius": 0.02}}}, "tube_inner_radius"),
        ({"cables": [1]}, "cables"),
    ],
)  # fmt: skip
def test_what_is_no_group_is_refused_by_name(table, said):
    with pytest.raises(DesignError, match=said):
        design_from_dict(table)


def test_a_list_of_one_value_a_cable_is_refused_with_groups_as_the_way():
    with pytest.raises(DesignError, match=r"elastic_cable\.pretension.*list.*\[cables\.NAME\]"):
        design_from_dict({"elastic_cable": {"pretension": [30.0, 10.0]}})


# -- who reaches them --------------------------------------------------------------------------------------------------


def test_variations_reach_groups_and_fields_of_the_robot(grouped):
    vary = parse_variation({"cables.soft.stiffness": {"low": 100.0, "high": 300.0}, "cables.soft.pretension": {
        "low": 9.0, "high": 11.0}, "friction": {"low": 0.2, "high": 1.0}, "passive_rod.length": {
        "low": 0.6, "high": 0.8}, "rods.heavy.end_mass": {"low": 0.1, "high": 0.5}}, grouped)  # fmt: skip
    np.testing.assert_allclose(vary.normalised(grouped), [0, 0, 0.5, 2 * (grouped.length - 0.7) / 0.2, 0], atol=1e-9)
    design = vary.at(grouped, np.full(5, 0.75))
    assert design.each_cable[0].stiffness == 250.0 and design.each_cable[0].pretension == 10.5
    assert design.friction == pytest.approx(0.8) and design.each_rod[0].end_mass == pytest.approx(0.4)
    assert design.standing.rod_lengths[3] == pytest.approx(0.75)
    for name in ("cables.soft.stifness", "cables.hard.stiffness", "cables.soft", "cables.soft.two_way"):
        with pytest.raises(DesignError, match="is no number of the design"):
            parse_variation({name: {"low": 1.0, "high": 2.0}}, grouped)


def test_a_space_reaches_groups_lengths_friction_and_pairs_of_wound_cables():
    tables = {"design": dict(GROUPED), "controller": {}}
    del tables["design"]["drives"]
    pairs = (RobotDesign().structure.stiff_cables + 1).tolist()
    other = [[pair[0], pair[1]] for pair in pairs[:-1]] + [[12, 4]]
    space = space_from({
        "design.cables.soft.pretension": {"low": 9.0, "high": 11.0}, "design.friction": {"low": 0.2, "high": 1.0},
        "design.passive_rod.length": {"low": 0.6, "high": 0.8},
        "design.structure.stiff_cables": {"choices": [pairs, other]},
    }, tables, _whole(tables))  # fmt: skip
    assert space.start["design.cables.soft.pretension"] == 10.0  # that of all, where a group has none of its own
    assert space.start["design.passive_rod.length"] == pytest.approx(RobotDesign().length)
    design = design_from_dict(space.apply(space.start | {"design.cables.soft.pretension": 9.5, "design.friction": 0.5,
                                                        "design.structure.stiff_cables": 1})["design"])  # fmt: skip
    assert design.each_cable[0].pretension == 9.5 and design.each_cable[2].pretension == 10.0
    assert design.friction == 0.5 and (design.structure.stiff_cables[-1] + 1).tolist() == [12, 4]


def test_disturbances_take_groups_along(grouped):
    disturb = Disturbance(stiffness=0.2, pretension=0.1, mass=0.3, drive=0.4)
    robot, factors = disturb.draw(grouped, np.random.default_rng(0))
    for made, meant in zip(robot.each_cable, grouped.each_cable, strict=True):
        assert made.stiffness == pytest.approx(factors["stiffness"] * meant.stiffness)
    assert robot.each_rod[0].end_mass == pytest.approx(0.3 * factors["mass"])
    assert robot.each_drive[0].current_limit == pytest.approx(3.4 * factors["drive"])
