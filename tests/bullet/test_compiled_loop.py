"""The compiled substep loop against the Python calls, which are the reference; and where it cannot work."""

from importlib.metadata import PackageNotFoundError
from pathlib import Path

import numpy as np
import pytest

from tensegym.bullet import c_interface, state_buffer
from tensegym.bullet.state_buffer import NONE
from tensegym.design.design import Payload, RobotDesign, flexible_design
from tensegym.errors import SimulationError
from tensegym.physics.terrain import Terrain
from tensegym.robot.robot import TensegrityRobot

needs_symbols = pytest.mark.skipif(not c_interface.AVAILABLE, reason="this PyBullet has no symbol table")


def roll(design: RobotDesign, dt: float, compiled: bool, ground: bool | Terrain = True) -> tuple[np.ndarray, ...]:
    """2,000 substeps of random commands on the ground, feet and rods in contact: the whole state after them."""
    rng = np.random.default_rng(1)
    with TensegrityRobot(design, dt=dt, compiled=compiled, ground=ground) as robot:
        robot.reset(0, 0.3)
        for _ in range(20):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            robot.step(100)
        account = np.array(list(vars(robot.totals()).values()))
        return (robot.poses_in_world.copy(), robot.velocities_in_world(), robot.tensions.copy(), robot.lengths.copy(),
                robot.drives.copy(), robot.flexure_angles.copy(), account)  # fmt: skip


@needs_symbols
@pytest.mark.parametrize(
    ("design", "dt"),
    [(RobotDesign(), 1e-3), (RobotDesign(payload=Payload()), 2e-3), (flexible_design(), 1e-3)],
    ids=["explicit", "implicit with payload", "split rods"],
)
def test_both_loops_give_the_same_bits(design, dt):
    for compiled, python in zip(roll(design, dt, True), roll(design, dt, False), strict=True):
        np.testing.assert_array_equal(compiled, python)


@needs_symbols
def test_both_loops_give_the_same_bits_on_rough_ground():
    rough = Terrain(roughness=0.05, reach=3.0)
    for compiled, python in zip(roll(RobotDesign(), 2e-3, True, rough), roll(RobotDesign(), 2e-3, False, rough),
                                strict=True):  # fmt: skip
        np.testing.assert_array_equal(compiled, python)


@needs_symbols
def test_a_closed_world_is_an_error_and_not_a_crash():
    robot = TensegrityRobot(compiled=True)
    robot.close()
    with pytest.raises(SimulationError, match="closed"):
        robot.step()


@needs_symbols
def test_a_handle_is_given_only_for_the_client_meant():
    with TensegrityRobot(compiled=True) as robot:
        client, total, *_ = robot.world.hand_over()
        assert c_interface.client_handle(client, total) != 0
        assert c_interface.client_handle(client, total + 1) == 0  # another world, or a body gone
        for nobody in (client + 1, -1, 10**6):
            assert c_interface.client_handle(nobody, total) == 0


@needs_symbols
def test_states_are_read_where_the_engine_writes_them_or_else_copied():
    with TensegrityRobot(flexible_design(), compiled=True) as robot:
        robot.step(20)
        client, total, window, bodies, pinned = robot.world.hand_over()
        poses, angles = robot.world.poses, robot.world.angles
        assert window.all()
        handle = c_interface.client_handle(client, total)
        there, copied = np.zeros((2, *poses.shape))
        bends = np.zeros((2, len(angles)))
        assert c_interface.read_states(handle, window, bodies, pinned, there, bends[0])
        assert c_interface.read_states(handle, NONE, bodies, pinned, copied, bends[1])
        np.testing.assert_array_equal(there, copied)
        np.testing.assert_array_equal(bends[0], bends[1])
        unknown = np.array([bodies[0], 77], dtype=np.int32)
        for place in (window, NONE):
            assert not c_interface.read_states(handle, place, unknown, pinned[:0], there, bends[0])


@needs_symbols
def test_without_a_window_the_states_are_copied(monkeypatch):
    monkeypatch.setattr(state_buffer, "_MEMORY", Path("/nonexistent"))
    with TensegrityRobot(compiled=True) as robot, TensegrityRobot(compiled=False) as reference:
        assert not robot.world.hand_over().window.any()
        for each in (robot, reference):
            each.step(50)
        np.testing.assert_array_equal(robot.poses_in_world, reference.poses_in_world)


@pytest.mark.parametrize(
    ("installed", "known"),
    [({"pybullet": "3.2.7"}, True), ({"pybullet-arm64": "3.2.8"}, True), ({"pybullet": "3.3.0"}, False),
     ({"pybullet-arm64": "3.2.9"}, False), ({}, False)],
)  # fmt: skip
def test_only_known_versions_are_called_past_python(monkeypatch, installed, known):
    """Another one's functions may take other things, and its states lie elsewhere."""

    def version(name):
        if name not in installed:
            raise PackageNotFoundError(name)
        return installed[name]

    monkeypatch.setattr(c_interface, "version", version)
    assert c_interface.known_version() is known
    if not known:
        assert not c_interface._bind()


def test_without_the_symbols_python_does_it(monkeypatch):
    monkeypatch.setattr(c_interface, "AVAILABLE", False)
    with TensegrityRobot() as robot:
        assert not robot.world.compiled
        robot.step(3)
        assert robot.time == pytest.approx(3e-3)
    with pytest.raises(SimulationError, match="symbol table"):
        TensegrityRobot(compiled=True)


def test_another_file_format_is_refused(tmp_path):
    file = tmp_path / "engine.so"
    file.write_bytes(b"MZ" + bytes(100))
    with pytest.raises(ValueError, match="ELF"):
        c_interface.local_symbols(file, ("getPhysicsClient",))
