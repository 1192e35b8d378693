"""The reader of tables: whatever a file holds ends as checked values or in one clear line of the caller's error."""

import json
import string
import tomllib
from dataclasses import dataclass

import pytest
import tomli_w
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tensegym import tables
from tensegym.errors import DesignError, FlexureError, InputError, TensegymError
from tensegym.files import write_json
from tensegym.tables import Range


@dataclass(frozen=True)
class Spring(tables.Checked, error=DesignError):
    stiffness: float = tables.bounded(0, 1e6, 300.0, "N/m", "spring rate", open_low=True)
    length: float | None = tables.bounded(0, 100, None, "m", "at rest")
    turns: int = tables.bounded(1, 50, 3, "", "of the coil")
    two_way: bool = tables.noted(False, "pushes as well")
    kind: str = tables.choice("steel", "brass", what="of wire")
    place: tuple[float, float] = tables.noted((0.0, 0.0), "where it hangs")


@dataclass(frozen=True)
class Robot(tables.Checked, error=DesignError):
    name: str = tables.noted(what="of the robot")
    spring: Spring = Spring()
    spare: Spring | None = None


def fill(table, kind=Spring, error=FlexureError, base=None):
    return tables.fill(kind, table, "spring" if kind is Spring else "", error, base)


# -- fields ------------------------------------------------------------------------------------------------------------


def test_a_table_gives_a_checked_dataclass_and_whole_numbers_become_floats():
    found = fill({"stiffness": 200, "turns": 7, "kind": "brass", "place": [1, 2.5], "two_way": True})
    assert found == Spring(200.0, None, 7, True, "brass", (1.0, 2.5))
    assert isinstance(found.stiffness, float) and isinstance(found.place[0], float)
    assert isinstance(Spring(stiffness=200).stiffness, float)


def test_fields_left_out_keep_those_of_the_base():
    base = Spring(500.0, 0.1)
    assert fill({"turns": 9}, base=base) == Spring(500.0, 0.1, 9)
    robot = Robot("a", spring=base)
    assert fill({"spring": {"turns": 9}, "spare": {}}, Robot, base=robot) == Robot("a", Spring(500.0, 0.1, 9), Spring())


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"stifness": 1.0}, "unknown field 'stifness' in spring; did you mean 'stiffness'?"),
        ({1: 1.0}, "unknown field 1 in spring; one of kind, length"),
        ({"stiffness": 0.0}, "spring.stiffness = 0.0 is outside (0, 1e+06] N/m"),
        ({"stiffness": "high"}, "spring.stiffness = 'high' is a text, no number; give one number in (0, 1e+06] N/m"),
        ({"stiffness": "1e-4"}, "write it without quotation marks, and in YAML 1.0e-4 for 1e-4"),
        ({"stiffness": True}, "spring.stiffness = True is true or false, no number; give one number in"),
        ({"stiffness": [1.0] * 12}, "is a list of 12 where one value stands; give one number in (0, 1e+06] N/m"),
        ({"stiffness": float("nan")}, "spring.stiffness = nan is no finite number; give one number in"),
        ({"stiffness": float("inf")}, "spring.stiffness = inf is no finite number"),
        ({"stiffness": 10**300}, "is outside (0, 1e+06] N/m"),
        ({"stiffness": 10**400}, "is no finite number"),
        ({"stiffness": 16**6000}, "a number of thousands of digits is no finite number"),
        ({"stiffness": None}, "spring.stiffness = None is no finite number"),
        ({"length": "x"}, "spring.length = 'x' is a text, no number; give one number in [0, 100] m"),
        ({"length": float("nan")}, "spring.length = nan is no finite number"),
        ({"turns": 2.0}, "spring.turns = 2.0 is no whole number; give one whole number in [1, 50]"),
        ({"turns": 16**6000}, "a number of thousands of digits is outside [1, 50]"),
        ({"turns": False}, "spring.turns = False is no whole number"),
        ({"two_way": 1}, "spring.two_way = 1 must be true or false"),
        ({"kind": "wood"}, "spring.kind = 'wood' is not one of steel, brass"),
        ({"kind": ["steel"]}, "spring.kind = ['steel'] must be a text"),
        ({"place": 1.0}, "spring.place = 1.0 must be a list"),
        ({"place": [1.0]}, "spring.place = [1.0] must be a list of 2"),
        ({"place": [1.0, "x"]}, "spring.place[2] = 'x' is a text, no number"),
        (3, "spring = 3 must be a table of fields"),
        ([{}], "spring = [{}] must be a table of fields"),
    ],
)
def test_a_fault_is_one_line_that_names_field_value_and_range(table, words):
    with pytest.raises(FlexureError) as caught:
        fill(table)
    assert words in str(caught.value)
    assert len(str(caught.value)) <= 300 and "\n" not in str(caught.value)


