"""`tensegym export`: what it writes, read back by others."""

import mujoco
import numpy as np
import pybullet
import pytest

from tensegym.design.design_file import as_design, design_to_dict, load_design
from tensegym.mujoco.robot_mjcf import cable_names, robot_mjcf
from tensegym.robot.robot import TensegrityRobot
from tests.conftest import assert_refused

PAYLOAD = 'preset = "six_rod"\n[payload]\nmass = 0.5\n'


@pytest.fixture
def design_file(tmp_path):
    (tmp_path / "carrier.toml").write_text(PAYLOAD)
    return tmp_path / "carrier.toml"


@pytest.mark.parametrize("preset", ["six_rod", "six_rod_flexible", "payload"])
def test_mjcf_loads_in_plain_mujoco_and_settles_at_our_height(cli, tmp_path, design_file, preset):
    design = design_file if preset == "payload" else preset
    status, text, _ = cli("export", design, "--to", "mjcf", "--out", tmp_path / "out", "--face", "3-5-12")
    assert status == 0
    assert "robot.xml" in text
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / "robot.xml"))
    data = mujoco.MjData(model)
    with TensegrityRobot(as_design(str(design))) as robot:
        robot.reset(robot.faces.names().index("3-5-12"))
        robot.step(2000)
        mujoco.mj_step(model, data, nstep=2000)
        assert model.opt.timestep == 1e-3
        assert model.body_mass.sum() == pytest.approx(robot.design.mass, rel=1e-12)
        assert data.subtree_com[0, 2] == pytest.approx(robot.centre_of_mass_in_world()[2], abs=1e-3)
    back = load_design(tmp_path / "out" / "design.toml")
    assert design_to_dict(back) == design_to_dict(as_design(str(design)))


@pytest.mark.parametrize("preset", ["six_rod", "six_rod_flexible", "paper"])
def test_cables_and_winches_of_the_mjcf_pull_as_ours_do(preset):
    design = as_design(preset)
    with TensegrityRobot(design, dt=1e-5, ground=False) as robot:
        model = mujoco.MjModel.from_xml_string(robot_mjcf(design, robot.poses_in_world, ground=False))
        data = mujoco.MjData(model)
        data.ctrl[:] = np.linspace(0, 0.02, len(robot.drives))  # wound in [m]
        robot.natural_lengths[robot.model.driven] -= data.ctrl
        robot.step()
        mujoco.mj_forward(model, data)
        names = [model.tendon(i).name for i in range(model.ntendon)]
        assert names == cable_names(design)
        np.testing.assert_allclose(data.ten_length, robot.lengths, atol=1e-12)
        np.testing.assert_allclose(-data.actuator_force, robot.tensions[robot.model.driven], atol=1e-6)
        firsts = [model.body(f"rod_{a}_{b}").dofadr[0] for a, b in design.structure.rods + 1]
        pulled = robot.velocities_in_world()[: len(firsts), :3] / robot.dt
        np.testing.assert_allclose([data.qacc[at : at + 3] for at in firsts], pulled, atol=1e-4 * np.abs(pulled).max())
        data.ctrl[:] = 0  # slack now, and a winch does not push
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.actuator_force, 0, atol=1e-9)


def test_urdf_loads_in_pybullet(cli, tmp_path):
    status, _, _ = cli("export", "six_rod_flexible", "--to", "urdf", "--out", tmp_path / "out")
    assert status == 0
    client = pybullet.connect(pybullet.DIRECT)
    try:
        joints = {file.name: pybullet.getNumJoints(pybullet.loadURDF(str(file), physicsClientId=client),
                                                   physicsClientId=client)
                  for file in (tmp_path / "out").glob("*.urdf")}  # fmt: skip
    finally:
        pybullet.disconnect(client)
    assert joints == {"active_rod.urdf": 0, "passive_rod_split.urdf": 1}


def test_a_path_that_exists_is_refused_and_left_alone(cli, tmp_path):
    (tmp_path / "out").write_text("mine")
    assert_refused(cli("export", "six_rod", "--out", tmp_path / "out"), "is there already", "--out")
    assert (tmp_path / "out").read_text() == "mine"


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["six_rod", "--to", "sdf"], ["to = 'sdf' is not one of mjcf, urdf"]),
        (["seven_rod"], ["unknown preset 'seven_rod'"]),
        (["six_rod", "--face", "1-2-3"], ["1-2-3"]),
        (["six_rod", "--out", "nowhere/out"], ["no folder nowhere"]),
    ],
)
def test_bad_input(cli, tmp_path, monkeypatch, argv, words):
    monkeypatch.chdir(tmp_path)
    assert_refused(cli("export", *argv), *words)
    assert not list(tmp_path.iterdir())
