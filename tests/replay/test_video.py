"""Pictures show what a recording says; a video is as long as what it shows."""

import dataclasses

import numpy as np
import pytest

from tensegym.physics.box import Box
from tensegym.physics.terrain import FLAT
from tensegym.replay import Recorder
from tensegym.replay.gait_figure import draw_gait
from tensegym.replay.retake import median_of
from tensegym.replay.video import FRAMES_PER_SECOND, frame, sight_at, write_video
from tensegym.robot.picture import picture
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.sight import tension_colour


@pytest.fixture(scope="module")
def recording():
    recorder = Recorder()
    with TensegrityRobot(dt=2e-3) as robot:
        for _ in range(21):
            recorder.look(robot, face=0)
            robot.step(10)
    return recorder.recording()


def coloured(image, colour):
    return int((np.abs(image.astype(int) - colour) <= 1).all(axis=2).sum())


def test_an_arrow_points_where_it_is_to_go(recording):
    wanted = dataclasses.replace(recording, directions=np.tile([0.6, 0.8], (len(recording.times), 1)))
    blue = (0, 114, 178)
    assert coloured(picture(sight_at(recording, 3)), blue) == 0
    assert coloured(picture(sight_at(wanted, 3)), blue) > 100


def test_the_ground_slopes_as_gravity_says(recording):
    """Upright in the picture is against gravity: a slope turns the ground, and so the robot on it."""
    leaning = dataclasses.replace(recording, gravity=np.array([-2.0, 1.0, -9.0]))
    assert (picture(sight_at(leaning, 0)) != picture(sight_at(recording, 0))).mean() > 0.05


def test_a_box_hides_what_is_behind_it(recording):
    sight = sight_at(recording, 0)
    toward = np.array([np.cos(0.8), np.sin(0.8)])  # where the camera stands, yaw 0.8, before axes are turned
    places = [0.55 * np.array([c, s]) for c, s in (toward, -toward, (-toward[1], toward[0]), (toward[1], -toward[0]))]
    shares = []
    for x, y in places:
        box = Box.between((x - 0.2, y - 0.2, 0.0), (x + 0.2, y + 0.2, 1.2))
        image = picture(sight._replace(ground=FLAT.holding([box])))
        shares.append(coloured(image, tension_colour(float(sight.tensions.max()))))
    bare = coloured(picture(sight), tension_colour(float(sight.tensions.max())))
    assert min(shares) < 0.6 * bare <= max(shares) * 1.2


def test_the_clock_and_the_numbers_are_written(recording):
    plain, written = picture(sight_at(recording, 5), 640, 480), frame(recording, 5, numbers=True)
    assert (plain[:40, :200] != written[:40, :200]).any()
    assert coloured(written, (17, 17, 17)) > coloured(plain, (17, 17, 17)) + 100


def test_a_video_plays_at_true_speed(recording, tmp_path):
    imageio = pytest.importorskip("imageio.v3")
    write_video(recording, tmp_path / "run.mp4")
    frames = imageio.imread(tmp_path / "run.mp4", plugin="FFMPEG")
    assert len(frames) == pytest.approx(recording.seconds * FRAMES_PER_SECOND, abs=1)


def test_a_gait_is_drawn_of_a_robot_that_stood_still(recording, tmp_path):
    draw_gait(recording, [0.1], tmp_path / "gait.png")
    assert (tmp_path / "gait.png").stat().st_size > 20_000


@pytest.mark.parametrize("speeds, index", [([3.0, 1.0, 2.0], 2), ([4.0, 1.0, 2.0, 3.0], 2), ([0.5], 0)])
def test_the_median_episode_is_the_slower_of_two(speeds, index):
    assert median_of(speeds) == index
