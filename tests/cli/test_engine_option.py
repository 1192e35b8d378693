"""--engine of the commands, and what it refuses."""

import json
import sys

import pytest

from tensegym.files import VERSION
from tensegym.tasks import as_task, policy_setup
from tests.conftest import assert_refused

COMMANDS = ("evaluate --out {0}", "roll --out {0}", "step --out {0}", "simulate --commands {1} --out {0}",
            "validate", "design run --task carry --out {0}")  # fmt: skip


@pytest.fixture
def places(tmp_path):
    commands = tmp_path / "commands.csv"
    header = ",".join(["time_s", *(f"drive_{d}_rad" for d in range(1, 7))])
    commands.write_text("\n".join([header, "0,0,0,0,0,0,0", "0.1,30,0,0,0,0,0"]) + "\n")
    return tmp_path / "out", commands


@pytest.mark.parametrize("command", COMMANDS)
def test_an_engine_that_is_none_is_refused_before_anything_is_written(cli, places, command):
    result = cli(*command.format(*places).split(), "--engine", "bulet")
    assert_refused(result, "engine = 'bulet' is not one of pybullet, mujoco")
    assert not places[0].exists()


@pytest.mark.parametrize("command", COMMANDS)
def test_without_mujoco_one_line_says_what_to_install(cli, places, monkeypatch, command):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    result = cli(*command.format(*places).split(), "--engine", "mujoco")
    assert_refused(result, "engine 'mujoco' is not installed", "pip install '.[mujoco]'")
    assert not places[0].exists()


def test_a_window_is_refused(cli):
    assert_refused(cli("roll", "--window", "--engine", "mujoco"), "engine 'mujoco' has no window")


def test_simulate_runs_in_either_engine_and_they_agree_at_first(cli, places):
    rows = {}
    for engine in ("pybullet", "mujoco"):
        out = places[0].with_name(f"{engine}.csv")
        status, _, _ = cli("simulate", "--commands", places[1], "--out", out, "--engine", engine, "--no-ground")
        assert status == 0
        rows[engine] = [[float(v) for v in line.split(",")] for line in out.read_text().splitlines()[1:]]
    nodes = slice(1, 37)
    for ours, theirs in zip(*rows.values(), strict=True):
        assert ours[nodes] == pytest.approx(theirs[nodes], abs=1e-9)
    assert rows["pybullet"][-1][nodes] != pytest.approx(rows["pybullet"][0][nodes], abs=1e-3)


def test_evaluate_says_which_engine_it_was(cli, tmp_path):
    status, _, _ = cli("evaluate", "--engine", "mujoco", "--episodes", 1, "--seconds", 1, "--no-baselines",
                       "--no-half-step", "--no-video", "--jobs", 1, "--out", tmp_path / "out")  # fmt: skip
    assert status == 0
    data = json.loads((tmp_path / "out" / "metrics.json").read_text())
    assert (data["version"], data["engine"]) == (VERSION, "mujoco")


def test_a_task_names_its_engine():
    task = as_task({"motion": "roll", "engine": "mujoco"})
    assert policy_setup("onboard", task=task).task.engine == "mujoco"
    assert policy_setup("onboard", task=task, engine="pybullet").task.engine == "pybullet"
    assert policy_setup("onboard").task.engine == "pybullet"