def test_construction_keeps_to_the_same_ranges():
    with pytest.raises(DesignError, match=r"Spring\.stiffness = -1 is outside \(0, 1e\+06\] N/m"):
        Spring(stiffness=-1)
    with pytest.raises(DesignError, match=r"Spring\.length = 'x' is a text"):
        Spring(length="x")


def test_nested_groups_are_named_by_their_path():
    with pytest.raises(FlexureError, match=r"^spring\.turns = 0 is outside"):
        fill({"name": "a", "spring": {"turns": 0}}, Robot)
    with pytest.raises(FlexureError, match=r"^spare = 3 must be a table"):
        fill({"name": "a", "spare": 3}, Robot)
    with pytest.raises(FlexureError, match="Robot has no 'name'; it must be given"):
        fill({}, Robot)


def test_a_description_lists_every_field():
    rows = tables.describe(Spring)
    assert [r.field for r in rows] == ["stiffness", "length", "turns", "two_way", "kind", "place"]
    assert (rows[0].default, rows[0].unit, rows[0].range, rows[0].meaning) == (
        "300", "N/m", "(0, 1e+06]", "spring rate")  # fmt: skip
    assert rows[1].default == "none" and rows[4].range == "steel, brass"


def test_every_field_of_a_robot_has_a_meaning():
    from tensegym.design.design import RobotDesign
    from tensegym.design.parameters import Drive, ElasticCable, Payload, Rod, RodFlexure, StiffCable

    for kind in (RobotDesign, Rod, ElasticCable, StiffCable, Drive, Payload, RodFlexure):
        assert [r.field for r in tables.describe(kind) if not r.meaning and r.field != "structure"] == []


# -- ranges ------------------------------------------------------------------------------------------------------------


@given(st.floats(1e-3, 1e3), st.floats(1.01, 100), st.booleans(), st.floats(0, 1))
def test_part_undoes_value(low, ratio, log, part):
    r = Range(low, low * ratio, log)
    assert r.part(r.value(part)) == pytest.approx(part, abs=1e-9)


def test_half_way_is_the_mean_or_with_log_the_geometric_mean():
    assert Range(200, 800).value(0.5) == pytest.approx(500)
    assert Range(200, 800, log=True).value(0.5) == pytest.approx(400)


def test_an_open_end_is_outside():
    assert 0 in Range(0, 1) and 0 not in Range(0, 1, open_low=True) and 1 not in Range(0, 1, open_high=True)
    assert str(Range(0, 1, open_low=True)) == "(0, 1]" and str(Range(0, 1, open_high=True)) == "[0, 1)"


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"low": 1.0}, "must give low and high"),
        ({"low": 3.0, "high": 3.0}, "from 3 to 3 is no range"),
        ({"low": 0.0, "high": 3.0, "log": True}, "above 0 with log"),
        ({"low": True, "high": 3.0}, "a.low = True is true or false"),
        ({"low": 1.0, "high": 3.0, "log": 1}, "a.log = 1 must be true or false"),
        ({"low": 1.0, "hihg": 3.0}, "did you mean 'high'?"),
        ("x", "must be a table"),
    ],
)
def test_what_is_no_range_is_refused(table, words):
    with pytest.raises(InputError, match=words):
        Range.parse(table, "a", InputError)


