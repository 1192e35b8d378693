"""The console command: what it prints, what it writes, and what it refuses in one line."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest

import tensegym
from tensegym.cli.main import COMMANDS
from tensegym.control.bearing import Bearing
from tensegym.control.commands_file import read_commands
from tensegym.control.made_for import MadeFor, read_made_for
from tensegym.control.tipping import Pull, run_pull, subsets, tip_from, tip_table
from tensegym.control.walker import Walker, load_table, save_table
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_to_dict
from tensegym.errors import InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.start_poses import start_at
from tensegym.structure.faces import face_by_nodes
from tensegym.structure.structure import six_rod
from tests.conftest import assert_refused

HEADER = "time_s," + ",".join(f"drive_{d}_rad" for d in range(1, 7))


def commands_csv(path, rows=((0.0, *[0.0] * 6), (0.1, *[20.0] * 6), (0.2, 40, 0, 40, 0, 40, 0)), header=HEADER):
    path.write_text("\n".join([header, *(",".join(map(str, row)) for row in rows)]) + "\n")
    return path


PRISM = """
name = "prism"
[structure]
nodes = [[0.3, 0, 0], [-0.15, 0.26, 0], [-0.15, -0.26, 0], [-0.26, 0.15, 0.5], [0, -0.3, 0.5], [0.26, 0.15, 0.5]]
rods = [[1, 4], [2, 5], [3, 6]]
cables = [[1, 2], [2, 3], [3, 1], [4, 5], [5, 6], [6, 4], [1, 6], [2, 4], [3, 5]]
stiff_cables = [[1, 5], [2, 6]]
"""


def read_csv(path):
    with path.open() as file:
        header, *rows = csv.reader(file)
    return header, np.array(rows, dtype=float)


# -- the program -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_every_command_and_its_options(name, cli):
    status, overview, _ = cli("--help")
    assert status == 0
    assert f"  {name}" in overview
    status, text, _ = cli(name, "--help")
    assert status == 0
    assert f"usage: tensegym {name}" in text
    assert "--json" in text


def test_no_command_shows_the_usage_and_is_an_error(cli):
    status, text, _ = cli()
    assert status == 2
    assert "usage: tensegym COMMAND" in text


def test_version_is_the_packages(cli):
    assert cli("--version") == (0, tensegym.__version__ + "\n", "")


def test_an_unknown_command_or_option_is_refused(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert_refused(cli("rol"), "unknown command 'rol'", "roll")
    status, out, err = cli("step", "--fase", "1-3-5")
    assert status == 2
    assert out == ""
    assert "--fase" in err
    assert not list(tmp_path.iterdir())


def test_the_console_script_gives_one_line_and_no_traceback(tmp_path):
    script = Path(sys.executable).with_name("tensegym")
    done = subprocess.run([script, "step", "--design", "seven_rod", "--out", tmp_path / "s"], capture_output=True,
                          text=True)  # fmt: skip
    assert done.returncode == 2
    assert done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if not line.startswith("pybullet build time")]
    assert lines == ["tensegym step: error: unknown preset 'seven_rod'; one of six_rod, paper, six_rod_flexible, or a "
                     "path that ends in .toml"]  # fmt: skip
    assert not (tmp_path / "s").exists()


def test_a_missing_library_is_named_with_the_extra_that_brings_it(cli, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert_refused(cli("step", "--out", tmp_path / "s"), "matplotlib is not installed", "pip install '.[train]'")
    assert not (tmp_path / "s").exists()


# -- step --------------------------------------------------------------------------------------------------------------


def test_step_writes_storyboard_and_drives_and_says_from_where_to_where(cli, tmp_path):
    out = tmp_path / "step"
    status, text, _ = cli("step", "--out", out, "--json")
    assert status == 0
    assert text.count("\n") == 1
    data = json.loads(text)
    assert data["tipped"] is True
    assert data["from_face"] != data["to_face"]
    assert sorted(p.name for p in out.iterdir()) == ["drives.png", "storyboard.png"]
    for name in ("drives.png", "storyboard.png"):
        picture = imageio.imread(out / name)
        assert picture.shape[0] > 500 and picture.std() > 10

    with TensegrityRobot(dt=2e-3) as robot:  # the same step by the API
        face = face_by_nodes(robot.faces, data["from_face"])
        tip = tip_from(robot, face, Pull(tuple(d - 1 for d in data["drives"]), data["depth"]))
        assert robot.faces.names()[tip.to_face] == data["to_face"]
        assert tip.peak_tension == data["peak_tension_N"]
        assert np.hypot(*tip.travel) == data["travel_m"]

    status, text, _ = cli("step", "--face", data["from_face"], "--drives", *data["drives"], "--out", tmp_path / "again")
    assert status == 0
    assert data["from_face"] in text and data["to_face"] in text


def test_a_pull_that_does_not_tip_says_so_and_exits_1(cli, tmp_path):
    status, text, _ = cli("step", "--face", "1-3-5", "--drives", "1", "--depth", "0.01", "--out", tmp_path / "s")
    assert status == 1
    assert "did not tip" in text


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--face", "1-2-3"], ["no face '1-2-3'", "1-3-5"]),
        (["--face", "front"], ["no face 'front'"]),
        (["--drives", "7"], ["drives = (7,)", "from 1 to 6"]),
        (["--drives", "1", "2", "3", "4", "5", "6", "7"], ["drives = (1, 2, 3, 4, 5, 6, 7)", "from 1 to 6"]),
        (["--drives", "2", "2"], ["drives = (2, 2)", "different"]),
        (["--depth", "0.5"], ["depth = 0.5", "(0, 0.45]"]),
        (["--depth", "nan"], ["depth = nan"]),
        (["--dt", "0"], ["dt = 0.0"]),
        (["--dt", "0.0015"], ["dt = 0.0015", "divide 0.02"]),
        (["--design", "seven_rod"], ["unknown preset 'seven_rod'"]),
    ],
)
def test_bad_arguments_of_step_write_nothing(arguments, words, cli, tmp_path):
    assert_refused(cli("step", *arguments, "--out", tmp_path / "s"), *words)
    assert not (tmp_path / "s").exists()


def test_step_on_a_three_rod_prism_that_no_pull_tips(cli, tmp_path):
    """Nothing assumes six rods: two drives give three choices of pull."""
    (tmp_path / "prism.toml").write_text(PRISM)
    out = tmp_path / "s"
    step = ["step", "--design", tmp_path / "prism.toml", "--out", out]
    assert_refused(cli(*step, "--face", "1-2-3", "--depth", "0.001"),
                   "no choice of one to three drives tips the robot from 1-2-3 at depth 0.001")  # fmt: skip
    assert_refused(cli(*step, "--drives", "3"), "from 1 to 2")
    assert not out.exists()


def test_step_into_a_file_is_refused(cli, tmp_path):
    (tmp_path / "s").write_text("mine")
    assert_refused(cli("step", "--out", tmp_path / "s"), "is a file")


# -- the table of tips and the walker ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def tips():
    seen = []
    with TensegrityRobot(dt=2e-3) as robot:
        table = tip_table(robot, (0.3,), [0], progress=lambda done, total: seen.append((done, total)))
    assert seen == [(n, 41) for n in range(1, 42)]
    return table


def test_the_table_has_every_choice_of_one_to_three_drives(tips):
    assert len(tips) == 6 + 15 + 20
    assert [tip.pull.drives for tip in tips] == list(subsets(6))
    assert {tip.from_face for tip in tips} == {0}
    moved = [tip for tip in tips if tip.tipped]
    assert 0 < len(moved) < len(tips)
    assert all(np.hypot(*tip.travel) > 0.05 for tip in moved)
    assert all(0 < tip.peak_tension < 82 for tip in tips)  # a drive's current limit


def test_a_table_goes_to_json_and_back(tips, tmp_path):
    made_for = MadeFor.of(six_rod())
    save_table(tips, tmp_path / "tips.json", made_for)
    assert load_table(tmp_path / "tips.json") == tips
    assert read_made_for(tmp_path / "tips.json") == made_for
    (tmp_path / "bad.json").write_text('[{"pull": 1}]')
    with pytest.raises(InputError, match=r"tips row 1\.pull = 1 must be a table"):
        load_table(tmp_path / "bad.json")


@pytest.mark.parametrize("heading", [0.0, 2.0])
@pytest.mark.parametrize("direction", [0.0, 1.5, 3.0, -1.5])
def test_the_walker_picks_the_pull_that_leads_nearest_the_direction(tips, heading, direction):
    """Played, the pick gets further along the direction than any other pull of the table does."""
    with TensegrityRobot(dt=2e-3) as robot:
        robot.reset(0, heading)
        robot.step(250)
        wanted = np.array([np.cos(direction), np.sin(direction)])
        walker = Walker(tips)
        walker.begin(robot)
        pull = walker.choose(robot, Bearing(wanted))
        start = robot.centre_of_mass_in_world()[:2]
        tip = run_pull(robot, pull)
        gained = wanted @ (robot.centre_of_mass_in_world()[:2] - start)
        turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        others = [wanted @ turn @ other.travel for other in tips if other.tipped]
        assert tip.tipped
        assert gained == pytest.approx(max(others), abs=0.02)


def test_the_walker_holds_a_pull_to_its_end_and_pulls_deep_where_nothing_tips(tips):
    with TensegrityRobot(dt=2e-3) as robot:
        robot.reset(0)
        walker = Walker(tips)
        walker.begin(robot)
        first = walker.angles(robot, Bearing(np.array([1.0, 0.0])))
        assert first.max() > 0
        robot.step(100)
        np.testing.assert_array_equal(walker.angles(robot, Bearing(np.array([-1.0, 0.0]))), first)
        robot.time += 2.0
        assert walker.angles(robot, Bearing(np.array([1.0, 0.0]))).max() == 0  # the release
        robot.reset(7)
        walker.begin(robot)
        assert walker.angles(robot, Bearing(np.array([1.0, 0.0]))).max() == pytest.approx(robot.command_limit[0])


def test_all_faces_writes_the_walkers_table(tips, cli, tmp_path, monkeypatch):
    monkeypatch.setattr("tensegym.cli.step.tip_table", lambda robot, depths, progress: tips)  # of one face
    status, text, _ = cli("step", "--all-faces", "--out", tmp_path, "--json")
    assert status == 0
    moved = sum(tip.tipped for tip in tips)
    data = json.loads(text)
    assert data.pop("standing")["verdict"] == "stands"
    assert data == {"out": str(tmp_path / "tips.json"), "pulls": 41, "tipped": moved,
                    "peak_tension_N": max(tip.peak_tension for tip in tips)}  # fmt: skip
    assert load_table(tmp_path / "tips.json") == tips
    assert len(read_made_for(tmp_path / "tips.json").faces) == 20
    _, text, _ = cli("step", "--all-faces", "--out", tmp_path)
    assert f"{moved} of 41 pulls tip the robot" in text
    assert len([line for line in text.splitlines() if "  closed " in line or "  open " in line]) == 20


# -- simulate ----------------------------------------------------------------------------------------------------------


def test_simulate_gives_back_what_the_api_does(cli, tmp_path):
    commands, out = commands_csv(tmp_path / "in.csv"), tmp_path / "out.csv"
    status, text, _ = cli("simulate", "--commands", commands, "--out", out, "--start", "1-3-5", "--heading", "0.5",
                          "--json")  # fmt: skip
    assert status == 0
    assert text.count("\n") == 1
    header, rows = read_csv(out)
    data = json.loads(text)
    assert (data["rows"], data["columns"]) == rows.shape == (21, len(header))
    column = dict(zip(header, rows.T, strict=True))

    times, angles = read_commands(commands, 6)
    with TensegrityRobot() as robot:
        start_at(robot, "1-3-5", 0.5)
        np.testing.assert_allclose(rows[0, 1:37], robot.node_positions_in_world().ravel(), rtol=1e-8, atol=1e-12)
        for tick in range(200):
            robot.command(np.array([np.interp(tick * 1e-3, times, angle) for angle in angles.T]))
            robot.step()
        energies, account = robot.energies(), robot.totals()
        last = {name: values[-1] for name, values in column.items()}
        assert last["time_s"] == pytest.approx(0.2)
        nodes = [last[f"node_{n}_{axis}_m"] for n in range(1, 13) for axis in "xyz"]
        np.testing.assert_allclose(nodes, robot.node_positions_in_world().ravel(), rtol=1e-8, atol=1e-12)
        quaternions = [last[f"rod_{r}_q{axis}"] for r in range(1, 7) for axis in "xyzw"]
        np.testing.assert_allclose(quaternions, robot.poses_in_world[:, 3:].ravel(), rtol=1e-8, atol=1e-12)
        tensions = [value for name, value in last.items() if "tension" in name]
        np.testing.assert_allclose(tensions, robot.tensions, rtol=1e-8)
        np.testing.assert_allclose([last[f"drive_{d}_current_A"] for d in range(1, 7)], robot.drives[:, 3], rtol=1e-8)
        np.testing.assert_allclose([last[f"drive_{d}_load_torque_Nm"] for d in range(1, 7)], robot.drives[:, 6],
                                   rtol=1e-8)  # fmt: skip
        np.testing.assert_allclose([last[f"drive_{d}_angle_rad"] for d in range(1, 7)], robot.drives[:, 1] / 19,
                                   rtol=1e-8)  # fmt: skip
        assert last["kinetic_J"] == pytest.approx(energies.kinetic, rel=1e-8)
        assert last["elastic_J"] == pytest.approx(energies.elastic, rel=1e-8)
        assert last["drive_work_J"] == pytest.approx(account.drive_work, rel=1e-8)
        assert last["electrical_energy_J"] == pytest.approx(account.electrical_energy, rel=1e-8)
    wound = RobotDesign().stiff_cable_lengths[0] - last["drive_1_cable_length_m"]
    assert wound == pytest.approx(0.003 * last["drive_1_angle_rad"], rel=1e-6)


def test_columns_carry_units_and_cover_all_that_is_asked(cli, tmp_path):
    design = RobotDesign().structure
    (tmp_path / "payload.toml").write_text("[payload]\nmass = 0.4\n")
    status, _, _ = cli("simulate", "--commands", commands_csv(tmp_path / "in.csv"), "--out", tmp_path / "out.csv",
                       "--design", tmp_path / "payload.toml")  # fmt: skip
    assert status == 0
    header, _ = read_csv(tmp_path / "out.csv")
    tensions = [name for name in header if "tension" in name]
    assert len(tensions) == 36
    a, b = design.cables[0] + 1
    assert tensions[0] == f"tension_{a}_{b}_N"
    units = ("_s", "_m", "_N", "_rad", "_A", "_Nm", "_J", "_qx", "_qy", "_qz", "_qw")
    assert all(name.endswith(units) for name in header)
    assert len(set(header)) == len(header) == 1 + 36 + 24 + 36 + 6 * 5 + 5


def test_no_ground_flies_without_gravity(cli, tmp_path):
    rows = ((0.0, *[0.0] * 6), (0.1, 20, 0, 10, 0, 0, 5), (0.2, 20, 0, 10, 0, 0, 5))
    commands = commands_csv(tmp_path / "in.csv", rows)
    heights = {}
    for flag in ("--ground", "--no-ground"):
        out = tmp_path / f"{flag}.csv"
        assert cli("simulate", "--commands", commands, "--out", out, flag)[0] == 0
        header, values = read_csv(out)
        assert (values[:, header.index("gravity_J")] == 0).all() == (flag == "--no-ground")
        z = values[:, [i for i, name in enumerate(header) if name.startswith("node") and name.endswith("z_m")]]
        masses = np.repeat([RobotDesign().rod(r).mass for r in range(6)], 2)
        order = RobotDesign().structure.rods.ravel()
        heights[flag] = z[:, order] @ masses / masses.sum()
    assert np.ptp(heights["--no-ground"]) < 1e-9  # nothing moves the centre of mass
    assert np.ptp(heights["--ground"]) > 1e-3


def test_simulate_takes_another_structure(cli, tmp_path):
    (tmp_path / "prism.toml").write_text(PRISM)
    commands = commands_csv(tmp_path / "in.csv", ((0.0, 0.0, 0.0), (0.2, 20.0, 0.0)), "time_s,drive_1_rad,drive_2_rad")
    out = tmp_path / "out.csv"
    assert cli("simulate", "--commands", commands, "--out", out, "--design", tmp_path / "prism.toml")[0] == 0
    header, rows = read_csv(out)
    assert len(header) == 1 + 18 + 12 + 11 + 2 * 5 + 5
    assert rows[:, header.index("stiff_tension_1_5_N")].max() > 1
    assert rows[:, header.index("stiff_tension_2_6_N")].max() < 1  # not driven


def test_no_command_uses_a_robot_that_falls_without_a_word(cli, tmp_path):
    falls = Path(__file__).parents[1] / "design" / "cases" / "prism4_sags.toml"
    commands = commands_csv(tmp_path / "in.csv", [(0.0, *[0.0] * 4), (0.1, *[0.0] * 4)],
                            "time_s," + ",".join(f"drive_{d}_rad" for d in range(1, 5)))  # fmt: skip
    words = ("'quad' falls flat", "12 of 12 faces", "no pretension up to", "form finding moved")
    status, text, told = cli("simulate", "--commands", commands, "--out", tmp_path / "out.csv", "--design", falls,
                             "--json")  # fmt: skip
    assert status == 0
    assert told.count("\n") == 1
    assert all(word in told for word in words)
    assert json.loads(text)["standing"]["verdict"] == "falls"
    status, text, told = cli("modes", "--design", falls, "--json")
    assert (status, told) == (0, "")
    assert json.loads(text)["standing"]["verdict"] == "falls"
    assert_refused(cli("step", "--design", falls, "--out", tmp_path / "step"), "falls flat", "12 of 12 faces")
    assert not (tmp_path / "step").exists()
    none = commands_csv(tmp_path / "none.csv", [(0.0,), (0.1,)], "time_s")
    moved = falls.with_name("tall_4prism.toml")
    status, _, told = cli("simulate", "--commands", none, "--out", tmp_path / "out.csv", "--design", moved)
    assert status == 0
    assert told == ("tensegym: robot 'tall_4prism' stands; form finding moved the given nodes by up to 0.366 m "
                    "(node 1), their height from 0.9 to 0.348 m\n")  # fmt: skip


def test_simulate_takes_the_papers_robot_in_its_pose(cli, tmp_path):
    out = tmp_path / "out.csv"
    status, _, _ = cli("simulate", "--commands", commands_csv(tmp_path / "in.csv"), "--out", out, "--design", "paper",
                       "--start", "paper-2", "--dt", "5e-4")  # fmt: skip
    assert status == 0
    header, rows = read_csv(out)
    z = [rows[0, header.index(f"node_{n}_z_m")] for n in range(1, 13)]
    assert sorted(np.argsort(z)[:3] + 1) == [3, 5, 12]


def ramp(count=4):
    return [[0.1 * n, *[5.0 * n] * 6] for n in range(count)]


def with_cell(row, column, value):
    rows = ramp()
    rows[row][column] = value
    return rows


@pytest.mark.parametrize(
    ("rows", "header", "words"),
    [
        (with_cell(2, 3, ""), HEADER, ["line 4", "drive_3_rad = ''", "no finite number"]),
        (with_cell(1, 1, "nan"), HEADER, ["line 3", "drive_1_rad: 'nan' is not a number"]),
        (with_cell(1, 6, "inf"), HEADER, ["line 3", "drive_6_rad: 'inf'"]),
        (with_cell(1, 0, "soon"), HEADER, ["line 3", "time_s: 'soon'"]),
        ([r[:-1] if n == 2 else r for n, r in enumerate(ramp())], HEADER, ["line 4", "6 cells", "7"]),
        ([*ramp(), [0.7, *[0.0] * 6]], HEADER, ["line 6", "a step of 0.4 s where the others are 0.1 s", "gap"]),
        (with_cell(2, 0, 0.1), HEADER, ["line 4", "time_s must grow"]),
        ([[*r, 0.0] for r in ramp()], HEADER + ",drive_7_rad", ["the header must be time_s", "drive_7_rad"]),
        ([r[:-1] for r in ramp()], HEADER.removesuffix(",drive_6_rad"), ["the header must be time_s"]),
        (ramp(1), HEADER, ["1 rows", "two or more"]),
        ([], HEADER, ["no rows below the header"]),
        (with_cell(3, 2, 500.0), HEADER, ["drive_2_rad = 500 at 0.3 s", "[0, 97.25] rad"]),
        (with_cell(3, 4, -1.0), HEADER, ["drive_4_rad = -1 at 0.3 s"]),
    ],
)
def test_bad_commands_name_their_line(rows, header, words, cli, tmp_path):
    commands = commands_csv(tmp_path / "in.csv", rows, header)
    assert_refused(cli("simulate", "--commands", commands, "--out", tmp_path / "out.csv"), *words)
    assert [p.name for p in tmp_path.iterdir()] == ["in.csv"]


def test_a_bad_line_after_blank_ones_is_named_by_its_number_in_the_file(tmp_path):
    path = tmp_path / "in.csv"
    path.write_text(f"{HEADER}\n0,0,0,0,0,0,0\n\n\n0.1,0,0,,0,0,0\n")
    with pytest.raises(InputError, match=r"line 5: drive_3_rad = ''"):
        read_commands(path, 6)
    path.write_text(f"{HEADER}\n0,0,0,0,0,0,0\n\n0.1,0,0,0,0,0,0\n0.1,0,0,0,0,0,0\n")
    with pytest.raises(InputError, match=r"line 5: time_s must grow"):
        read_commands(path, 6)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--dt", "0"], ["dt = 0.0"]),
        (["--dt", "nan"], ["dt = nan"]),
        (["--dt", "0.1"], ["dt = 0.1", "0.004"]),
        (["--sample", "0.0015"], ["sample = 0.0015 s must be a whole number of steps of dt = 0.001 s"]),
        (["--sample", "-1"], ["sample = -1"]),
        (["--start", "upright"], ["unknown start 'upright'", "paper-1"]),
        (["--start", "1-2-3"], ["no face '1-2-3'"]),
        (["--heading", "nan"], ["heading = nan"]),
        (["--design", "seven_rod"], ["unknown preset 'seven_rod'"]),
        (["--design", "none.toml"], ["no design file none.toml"]),
        (["--commands", "none.csv"], ["no file none.csv"]),
    ],
)
def test_bad_arguments_of_simulate_write_nothing(arguments, words, cli, tmp_path):
    given = {"--commands": commands_csv(tmp_path / "in.csv"), "--out": tmp_path / "out.csv"}
    given |= dict([arguments])
    assert_refused(cli("simulate", *[part for pair in given.items() for part in pair]), *words)
    assert [p.name for p in tmp_path.iterdir()] == ["in.csv"]


def test_a_file_that_is_no_text_and_an_out_that_cannot_be_are_refused(cli, tmp_path):
    (tmp_path / "in.bin").write_bytes(os.urandom(64) + b"\xff\xfe\x80")
    assert_refused(cli("simulate", "--commands", tmp_path / "in.bin", "--out", tmp_path / "out.csv"), "not a CSV")
    good = commands_csv(tmp_path / "in.csv")
    assert_refused(cli("simulate", "--commands", good, "--out", tmp_path / "none" / "out.csv"), "no folder")
    assert_refused(cli("simulate", "--commands", good, "--out", tmp_path), "is a folder")
    assert_refused(cli("simulate", "--commands", tmp_path, "--out", tmp_path / "out.csv"), "no file")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["in.bin", "in.csv"]


def test_a_simulation_that_fails_leaves_the_old_file(cli, tmp_path):
    out = tmp_path / "out.csv"
    out.write_text("old")
    assert_refused(cli("simulate", "--commands", commands_csv(tmp_path / "in.csv", with_cell(3, 2, 500.0)),
                       "--out", out), "drive_2_rad")  # fmt: skip
    assert out.read_text() == "old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["in.csv", "out.csv"]


# -- designs -----------------------------------------------------------------------------------------------------------

SELF_JOINED = {"structure": {"cables": [[1, 1], *design_to_dict(RobotDesign())["structure"]["cables"][1:]]}}


@pytest.mark.parametrize(
    ("toml", "words"),
    [
        ('preset = "seven_rod"', ["unknown preset 'seven_rod'"]),
        ("[elastic_cable]\nstifness = 300.0", ["unknown field 'stifness'", "did you mean 'stiffness'?"]),
        ("[elastic_cable]\nstiffness = -300.0", ["stiffness = -300.0", "(0, 1e+06] N/m"]),
        (f"[structure]\ncables = {SELF_JOINED['structure']['cables']}", ["cables member 1-1", "node 1 to itself"]),
        ("form_finding = false\n[structure]\nrod_length = 0.7\nspacing = 0.6", ["no self-stress", "balance: 1 "]),
        ("[elastic_cable\n", ["is not TOML"]),
        ("[payload]\nmass = nan", ["payload.mass = nan"]),
    ],
)
@pytest.mark.parametrize("command", ["step", "simulate"])
def test_bad_designs_give_one_line_and_nothing_is_written(command, toml, words, cli, tmp_path):
    (tmp_path / "design.toml").write_text(toml)
    more = ["--commands", commands_csv(tmp_path / "in.csv")] if command == "simulate" else []
    assert_refused(cli(command, "--design", tmp_path / "design.toml", "--out", tmp_path / "out", *more), *words)
    assert not (tmp_path / "out").exists()


# -- validate ----------------------------------------------------------------------------------------------------------


def test_validate_gives_its_table_as_one_json_object(cli, monkeypatch):
    from tensegym.validation import TOPICS

    quick = {name: TOPICS[name] for name in ("statics", "geometry", "drives")}
    monkeypatch.setattr("tensegym.cli.validate.TOPICS", quick)
    status, text, _ = cli("validate", "--json")
    assert status == 0
    assert text.count("\n") == 1
    data = json.loads(text)
    assert data["passed"] == data["total"] == sum(1 for rows_of in quick.values() for _ in rows_of("pybullet"))
    assert set(data["checks"][0]) == {"id", "quantity", "expected", "measured", "tolerance", "passed"}
    status, text, _ = cli("validate")
    assert status == 0
    assert f"{data['total']} of {data['total']} pass" in text


def test_validate_exits_1_when_a_check_fails(cli, monkeypatch):
    from tensegym.validation import TOPICS, Check

    def wrong(engine):
        yield Check("S1", "one that fails", 1.0, 1.1, 0.05)

    monkeypatch.setattr("tensegym.cli.validate.TOPICS", {"wrong": wrong, "geometry": TOPICS["geometry"]})
    status, text, _ = cli("validate")
    assert status == 1
    assert text.count("FAIL") == 1
