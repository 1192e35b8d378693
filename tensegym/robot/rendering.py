"""Pictures of a robot now, and its cables in PyBullet's own window."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray

from .engines import window_of
from .picture import picture
from .robot import TensegrityRobot
from .sight import FULL_SCALE, cable_ends, sight_of, tension_colour

__all__ = ["FULL_SCALE", "draw_in_window", "render", "tension_colour"]


def render(
    robot: TensegrityRobot, width: int = 480, height: int = 360, yaw: float = 0.8, direction: FloatArray | None = None
) -> NDArray[np.uint8]:
    """(height, width, 3) picture that follows the robot, cables coloured by tension.

    yaw [rad] is where the camera stands about it, direction (2,) the one it is wanted to go along, shown as an arrow.
    """
    return picture(sight_of(robot, direction), width, height, yaw)


def draw_in_window(robot: TensegrityRobot) -> None:
    """Draw the cables into PyBullet's own window and let the camera follow."""
    colours = [[c / 255 for c in tension_colour(t)] for t in robot.tensions]
    window = window_of(robot.world)
    window.draw_lines(cable_ends(robot.model, robot.poses_in_world), colours)
    window.look_at(robot.centre_of_mass_in_world(), 3.0 * robot.design.length)
