"""What a picture of a robot among boxes shows."""

import numpy as np
import pytest

from tensegym import TensegrityRobot
from tensegym.physics.box import Box
from tensegym.physics.terrain import FLAT
from tensegym.robot.picture import picture
from tensegym.robot.sight import sight_of

AHEAD = np.array([1.0, 0.0])


@pytest.fixture(scope="module")
def sight():
    with TensegrityRobot() as robot:
        return sight_of(robot, AHEAD)


def blue(sight, yaw=0.8):
    """Pixels of the arrow's colour."""
    image = picture(sight, yaw=yaw).astype(int)
    return int(np.sum((image[..., 2] - image[..., 0] > 110) & (image[..., 1] > 80)))


def standing_on(sight, *boxes):
    """The sight, lifted by 0.3 m, with boxes in the ground."""
    lift = np.array([0.0, 0.0, 0.3])
    poses = sight.poses.copy()
    poses[:, :3] += lift
    return sight._replace(poses=poses, cables=sight.cables + lift, centre=sight.centre + lift,
                          ground=FLAT.holding(boxes))  # fmt: skip


@pytest.mark.parametrize("yaw", [0.8, 2.4, 4.0, 5.6])
def test_the_arrow_is_seen_on_a_box_as_on_the_ground(sight, yaw):
    deck = Box.between((-3.0, -3.0, -0.3), (3.0, 3.0, 0.3))
    bare, on_deck = blue(sight, yaw), blue(standing_on(sight, deck), yaw)
    assert bare > 100
    assert on_deck == pytest.approx(bare, rel=0.25)
    assert blue(standing_on(sight, deck)._replace(direction=None), yaw) < 0.1 * bare


@pytest.mark.parametrize("yaw", np.arange(0.0, 6.2, 0.5))
def test_the_arrow_stays_in_the_picture_whichever_way_it_points(sight, yaw):
    """A margin of empty pixels: its strokes are blue, which nothing else at the edge is."""
    image = picture(sight, yaw=yaw).astype(int)
    seen = (image[..., 2] - image[..., 0] > 110) & (image[..., 1] > 80)
    assert seen.any() and not (seen[:2].any() or seen[-2:].any() or seen[:, :2].any() or seen[:, -2:].any())


def test_what_of_a_box_is_in_the_ground_is_not_seen(sight):
    high = Box.between((0.8, -0.5, -0.001), (1.2, 0.5, 0.1))
    deep = Box.between((0.8, -0.5, -0.6), (1.2, 0.5, 0.1))
    shown = [picture(sight._replace(ground=FLAT.holding([box]))).astype(int) for box in (high, deep)]
    assert np.mean(np.abs(shown[0] - shown[1]).max(axis=2) > 30) < 1e-3


def test_a_foot_on_a_box_is_in_front_of_it(sight):
    """A large box below hides nothing of the robot."""
    deck, far = Box.between((-3.0, -3.0, -0.3), (3.0, 3.0, 0.3)), Box.between((-90.0, 90.0, 0.0), (-89.0, 91.0, 0.1))

    def red(of):
        image = picture(of._replace(direction=None)).astype(int)
        return int(np.sum(image[..., 0] - image[..., 2] > 100))

    assert red(standing_on(sight, deck)) == pytest.approx(red(standing_on(sight, far)), rel=0.02)
