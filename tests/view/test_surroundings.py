"""Where the robot is to go is shown on what it will meet there."""

import numpy as np
import pytest

pytest.importorskip("viser", reason="no viser here: pip install '.[view]'")
from tensegym import RobotDesign
from tensegym.physics.box import Box
from tensegym.physics.terrain import FLAT
from tensegym.robot.surface import on_top
from tensegym.view.frame import Frame, Stage
from tensegym.view.page import Page
from tensegym.view.surroundings import Surroundings

BAR = Box.between((0.6, -2.0, -0.2), (0.7, 2.0, 0.15))


@pytest.mark.parametrize("boxes, top", [((), 0.0), ((BAR,), 0.15)])
def test_arrow_and_place_are_above_boxes(boxes, top):
    ground = FLAT.holding(boxes)
    frame = Frame(0.0, *[np.zeros(0)] * 6, np.array([1.0, 0.0]), np.array([0.65, 0.0]), 0)
    with Page("tensegym", port=0) as page:
        shown = Surroundings(page, Stage(RobotDesign(), ground, np.array([0, 0, -9.81]), np.zeros((0, 2))))
        shown.draw(frame, np.zeros(3))
        ends = np.asarray(shown._arrow.points)[0]
        along = np.linspace(ends[0], ends[1], 50)
        clear = along[:, 2] - on_top(ground, along[:, :2])[:, 2]
        assert 0 < clear.min() < 0.02
        assert top < shown._place.position[2] < top + 0.01
