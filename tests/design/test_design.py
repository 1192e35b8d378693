from dataclasses import fields
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tensegym.design.design import PRESETS, Drive, ElasticCable, Payload, RobotDesign, Rod, paper_design
from tensegym.design.design_file import as_design, design_from_dict, design_to_dict, load_design, save_design
from tensegym.errors import DesignError, StructureError


def test_default_has_the_papers_masses_and_balances():
    design = RobotDesign()
    assert design.mass == pytest.approx(1.698)
    assert design.active_rods.tolist() == [1, 2, 5]
    assert design.length == pytest.approx(0.70167, abs=1e-5)
    assert design.standing.lengths(design.standing.cables) == pytest.approx(0.42968, abs=1e-5)
    assert design.standing.lengths(design.standing.stiff_cables) == pytest.approx(0.65635, abs=1e-5)
    natural = design.cable_natural_lengths + 2 * design.attachment_radius
    assert natural == pytest.approx(0.39635, abs=1e-5)


def test_paper_preset_keeps_the_papers_numbers():
    design = paper_design()
    assert design.elastic_cable.two_way
    assert design.elastic_cable.damping == 150
    assert design.cable_natural_lengths == pytest.approx(0.46806)
    assert design.standing is design.structure


@pytest.mark.parametrize("name", PRESETS)
def test_toml_round_trip(name, tmp_path):
    design = PRESETS[name]()
    save_design(design, tmp_path / "d.toml")
    assert design_to_dict(load_design(tmp_path / "d.toml")) == design_to_dict(design)


def test_payload_round_trip_and_natural_length(tmp_path):
    design = RobotDesign(payload=Payload())
    save_design(design, tmp_path / "d.toml")
    again = load_design(tmp_path / "d.toml")
    assert again.payload == design.payload
    assert 0 < again.payload_natural_length < 0.0754  # where its springs pull at the true shape


@given(st.sampled_from([Rod, ElasticCable, Drive, Payload]), st.data())
def test_every_bounded_field_is_refused_below_its_range(kind, data):
    bounded = [f for f in fields(kind) if "range" in f.metadata]
    chosen = data.draw(st.sampled_from(bounded))
    value = chosen.metadata["range"].low - data.draw(st.floats(1e-6, 1e6))
    with pytest.raises(DesignError, match=rf"{kind.__name__}\.{chosen.name} = "):
        kind(**{chosen.name: value})


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({"elastic_cable": {"stifness": 300.0}}, "did you mean 'stiffness'"),
        ({"elastic_cable": {"stiffness": -1.0}}, r"stiffness = -1.0 is outside \(0, 1e\+06\] N/m"),
        ({"elastic_cable": {"stiffness": "high"}}, "stiffness = 'high'"),
        ({"elastic_cable": {"pretension": 200.0}}, "must be below"),
        ({"payload": {"pretension": 20.0}}, "no natural length"),
        ({"passive_rod": {"tube_inner_radius": 0.01}}, "tube_inner_radius"),
        ({"preset": "seven_rod"}, "unknown preset 'seven_rod'"),
        ({"colour": "red"}, "unknown field 'colour'"),
        ({"form_finding": 1}, "true or false"),
        ({"structure": {"rod_length": -1}}, "rod_length"),
        ({"drive": 3}, "must be a table"),
        ({"structure": {"rod_length": True}}, "structure.rod_length = True is true or false, no number"),
        ({"structure": {"rod_length": 10**300}}, r"outside \[0.01, 30\] m"),
        ({"elastic_cable": {"natural_length": "x"}}, "elastic_cable.natural_length = 'x' is a text, no number"),
        ({"payload": {"natural_length": True}}, "payload.natural_length = True is true or false"),
        ({"elastic_cable": {"two_way": 1}}, "elastic_cable.two_way = 1 must be true or false"),
        ({"flexure": {"hinge": "door"}}, "door"),
        ({"flexure": {"rods": "some"}}, "flexure.rods = 'some' is not one of passive, active, all"),
        ({"preset": ["six_rod"]}, "preset = .* must be a text"),
        ({"structure": {"nodes": [[[0.0]]]}}, "structure.nodes row 1"),
        ({"structure": {"cables": [[1, 2], [1]]}}, r"structure.cables row 2 = \[1\] has 1 entries"),
    ],
)
def test_bad_designs_name_the_field(data, words):
    with pytest.raises(DesignError, match=words):
        design_from_dict(data)


def test_nodes_without_self_stress_are_refused_unless_form_finding_may_move_them():
    data = {"preset": "six_rod", "structure": {"rod_length": 0.7, "spacing": 0.6}}
    assert design_from_dict(data).standing.lengths([[0, 4]])[0] == pytest.approx(0.7 * 0.612372, rel=1e-5)
    with pytest.raises(StructureError, match="out of balance: 1 "):
        design_from_dict(data | {"form_finding": False})


def test_as_design_takes_presets_files_and_designs(tmp_path):
    assert as_design("paper").name == "paper"
    with pytest.raises(DesignError, match="unknown preset 'nope'"):
        as_design("nope")
    with pytest.raises(FileNotFoundError):
        as_design(str(tmp_path / "absent.toml"))
    (tmp_path / "bad.toml").write_text("a = = 1")
    with pytest.raises(DesignError, match="is not TOML"):
        as_design(str(tmp_path / "bad.toml"))


# -- files of kinds that users have ------------------------------------------------------------------------------------

CASES = Path(__file__).parent / "cases"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("per_cable_pretension", "elastic_cable.pretension = [30.0, 30.0, 30.0, 30.0, ...] is a list of 12 where one "
         "value stands; give one number in [0, 10000] N: tension at rest of every elastic cable"),
        ("per_cable_stiffness", "elastic_cable.stiffness = [100.0, 100.0, 100.0, 100.0, ...] is a list of 12 where"),
        ("clustered", "structure.cables row 1 = [1, 2, 3, 1] has 4 entries; a row holds two node numbers; give a cable "
         "through several nodes as several cables"),
        ("clustered3", "structure.cables row 1 = [1, 2, 3] has 3 entries; a row holds two node numbers"),
        ("prism_mm", "rod 1-5 is 631.2 m long, outside [0.01, 30] m; coordinates are in m, these look like mm"),
    ],
)  # fmt: skip
def test_what_would_be_another_robot_is_refused_by_file_and_row(name, words):
    with pytest.raises((DesignError, StructureError)) as refused:
        load_design(CASES / f"{name}.toml")
    assert words in str(refused.value)
    assert str(refused.value).startswith("design file ") and len(str(refused.value)) <= 300


def test_a_file_from_a_spreadsheet_or_notepad_is_read():
    assert (CASES / "bom_design.toml").read_bytes().startswith(b"\xef\xbb\xbf")
    assert load_design(CASES / "bom_design.toml").name == "ntrt_3prism"


def test_a_robot_with_a_drive_beside_every_cable_is_read():
    design = load_design(CASES / "superball2.toml")
    assert len(design.structure.stiff_cables) == len(design.structure.cables) == 24
    assert design.active_rods.tolist() == list(range(6))
