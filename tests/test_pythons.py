"""One package for Python 3.11 to 3.13: which engine each gets, and that the robot moves by the same bits on all."""

import hashlib
import platform
import subprocess
import sys
import tomllib
from importlib.metadata import distributions
from pathlib import Path

import numpy as np
import pytest
from packaging.requirements import Requirement

from tensegym.design.design import RobotDesign
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation.setting import setting

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]

def plain(name):
    return name.lower().replace("_", "-")


ENGINES = [r for r in map(Requirement, PROJECT["dependencies"]) if r.name.startswith("pybullet")]
POSES = {1e-3: "b9436f6a91055682", 2e-3: "74cb3d630565d4be"}
"""Start of the SHA-256 of 2,000 substeps' poses, by time step [s]: on Python 3.11.7 with pybullet 3.2.7, on 3.12.1 and
3.13.0 with pybullet-arm64 3.2.8, on an Intel Xeon, with machine code made for it and for any x86_64 processor."""


@pytest.mark.parametrize(("python", "engine"), [("3.11", "pybullet"), ("3.12", "pybullet-arm64"),
                                                ("3.13", "pybullet-arm64")])  # fmt: skip
def test_every_python_gets_one_engine(python, engine):
    wanted = [r.name for r in ENGINES if r.marker is None or r.marker.evaluate({"python_version": python})]
    assert wanted == [engine]


def test_here_is_one_engine_and_it_is_named():
    names = {r.name for r in ENGINES}
    (engine,) = [f"{plain(d.name)} {d.version}" for d in distributions() if plain(d.name) in names]
    assert engine in setting()
    assert f"Python {platform.python_version()}" in setting()


@pytest.mark.skipif(
    (sys.platform, platform.machine()) != ("linux", "x86_64"),
    reason="the bits are those of the wheels for x86_64 Linux; other compilers round otherwise",
)
@pytest.mark.parametrize("dt", POSES)
def test_two_thousand_poses_are_the_same_bits(dt):
    """Rigid rods only: those that bend differ in the last bit with a processor's fused multiply-add."""
    rng, digest = np.random.default_rng(1), hashlib.sha256()
    with TensegrityRobot(RobotDesign(), dt=dt) as robot:
        robot.reset(0, 0.3)
        for _ in range(20):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            for _ in range(100):
                robot.step()
                digest.update(robot.poses_in_world.tobytes())
    assert digest.hexdigest().startswith(POSES[dt])


@pytest.mark.parametrize("version", [(3, 10), (3, 14)])
def test_make_says_in_one_line_what_to_do_about_another_python(version, tmp_path):
    python = tmp_path / "python"
    pretend = f"import sys; sys.version_info = {version}; exec(sys.argv[1])"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" -c "{pretend}" "$2"\n')
    python.chmod(0o755)
    done = subprocess.run(["make", "-s", "setup", f"VENV={tmp_path}/venv", f"PYTHON={python}"], cwd=ROOT,
                          capture_output=True, text=True)  # fmt: skip
    first, *rest = done.stderr.strip().splitlines()
    assert f"Python {version[0]}.{version[1]} has no PyBullet wheel" in first
    assert "make PYTHON=/path/to/python3.13" in first
    assert len(rest) == 1  # make's own
    assert not (tmp_path / "venv").exists()
