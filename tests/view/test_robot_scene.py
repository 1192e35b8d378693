"""A robot in a page is where it is in its world, in the colours that it has in pictures."""

import numpy as np
import pytest

pytest.importorskip("viser", reason="no viser here: pip install '.[view]'")
from tensegym.design.solids import middles, solids
from tensegym.robot.sight import tension_colours
from tensegym.view.frame import Stage
from tensegym.view.page import Page, linear
from tensegym.view.player import frame_at
from tensegym.view.robot_scene import RobotScene


def shown(colours):
    """sRGB of linear light, as a browser shows it."""
    share = np.asarray(colours) / 255
    return 255 * np.where(share <= 0.0031308, 12.92 * share, 1.055 * share ** (1 / 2.4) - 0.055)


def test_linear_light_is_shown_as_the_colour_that_was_meant():
    colours = np.array([[0, 0, 0], [255, 255, 255], [213, 94, 0], [64, 64, 76], [126, 3, 168]])
    assert shown(linear(colours)) == pytest.approx(colours, abs=4)
    assert linear([188, 188, 188]).tolist() == [128, 128, 128]  # half of the light


@pytest.mark.parametrize("aside", [0.0, 1.5])
def test_all_parts_are_where_the_frame_says(recording, aside):
    stage = Stage(recording.design, recording.ground, recording.gravity, recording.path)
    frame = frame_at(recording, 0.5)
    frame = frame._replace(poses=frame.poses + np.array([3.0, -2.0, 0, 0, 0, 0, 0]))
    with Page("tensegym", port=0) as page:
        scene = RobotScene(page, stage, aside=aside)
        scene.draw(frame)
        root = np.array(scene.root.position)
        balls = [k for k, solid in enumerate(solids(recording.design)) if solid.kind == "sphere"]
        places = root + scene._batches["sphere"].batched_positions
        wanted = middles(solids(recording.design), frame.poses)[balls]
        assert places - wanted == pytest.approx(np.tile([0, aside, 0], (len(balls), 1)), abs=1e-6)
        assert root + scene._centre.position - scene.centre == pytest.approx([0, aside, 0])
        assert np.abs(scene._batches["sphere"].batched_positions[:, :2]).max() < recording.design.length
        assert shown(scene._cables.batched_colors) == pytest.approx(tension_colours(frame.tensions), abs=6)
