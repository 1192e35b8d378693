"""Pictures of a robot: PyBullet's renderer for the bodies, the cables drawn over them, coloured by tension."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.physics.geometry import points_at

from .engines import camera_of
from .robot import TensegrityRobot

_TENSION_COLOURS = np.array([[150, 150, 150], [40, 120, 220], [240, 190, 30], [220, 40, 30]], dtype=float)
FULL_SCALE = 60.0  # N, the red end of the scale; grey is slack


def tension_colour(tension: float) -> tuple[int, int, int]:
    """Grey when slack, then blue over yellow to red at FULL_SCALE [N]."""
    if tension <= 0:
        r, g, b = _TENSION_COLOURS[0]
    else:
        stops = np.linspace(0, FULL_SCALE, len(_TENSION_COLOURS) - 1)
        r, g, b = (np.interp(tension, stops, _TENSION_COLOURS[1:, i]) for i in range(3))
    return int(r), int(g), int(b)


def cable_ends_in_world(robot: TensegrityRobot) -> FloatArray:
    """(c, 2, 3) end points of every cable [m], now."""
    count = len(robot.lengths)
    bodies, points = robot.model.spring_bodies[:count].ravel(), robot.model.spring_params[:count, :6].reshape(-1, 3)
    return points_at(robot.poses_in_world, bodies, points).reshape(count, 2, 3)


def render(robot: TensegrityRobot, width: int = 480, height: int = 360, yaw: float = 0.8) -> NDArray[np.uint8]:
    """(height, width, 3) picture that follows the robot; yaw [rad] is where the camera stands about it."""
    centre = robot.centre_of_mass_in_world()
    target = np.array([centre[0], centre[1], 0.35 * robot.design.length])
    distance = 3.0 * robot.design.length
    eye = target + distance * np.array([np.cos(yaw) * 0.9, np.sin(yaw) * 0.9, 0.45])
    rgb, clip = camera_of(robot.world).image(eye.tolist(), target.tolist(), width, height)
    image = rgb.copy()
    ends = cable_ends_in_world(robot)
    pixels = _project(ends.reshape(-1, 3), clip, width, height).reshape(-1, 2, 2)
    driven = range(*robot.model.driven.indices(len(robot.tensions)))
    for row in np.argsort(robot.tensions):
        thickness = 2 if row in driven else 1
        _line(image, pixels[row, 0], pixels[row, 1], tension_colour(robot.tensions[row]), thickness)
    return image


def draw_in_window(robot: TensegrityRobot) -> None:
    """Draw the cables into PyBullet's own window and let the camera follow."""
    colours = [[c / 255 for c in tension_colour(t)] for t in robot.tensions]
    camera = camera_of(robot.world)
    camera.draw_lines(cable_ends_in_world(robot), colours)
    camera.look_at(robot.centre_of_mass_in_world(), 3.0 * robot.design.length)


def _project(points: FloatArray, clip: FloatArray, width: int, height: int) -> FloatArray:
    """World points (p, 3) -> pixel columns and rows (p, 2); NaN behind the camera."""
    homogeneous = np.column_stack([points, np.ones(len(points))]) @ clip.T
    w = np.where(homogeneous[:, 3] > 0.05, homogeneous[:, 3], np.nan)
    return np.column_stack([
        (homogeneous[:, 0] / w + 1) / 2 * width, (1 - homogeneous[:, 1] / w) / 2 * height
    ])  # fmt: skip


def _line(image: NDArray[np.uint8], a: FloatArray, b: FloatArray, colour: tuple[int, int, int], thickness: int) -> None:
    if not np.isfinite([a, b]).all():
        return
    count = int(min(2 * max(image.shape), np.abs(b - a).max() * 2 + 2))
    points = np.linspace(a, b, count)
    for dx in range(thickness):
        for dy in range(thickness):
            cols, rows = (points + np.array([dx, dy])).round().astype(int).T
            inside = (cols >= 0) & (cols < image.shape[1]) & (rows >= 0) & (rows < image.shape[0])
            image[rows[inside], cols[inside]] = colour
