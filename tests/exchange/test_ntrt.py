"""NTRT's YAML: what a model becomes, in which units, and back; substructures and bonds; what is refused."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from tensegym.design.design_file import design_from_dict
from tensegym.design.groups import group_names
from tensegym.errors import InputError
from tensegym.exchange import ntrt_text, read_ntrt
from tensegym.structures import Prism

CASES = Path(__file__).parent / "cases"


def written(folder, name="model.yaml", **tables):
    path = folder / name
    path.write_text(yaml.safe_dump(tables, sort_keys=False))
    return path


def small(**changes):
    """A prism of three rods, by its tables."""
    return yaml.safe_load((CASES / "prism3.yaml").read_text()) | changes


def test_a_model_in_decimetres_becomes_one_in_si():
    """A force is in kg dm/s^2, a density in kg/dm^3; stiffness and damping are in no unit of length."""
    table, notes = read_ntrt(CASES / "prism3.yaml", "dm")
    design = design_from_dict(table)
    assert design.structure.nodes[3] == pytest.approx([0.4, 0, 0.45])  # y is up there, z here
    cable = design.each_cable[0]
    assert (cable.stiffness, cable.damping, cable.pretension) == pytest.approx((700, 6, 12))
    length = np.hypot(np.sqrt(3) * 4, 4.5)
    assert design.passive_rod.mass == pytest.approx(0.45 * np.pi * 0.1**2 * length, rel=1e-4)
    assert design.passive_rod.tube_outer_radius == pytest.approx(0.01)
    assert [note for note in notes if "roll_friction" in note]


@pytest.mark.parametrize("name", ["prism3", "prism4", "six_bar", "double_prism", "spine"])
@pytest.mark.parametrize("units", ["dm", "mm"])
def test_round_trips(tmp_path, name, units):
    """A design written as a model and read again has the same nodes, members, masses and cables."""
    design = design_from_dict(read_ntrt(CASES / f"{name}.yaml", "dm", 8.0).table)
    assert_same(design, back_from(tmp_path, design, units))


def back_from(folder, design, units):
    (folder / "back.yaml").write_text(ntrt_text(design, units))
    return design_from_dict(read_ntrt(folder / "back.yaml", units).table)


def assert_same(design, back):
    np.testing.assert_allclose(back.standing.nodes, design.standing.nodes, atol=1e-9)
    assert set(map(frozenset, back.structure.rods.tolist())) == set(map(frozenset, design.structure.rods.tolist()))
    assert back.mass == pytest.approx(design.mass)
    assert back.friction == design.friction
    mine, found = (
        {frozenset(pair): (cable.stiffness, cable.damping, pull) for pair, cable, pull in zip(
            each.structure.cables.tolist(), each.each_cable, each.rest_tensions.tolist(), strict=True)}
        for each in (design, back))  # fmt: skip
    assert mine.keys() == found.keys()
    for pair, cable in mine.items():
        assert found[pair] == pytest.approx(cable)


def names_of(design):
    """Of each cable and rod by its nodes, the group's."""
    rods, cables = design.structure.rods, design.structure.cables
    return {kind: {frozenset(pair): name for pair, name in zip(pairs.tolist(), group_names(groups, pairs), strict=True)}
            for kind, groups, pairs in (("cables", design.cables, cables), ("rods", design.rods, rods))}  # fmt: skip


@pytest.mark.parametrize("name", ["prism3", "prism4", "six_bar", "double_prism", "spine"])
def test_groups_keep_their_names_twice_round(tmp_path, name):
    """In the spine's hangers are two tensions, 17 parts in a million apart: one keeps the name, the other a number."""
    first = design_from_dict(read_ntrt(CASES / f"{name}.yaml", "dm", 8.0).table)
    once = back_from(tmp_path, first, "dm")
    assert names_of(back_from(tmp_path, once, "dm")) == names_of(once)
    before, after = names_of(first), names_of(once)
    assert after["rods"] == before["rods"]
    assert {pair: group.removesuffix("-2") for pair, group in after["cables"].items()} == before["cables"]
    assert (name == "spine") == (after["cables"] != before["cables"])


