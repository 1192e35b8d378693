"""A recording is what the robot did, and a replay's page gives the same recording back."""

import dataclasses

import numpy as np
import pytest

from tensegym.design.design import flexible_design
from tensegym.design.parameters import Payload
from tensegym.errors import InputError, SimulationError
from tensegym.physics.terrain import Terrain
from tensegym.replay import Recorder, Recording, read_replay, write_replay
from tensegym.robot.robot import TensegrityRobot


def recorded(design=None, ground=True, looks=4):
    recorder = Recorder("a robot & <its> \"title\" </script>")
    with TensegrityRobot(design, dt=2e-3, ground=ground) as robot:
        robot.reset(2, heading=0.4)
        robot.slope(0.1, np.array([0.6, 0.8]))
        for _ in range(looks):
            recorder.look(robot)
            robot.command(0.2 * robot.command_limit)
            robot.step(10)
        recorder.look(robot)
        return recorder.recording(), robot.time, robot.node_positions_in_world(), robot.tensions.copy()


@pytest.fixture(scope="module")
def flexible():
    return recorded(flexible_design().with_(payload=Payload(mass=0.3)))


def test_the_last_row_is_the_robot_as_it_stands(flexible):
    recording, time, nodes, tensions = flexible
    assert recording.times[-1] == time and recording.seconds == pytest.approx(0.08)
    assert np.array_equal(recording.tensions[-1], tensions)
    assert np.allclose(recording.nodes[-1], nodes, atol=1e-15)
    assert recording.gravity @ [0.6, 0.8, 0] == pytest.approx(-9.81 * np.sin(0.1))


def test_a_page_gives_back_what_was_written(flexible, tmp_path):
    recording = flexible[0]
    write_replay(recording, tmp_path / "run.html")
    back = read_replay(tmp_path / "run.html")
    assert (back.title, back.engine, back.dt) == (recording.title, recording.engine, recording.dt)
    assert back.model.spring_params == pytest.approx(recording.model.spring_params)
    for name, array in recording.arrays().items():
        assert np.array_equal(back.arrays()[name], array.astype("<f4").astype(float), equal_nan=True), name
    assert recording.title not in (tmp_path / "run.html").read_text()


def test_rough_ground_is_kept_where_the_robot_went(tmp_path):
    recording = recorded(ground=Terrain(0.02, reach=6.0))[0]
    whole = Terrain(0.02, reach=6.0)
    assert len(recording.ground.heights) * whole.cell < 7
    write_replay(recording, tmp_path / "run.html")
    assert read_replay(tmp_path / "run.html").ground.heights == pytest.approx(recording.ground.heights, abs=1e-7)


def test_a_long_episode_is_kept_at_half_the_rate(monkeypatch):
    monkeypatch.setattr("tensegym.replay.recorder.MOST", 6)
    recording = recorded(looks=8)[0]
    assert len(recording.times) <= 6
    assert recording.times[0] == 0 and recording.times[-1] == pytest.approx(0.16)


def test_what_does_not_fit_is_refused(flexible, tmp_path):
    recording = flexible[0]
    for change in ({"times": recording.times[::-1]}, {"times": recording.times[:3]}, {"poses": recording.poses[:, 1:]},
                   {"tensions": np.full_like(recording.tensions, np.nan)}):  # fmt: skip
        with pytest.raises(InputError):
            dataclasses.replace(recording, **change)
    with pytest.raises(InputError, match=r"ends in \.html"):
        write_replay(recording, tmp_path / "run.mp4")
    with pytest.raises(FileNotFoundError):
        write_replay(recording, tmp_path / "none" / "run.html")
    assert not list(tmp_path.iterdir())
    with pytest.raises(SimulationError, match="nothing was recorded"):
        Recorder().recording()


@pytest.mark.parametrize("damage", [
    lambda text: text.replace('id="recording"', 'id="other"'), lambda text: text[: text.index('plain">') + 300],
    lambda text: text.replace('plain">e', 'plain">f'), lambda text: text.replace('plain">', 'plain">A'),
    lambda text: "", lambda text: text.replace('plain">eN', 'plain">"></script>'),
])  # fmt: skip
def test_a_damaged_page_is_one_clear_line(flexible, tmp_path, damage):
    path = tmp_path / "run.html"
    write_replay(flexible[0], path)
    path.write_text(damage(path.read_text()))
    with pytest.raises(InputError, match=r"run\.html: "):
        read_replay(path)


def test_recording_is_of_the_present_episode():
    recorder = Recorder()
    with TensegrityRobot(dt=2e-3) as robot:
        for face in (0, 1):
            robot.reset(face)
            robot.step(5)
            recorder.look(robot, face=face)
    recording = recorder.recording()
    assert isinstance(recording, Recording) and recording.faces.tolist() == [1]