# -- files -------------------------------------------------------------------------------------------------------------


def test_a_byte_order_mark_is_read_over(tmp_path):
    (tmp_path / "a.toml").write_bytes(b"\xef\xbb\xbfa = 1\r\n")
    assert tables.read_toml(tmp_path / "a.toml", "design file", DesignError) == {"a": 1}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("a = 1".encode("utf-16"), "is written in UTF-16; save it as UTF-8"),
        ("a = 1".encode("utf-32"), "is written in UTF-32; save it as UTF-8"),
        ("a = 1".encode("utf-16-le"), "holds null bytes, as UTF-16 without a mark does"),
        ("a = 1".encode("utf-16-be"), "holds null bytes, as UTF-16 without a mark does"),
        (b"a = 1\nb = '\xe4'", "is not UTF-8: byte 0xe4 at line 2, column 6"),
        (b"a = = 1", "is not TOML: Invalid value (at line 1, column 5)"),
        (b"a = " + b"[" * 5000, "nested too deep"),
        (b"a = " + b"1" * 5000, "is not read"),
        (b"a = 1979-13-45", "at line 1"),
        (b"a = 1\na = 2", "is not TOML"),
        (b"# " + b"x" * 4_000_000, "is larger than 4 MB"),
    ],
)
def test_a_toml_file_that_is_none_is_one_line(tmp_path, data, words):
    (tmp_path / "x.toml").write_bytes(data)
    with pytest.raises(DesignError) as caught:
        tables.read_toml(tmp_path / "x.toml", "design file", DesignError)
    assert words in str(caught.value) and str(caught.value).startswith("design file ")
    assert len(str(caught.value)) <= 300 and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: &x [1]\nb: *x\n", "an alias (*name) stands there; write it out at line 2, column 4"),
        ("a: 1\na: 2\n", "the field 'a' is given twice at line 2, column 1"),
        ("a: [1,\n", "at line 2, column 1"),
        ("a: !!python/object:os.system x", "a tag (!!type) stands there; leave it out at line 1, column 4"),
        ("a: !!bool x", "a tag (!!type) stands there"),
        ("a: !!int ''", "a tag (!!type) stands there"),
        ("a: !!timestamp x", "a tag (!!type) stands there"),
        ("!!map {a: !!set {x}}", "a tag (!!type) stands there; leave it out at line 1, column 1"),
        ("- 1\n- 2\n", "must be a table of fields"),
        ("a: " + "[" * 5000, "is not"),
        ("a: " + "1" * 5000, "is not read"),
        ("? [a]\n: 1\n", "is not YAML"),
        ("a: \0", "is not YAML"),
        ("a: 1\n---\nb: 2\n", "is not YAML"),
    ],
)
def test_a_yaml_text_that_is_none_is_one_line(text, words):
    with pytest.raises(InputError) as caught:
        tables.parse_yaml(text, "training config x", InputError)
    assert words in str(caught.value)
    assert len(str(caught.value)) <= 300 and "\n" not in str(caught.value)


@pytest.mark.parametrize("parse", [tables.parse_toml, tables.parse_yaml])
def test_too_many_digits_are_said_without_advice_to_change_the_interpreter(parse):
    digits = "1" * 5000
    with pytest.raises(InputError, match=r"^x is not read: .*value has 5000 digits$"):
        parse(f"a = {digits}" if parse is tables.parse_toml else f"a: {digits}", "x", InputError)


