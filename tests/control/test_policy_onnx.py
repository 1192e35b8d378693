"""Exported policies: the actions of the policy itself, from a file that needs none of this package."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest

from tensegym import TensegrityRobot
from tensegym.cli.main import run
from tensegym.control.bearing import Bearing
from tensegym.control.policy import PolicyController, load_policy, policy_folder, shipped_names
from tensegym.control.policy_file import read_policy
from tensegym.control.policy_onnx import policy_graph
from tensegym.physics.drives import CURRENT, ROTOR_SPEED

onnxruntime = pytest.importorskip("onnxruntime")
PAGE = (Path(__file__).parents[2] / "docs" / "robot.md").read_text()


@pytest.mark.parametrize("name", shipped_names())
def test_actions_are_the_policys_own(name):
    graph = policy_graph(read_policy(policy_folder(name)), {}).SerializeToString()
    policy, session = load_policy(name), onnxruntime.InferenceSession(graph)
    seen = np.random.default_rng(0).normal(0, 2, (50, policy.observed)).astype(np.float32)
    seen[0] = 1e6  # clipped after normalisation
    (actions,) = session.run(None, {"observation": seen})
    np.testing.assert_allclose(actions, [policy(row) for row in seen], atol=1e-5)
    assert np.abs(actions).max() <= 1


def test_the_pages_script_drives_the_robot_as_the_policy_does(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["policy", "export", "onboard", "--out", "policy.onnx"]) == 0
    printed = capsys.readouterr().out
    for line in re.search(r"\n\n((?:    .*\n)+)\nAxes", PAGE)[1].splitlines():
        assert line.strip() in printed
    script = re.search(r"```python file=robot.py\n(.*?)```", PAGE, re.DOTALL)[1]
    code = [line for line in script.split("if __name__")[0].splitlines() if line.strip()]
    assert len(code) <= 30
    (tmp_path / "robot.py").write_text(script)
    decide = runpy.run_path("robot.py", run_name="__main__")["decide"]
    assert "every 0.4 s" in capsys.readouterr().out

    controller, heading = PolicyController("onboard"), 0.7
    with TensegrityRobot(dt=2e-3) as robot:
        robot.reset(face=4, heading=1.0)
        robot.step(200)
        controller.begin(robot)
        bearing = Bearing(np.array([np.cos(heading), np.sin(heading)]))
        for _ in range(5):
            wanted = controller.angles(robot, bearing)
            turns = robot.poses_in_world[:6, 3:]
            axes = np.array([_axis(turn) for turn in turns])
            rates = robot.velocities_in_world()[:6, 3:]
            spool = robot.drive_angles
            got = decide(axes, rates, spool, robot.drives[:, ROTOR_SPEED], robot.drives[:, CURRENT], heading)
            np.testing.assert_allclose(got, wanted, atol=1e-3 * robot.command_limit.max())
            robot.command(wanted)
            robot.step(200)


def _axis(q):
    x, y, z, w = q
    return [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]


def test_the_file_says_what_a_robot_needs(tmp_path):
    out = tmp_path / "p.onnx"
    assert run(["policy", "export", "rolling", "--out", str(out)]) == 0
    about = onnxruntime.InferenceSession(out.read_bytes()).get_modelmeta().custom_metadata_map
    parts = json.loads(about["observation"])
    assert sum(part["rows"] * part["width"] for part in parts) == load_policy("rolling").observed
    assert float(about["control_period_s"]) == 0.4
    assert len(json.loads(about["spool_angles_rad"])) == 6


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nobody"], "no policy 'nobody'"),
        (["rolling", "--out", "nowhere/p.onnx"], "no folder nowhere"),
        (["rolling", "--out", "there.onnx"], "is there already"),
    ],
)
def test_bad_arguments_write_nothing(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.onnx").write_text("mine")
    assert run(["policy", "export", *arguments]) == 2
    assert words in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["there.onnx"]
    assert (tmp_path / "there.onnx").read_text() == "mine"