likely_to_clash = st.sampled_from(["rod", "rods", "rods-2", "string", "cables", "on", "No", "null", "a", "a-2"])
a_name = st.one_of(likely_to_clash, st.from_regex(r"[A-Za-z][A-Za-z0-9_-]{0,39}", fullmatch=True))


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(a_name, min_size=3, max_size=3, unique=True), st.sampled_from([4, 5]))
@example(["rods", "cables", "rod"], 4)
@example(["a" * 40, "a" * 39 + "b", "yes"], 4)
def test_groups_of_any_name_come_back(tmp_path, names, rods):
    plan = Prism(rods).build()
    around, upright = (
        {"pairs": (plan.cables[own] + 1).tolist(), "pretension": 9.0 * plan.tensions[own]} for own in plan.cables
    )
    structure = {"nodes": plan.nodes.tolist(), "rods": (plan.rods + 1).tolist(), "stiff_cables": [],
                 "cables": (plan.all_cables + 1).tolist()}  # fmt: skip
    heavy = {"pairs": (plan.rods[1:3] + 1).tolist(), "end_mass": 0.2}
    design = design_from_dict({"structure": structure, "cables": dict(zip(names, (around, upright), strict=False)),
                               "rods": {names[2]: heavy}})  # fmt: skip
    once = back_from(tmp_path, design, "m")
    assert names_of(once) == names_of(design)
    assert names_of(back_from(tmp_path, once, "m")) == names_of(design)
    assert_same(design, once)


def test_tags_that_would_make_one_group_name_are_told_apart(tmp_path):
    kinds = {"a b": {"class": "tgBasicActuatorInfo", "parameters": {"pretension": 100}},
             "a_b": {"class": "tgBasicActuatorInfo", "parameters": {"pretension": 200}}}  # fmt: skip
    pairs = small()["pair_groups"]
    cables = pairs.pop("tendon")
    builders = {tag: own for tag, own in small()["builders"].items() if tag != "tendon"} | kinds
    path = written(tmp_path, **small(pair_groups=pairs | {"a b": cables[:4], "a_b": cables[4:]}, builders=builders))
    groups = read_ntrt(path, "dm").table["cables"]
    assert {name: (len(group["pairs"]), group["pretension"]) for name, group in groups.items()} == {
        "a_b": (4, 10.0), "a_b-2": (5, 20.0)
    }  # fmt: skip


def test_rods_that_share_nodes_are_kept_where_the_files_tensions_do_not_balance(tmp_path):
    """A spine of equal pulls is held by those of its closed form; a file that has these loads as it is."""
    table, notes = read_ntrt(CASES / "spine.yaml", "dm", 8.0)
    assert table["keep"] == {"shape": True}
    assert "share nodes" in notes[-1] and len(notes) == 1
    design = design_from_dict(table)
    pulls = {group.name: [design.rest_tensions[design.structure.cables.tolist().index(list(pair))]
                          for pair in group.pairs] for group in design.cables}  # fmt: skip
    assert all(np.ptp(pull) < 1e-3 for pull in pulls.values())
    hanger, tie = (np.mean(pulls[name]) for name in ("hanger", "tie"))
    height, pitch = 2.44949, 1.46969  # of a vertebra, and from one to the next
    hung = np.hypot(3 / np.sqrt(3), height - pitch)
    assert tie / pitch == pytest.approx(hanger / hung * (height - pitch) / pitch, rel=1e-4)
    (tmp_path / "back.yaml").write_text(ntrt_text(design, "cm"))
    table, notes = read_ntrt(tmp_path / "back.yaml", "cm")
    assert "keep" not in table
    assert not notes


def test_cables_of_one_kind_that_pull_unalike_are_written_so(tmp_path):
    """As those of nodes that are kept: each has its own tension in the file."""
    plan = Prism(3).build()
    structure = {"nodes": plan.nodes.tolist(), "rods": (plan.rods + 1).tolist(), "stiff_cables": [],
                 "cables": (plan.all_cables + 1).tolist()}  # fmt: skip
    design = design_from_dict({"structure": structure, "keep": {"shape": True}})
    assert len(set(design.rest_tensions.round(6))) == 2
    assert_same(design, back_from(tmp_path, design, "m"))


def test_a_unit_may_be_a_number_of_metres():
    """As where a model is drawn thirty times its size."""
    first, second = (read_ntrt(CASES / "prism3.yaml", units).table["structure"]["nodes"] for units in ("0.1", "dm"))
    assert first == second