def test_yaml_has_no_dates_and_may_be_empty():
    assert tables.parse_yaml("a: 2020-01-01", "x", InputError) == {"a": "2020-01-01"}
    assert tables.parse_yaml("", "x", InputError) == {}


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="no design file"):
        tables.read_toml(tmp_path / "none.toml", "design file", DesignError)
    with pytest.raises(FileNotFoundError):
        tables.read_toml(tmp_path, "design file", DesignError)
    with pytest.raises((DesignError, FileNotFoundError)):
        tables.read_toml("a\0b", "design file", DesignError)


PLAIN = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=20),
              st.sampled_from([10**400, -(10**300)]), st.dates(), st.binary(max_size=4)),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8) | st.integers(), inner, max_size=3),
    max_leaves=8,
)  # fmt: skip


@settings(suppress_health_check=[HealthCheck.too_slow])  # the first draw makes all strategies
@given(st.dictionaries(st.sampled_from(["stiffness", "length", "turns", "two_way", "kind", "place", "x"]), PLAIN))
def test_any_table_is_filled_or_refused_in_one_line(table):
    try:
        found = fill(table)
    except FlexureError as error:
        assert len(str(error)) <= 300 and "\n" not in str(error)
    else:
        assert found.stiffness in Range(0, 1e6, open_low=True)


@given(st.binary(max_size=60) | st.text(string.printable, max_size=60).map(str.encode))
def test_any_bytes_are_read_or_refused_in_one_line(data):
    for parse in (tables.parse_toml, tables.parse_yaml):
        try:
            assert isinstance(parse(tables.decode(data, "x", InputError), "x", InputError), dict)
        except TensegymError as error:
            assert len(str(error)) <= 300 and "\n" not in str(error)


@given(st.dictionaries(st.text(string.ascii_letters, min_size=1), st.floats(allow_nan=False) | st.text(), max_size=4))
def test_toml_is_read_as_its_writer_wrote_it(table):
    text = tomli_w.dumps(table)
    assert tables.parse_toml(text, "x", InputError) == tomllib.loads(text) == table


def test_rows_are_named_from_1():
    with pytest.raises(InputError, match=r"cables row 2 = \[1, 2, 3\] has 3 entries; a row holds 2 numbers"):
        tables.as_rows([[1, 2], [1, 2, 3]], 2, "cables", InputError)
    assert tables.as_rows([], 3, "nodes", InputError).shape == (0, 3)
    with pytest.raises(InputError, match=r"cables row 1 = \[1.0, 2.5\]: entry 2 is no whole number"):
        tables.as_whole_rows([[1, 2.5]], 2, "cables", InputError)
    with pytest.raises(InputError, match=r"cables row 1\[2\] = nan is no finite number"):
        tables.as_whole_rows([[1, float("nan")]], 2, "cables", InputError)
    assert tables.as_whole_rows([[1, 2]], 2, "cables", InputError).tolist() == [[1, 2]]


def read_json(path):
    return tables.read_json(path, "notes", FlexureError)


def test_json_has_a_version_and_newer_ones_are_refused(tmp_path):
    path = tmp_path / "a.json"
    write_json(path, {"x": [1.5, None]})
    assert json.loads(path.read_text()) == {"version": 1, "x": [1.5, None]}
    assert read_json(path) == {"x": [1.5, None]}
    path.write_text('\ufeff{"x": 1}')  # as files were before they had versions, or as an editor writes them
    assert read_json(path) == {"x": 1}
    for version in ("2", "1.5", '"new"', "true"):
        path.write_text(f'{{"version": {version}}}')
        with pytest.raises(InputError, match=r"a\.json is of version .*, this tensegym reads up to 1"):
            read_json(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [("", "is not JSON"), ('{"x": 1', "is not JSON, or cut short: .*line 1 column 8"),
     ("[" * 100_000, ".*nested too deep"), ("9" * 5000, "is not JSON, or cut short: Exceeds the limit")],
)  # fmt: skip
def test_what_is_no_json_is_refused_in_one_line(tmp_path, text, words):
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(FlexureError, match=rf"notes .*a\.json {words}"):
        read_json(path)
