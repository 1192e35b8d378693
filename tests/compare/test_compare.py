"""`tensegym compare`: what it finds where the engines agree, and where one of them is wrong."""

import json
import sys

import numpy as np
import pytest

from tensegym.compare import motion, settling, steps
from tensegym.compare.episodes import episodes
from tensegym.design.design import RobotDesign, flexible_design
from tensegym.mujoco import mjcf, world
from tests.conftest import assert_refused

DT = 2e-3


@pytest.fixture
def commands(tmp_path):
    header = ",".join(["time_s", *(f"drive_{d}_rad" for d in range(1, 7))])
    (tmp_path / "commands.csv").write_text(f"{header}\n0,0,0,0,0,0,0\n0.4,60,0,0,20,0,0\n")
    return tmp_path / "commands.csv"


@pytest.mark.parametrize("design", [RobotDesign(), flexible_design()], ids=["rigid", "split rods"])
def test_engines_agree_in_free_flight(design, monkeypatch):
    monkeypatch.setattr(motion, "FLIGHT_SECONDS", 0.6)
    part = motion.free_flight(design, DT)
    ((_, moved, apart),) = part.rows
    assert part.agrees
    assert moved > 0.1
    assert apart < 1e-10
    assert np.array(part.curves["engines_m"]).shape == (31, 12)


def test_a_wrong_force_is_seen_in_free_flight(monkeypatch):
    monkeypatch.setattr(motion, "FLIGHT_SECONDS", 0.4)
    step = world.MujocoWorld.step
    monkeypatch.setattr(world.c_interface, "AVAILABLE", False)  # Python's loop
    monkeypatch.setattr(world.MujocoWorld, "step", lambda self, wrenches: step(self, 1.001 * wrenches))
    assert not motion.free_flight(RobotDesign(), DT).agrees


def test_every_face_settles_at_one_height_and_a_soft_ground_is_seen(monkeypatch):
    monkeypatch.setattr(settling, "SETTLING", 1.0)
    monkeypatch.setattr(settling, "LOOKING", 0.3)
    part = settling.settling(RobotDesign(), DT)
    assert part.agrees
    assert len(part.rows) == len(part.curves["faces"]) == 20
    assert 0 < np.abs(part.curves["difference_m"]).max() < 1e-3
    monkeypatch.setattr(mjcf, "CONTACT_TIME", 0.05)
    assert not settling.settling(RobotDesign(), DT).agrees


def test_pulls_that_end_elsewhere_are_tried_a_little_off(monkeypatch):
    monkeypatch.setattr(steps, "subsets", lambda count: [(0,), (1, 4)])
    part = steps.steps(RobotDesign(), DT, (0.3,), 1, faces=(0,))
    ((pulls, one, other, equal, edge, rest),) = part.rows
    assert pulls == 2
    assert equal + edge + rest == pytest.approx(1)
    assert {one, other} <= {0, 1, 2}
    monkeypatch.setattr(steps, "_ends", lambda design, trials, jobs: [
        {steps.ENGINES[0]: 1, steps.ENGINES[1]: 2}[t.engine] + (t.pull.drives == (0,) and t.dt < DT) for t in trials
    ])  # fmt: skip
    part = steps.steps(RobotDesign(), DT, (0.3,), 1, faces=(0,))
    assert part.rows[0][3:] == [0, 0.5, 0.5]  # all differ, and one of both is on an edge
    assert [row[-1] for row in part.curves["differ"]] == [True, False]
    assert not part.agrees


def test_episodes_have_intervals_about_their_medians():
    part = episodes("rolling", 4, 2.0, jobs=1)
    assert [row[1] for row in part.rows] == ["pybullet", "mujoco"]
    for row in part.rows:
        low, high = json.loads(row[3])
        assert low <= round(row[2], 3) <= high
    ratio, low, high = part.curves["ratio"]
    assert ratio == pytest.approx(part.rows[1][2] / part.rows[0][2])
    assert low <= ratio <= high


def test_the_command_writes_a_table_and_a_picture(cli, tmp_path, monkeypatch, commands):
    monkeypatch.setattr(motion, "FLIGHT_SECONDS", 0.2)
    monkeypatch.setattr(settling, "SETTLING", 0.5)
    monkeypatch.setattr(settling, "LOOKING", 0.1)
    out = tmp_path / "out"
    status, text, _ = cli("compare", "--commands", commands, "--out", out)
    assert status == 0
    data = json.loads((out / "compare.json").read_text())
    assert list(data["parts"]) == ["free flight", "settling", "commands"]
    assert all(part["verdict"] in text for part in data["parts"].values())
    nudged = data["parts"]["commands"]["pybullet, nudged by 1e-9 m/s_m"]
    assert 0 < nudged[-1] < data["parts"]["commands"]["engines apart_m"][-1]
    assert (out / "compare.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["--policy", "nobody"], ["no policy 'nobody'"]),
        (["--commands", "nowhere.csv"], ["nowhere.csv"]),
        (["--design", "seven_rod"], ["unknown preset"]),
        (["--dt", "0.003"], ["dt = 0.003 s must divide 0.02 s"]),
        (["--step", "--depths", "0.9"], ["depths: 0.9 is outside (0, 0.45]"]),
    ],
)
def test_bad_input(cli, tmp_path, monkeypatch, argv, words):
    monkeypatch.chdir(tmp_path)
    assert_refused(cli("compare", *argv), *words)
    assert not list(tmp_path.iterdir())


def test_without_mujoco_there_is_nothing_to_compare(cli, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert_refused(cli("compare", "--out", tmp_path / "out"), "engine 'mujoco' is not installed")
    assert not (tmp_path / "out").exists()