def test_the_groups_of_a_model_are_those_of_its_builders():
    design = design_from_dict(read_ntrt(CASES / "prism4.yaml", "dm").table)
    assert {group.name: len(group.pairs) for group in design.cables} == {"around": 8, "upright": 4}
    assert set(design.rest_tensions.tolist()) == {15.0, 24.0}


def test_a_spine_of_substructures():
    """Offsets count from 0, the turned vertebrae have their nodes in each other's places, every tie is upright."""
    table, _ = read_ntrt(CASES / "spine.yaml", "dm", pretension=8.0)
    nodes = np.array(table["structure"]["nodes"])
    assert len(table["structure"]["rods"]) == 24
    assert nodes[3::4] == pytest.approx(np.array([[0, 0, 0.244949 + 0.146969 * n] for n in range(4)]), abs=1e-6)
    ties = np.array(table["cables"]["tie"]["pairs"]) - 1
    assert nodes[ties[:, 1]] - nodes[ties[:, 0]] == pytest.approx(np.tile([0, 0, 0.146969], (9, 1)), abs=1e-4)
    hangers = np.array(table["cables"]["hanger"]["pairs"]) - 1
    assert nodes[hangers[:, 0], 2] - nodes[hangers[:, 1], 2] == pytest.approx(0.09798)
    assert (table["cables"]["hanger"]["pretension"], table["cables"]["tie"]["pretension"]) == (8.0, 8.0)


def test_a_bond_of_nodes_to_edges_lays_one_part_on_another():
    """Plane on plane and centre on centre, each node out by the middle of its edge (which is half as far); a cable
    along such an edge is gone for two by way of the node, and so are those between the nodes."""
    table, _ = read_ntrt(CASES / "double_prism.yaml", "dm")
    nodes, cables = np.array(table["structure"]["nodes"]), table["structure"]["cables"]
    high, low = nodes[3:6], nodes[6:9]
    middles = (high + np.roll(high, -1, axis=0)) / 2
    np.testing.assert_allclose(low - low.mean(axis=0), 2 * (middles - middles.mean(axis=0)), atol=1e-4)
    np.testing.assert_allclose(low.mean(axis=0), middles.mean(axis=0), atol=1e-9)
    assert nodes[9:12, 2] == pytest.approx(0.9)
    assert len(cables) == 9 + 9 - 3 - 3 + 6
    pairs = {frozenset(pair) for pair in cables}
    assert not pairs & {frozenset(pair) for pair in ((4, 5), (5, 6), (6, 4), (7, 8), (8, 9), (9, 7))}
    assert {frozenset((4, 7)), frozenset((7, 5))} <= pairs


def test_parts_are_turned_then_scaled_then_moved(tmp_path):
    """About their middle, or the reference; the scale about the middle, too."""
    written(tmp_path, "part.yaml", nodes={"a": [1, 0, 0], "b": [3, 0, 0]})
    turn = {"axis": [0, 0, 3], "angle": 90}
    bond = {"string": {"p/q/node_node": [["a", "b"]]}, "rod": {"p/q/node_node": [["a", "a"], ["b", "b"]]}}
    path = written(tmp_path, substructures={
        "p/q": {"path": "part.yaml", "offset": [0, 0, 5]},
        "q": {"rotation": turn, "scale": 2.0, "translation": [7, 0, 0]},
    }, bond_groups=bond)  # fmt: skip
    nodes = np.array(read_ntrt(path, "m", 1.0).table["structure"]["nodes"])
    wanted = {(1, 0, 0), (3, 0, 0), (2 + 7, -2, 5), (2 + 7, 2, 5)}  # x, y, z there
    assert {(round(x, 9), round(z, 9), round(-y, 9)) for x, y, z in nodes} == wanted
    path = written(tmp_path, substructures={
        "p/q": {"path": "part.yaml", "offset": [0, 0, 5]}, "q": {"rotation": turn | {"reference": [0, 0, 0]}},
    }, bond_groups=bond)  # fmt: skip
    nodes = np.array(read_ntrt(path, "m", 1.0).table["structure"]["nodes"])
    wanted = {(1, 0, 0), (3, 0, 0), (0, 1, 5), (0, 3, 5)}
    assert {(round(x, 9), round(z, 9), round(-y, 9)) for x, y, z in nodes} == wanted


def test_nodes_at_one_place_are_one_and_those_of_no_member_go(tmp_path):
    nodes = small()["nodes"] | {"twin": small()["nodes"]["low1"], "spare": [9, 9, 9]}
    pairs = small()["pair_groups"]
    pairs["tendon"][0] = ["twin", "low2"]
    table, notes = read_ntrt(written(tmp_path, **small(nodes=nodes, pair_groups=pairs)), "dm")
    assert len(table["structure"]["nodes"]) == 6
    assert [1, 2] in table["structure"]["cables"]
    assert "1 nodes that lie where another does were joined" in notes[0]
    assert "1 nodes without a member" in notes[1]


@pytest.mark.parametrize(("changes", "reason"), [
    ({"pair_groups": {"rod": [["low1", "low9"]]}}, r"pair group 'rod': no node 'low9'"),
    ({"pair_groups": {"wire": [["low1", "low2"]]}}, "no builder makes pairs tagged 'wire'"),
    ({"pair_groups": {"rod": [["low1", "low2", "low3"]]}}, "row 1 .*a row holds two names"),
    ({"pair_groups": {"rod": [["low1", "high2"]]}}, "1 rods and 0 cables"),
    ({"nodes": {"low1": [0, 0]}}, "node 'low1' = "),
    ({"nodes": {"low1": [0, "1e3", 0]}}, "without quotation marks"),
    ({"builders": {"rod": {"class": "tgBoxInfo"}}}, "'tgBoxInfo' is no rod and no cable"),
    ({"builders": {"rod": {"class": "tgRodInfo", "parameters": {"denstiy": 1}}}}, "'denstiy'.*density"),
    ({"builders": {"rod": {"class": "tgRodInfo", "parameters": {"density": -1}}}}, "density is below 0"),
    ({"builders": {"tendon": {"class": "tgBasicActuatorInfo"}}}, "cables 'tendon' have no pretension"),
    ({"substructures": {"a": {"path": "/etc/passwd"}}}, "is absolute"),
    ({"substructures": {"a": {"rotation": {}}}}, "'a' has no path"),
    ({"bond_groups": {"tendon": {"a/b/node_node": []}}}, "no substructure 'a'"),
    ({"bond_groups": {"tendon": {"a/b": []}}}, "node_node or node_edge"),
    ({"pair_group": {}}, "pair_group"),
])  # fmt: skip
def test_what_is_no_model_is_refused_by_name(tmp_path, changes, reason):
    with pytest.raises(InputError, match=reason):
        read_ntrt(written(tmp_path, **small(**changes)), "dm")


@pytest.mark.parametrize(("units", "reason"), [
    (None, "give units, one of m, dm"), ("ell", "'ell' is not one of m"), ("-1", "nor a length"),
])  # fmt: skip
def test_units_are_asked_for(units, reason):
    with pytest.raises(InputError, match=reason):
        read_ntrt(CASES / "prism3.yaml", units)


def test_files_that_grow_without_end_are_refused(tmp_path):
    """One that holds itself, and five that hold the next ten times."""
    with pytest.raises(InputError, match="beyond 12 deep"):
        read_ntrt(written(tmp_path, substructures={"a": {"path": "model.yaml"}}), "m")
    names = "/".join("abcdefghij")
    for n in range(5):
        written(tmp_path, f"{n}.yaml", substructures={names: {"path": f"{n + 1}.yaml"}})
    written(tmp_path, "5.yaml", nodes={"x": [0, 0, 0]})
    with pytest.raises(InputError, match="300 in all"):
        read_ntrt(tmp_path / "0.yaml", "m")


@pytest.mark.parametrize("text", ["a: &x [1]\nb: *x\n", "!!python/object/apply:os.system ['echo']\n", "nodes: [1, 2]\n",
                                  "- 1\n", "nodes: {a: [.nan, 0, 0]}\n"])  # fmt: skip
def test_yaml_that_is_more_than_data_is_refused(tmp_path, text):
    (tmp_path / "model.yaml").write_text(text)
    with pytest.raises(InputError):
        read_ntrt(tmp_path / "model.yaml", "m")


def test_a_substructure_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.yaml"):
        read_ntrt(written(tmp_path, substructures={"a": {"path": "none.yaml"}}), "m")
