"""Surroundings: the ground, level or sloping, flat or bumpy, and where the robot is to go."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.physics.terrain import Ground
from tensegym.robot.sight import upward
from tensegym.robot.surface import draped, on_top

from .frame import Frame, Stage
from .page import Page, linear

_MOST_ROWS = 301  # of bumps that are drawn, about the origin
_GOAL, _PATH, _EARTH = (213, 94, 0), (230, 159, 0), (200, 200, 195)


class Surroundings:
    """All that stands around a robot, under the frame ``/world``: the frame of all its readings.

    On a slope that frame is tilted, so that down in the page is where gravity points.
    """

    def __init__(self, page: Page, stage: Stage) -> None:
        length = stage.design.length
        light(page)
        self._turn = tilt(stage.gravity)
        self._offset = np.zeros(3)
        x, y, z, w = self._turn.as_quat()
        self._world = page.scene.add_frame("/world", show_axes=False, wxyz=(w, x, y, z))
        self._ground: Any = None
        if stage.ground is not None and stage.ground.rough:
            self._ground = _bumps(page, stage.ground)
        elif stage.ground is not None:
            self._ground = page.scene.add_grid(
                "/world/ground", infinite_grid=True, cell_size=length / 2, section_size=length,
                fade_distance=25 * length, cell_color=(215, 215, 215), section_color=(170, 170, 170),
                plane_color=(248, 248, 246), plane_opacity=0.9,
            )  # fmt: skip
        for number, box in enumerate(stage.ground.obstacles if stage.ground else ()):
            x, y, z, w = box.turn
            page.scene.add_box(f"/world/box {number}", _EARTH, tuple(2 * half for half in box.half), wxyz=(w, x, y, z),
                               position=box.centre)  # fmt: skip
        if len(stage.path) > 1:
            points = draped(stage.ground, stage.path, 0.1 * length) + _raised(0.005)
            page.scene.add_line_segments("/world/path", np.stack([points[:-1], points[1:]], axis=1), _PATH,
                                         thickness=0.01 * length)  # fmt: skip
        self._arrow = page.scene.add_arrows(
            "/world/direction", np.zeros((1, 2, 3)), linear(_GOAL), shaft_radius=0.012 * length,
            head_radius=0.03 * length, head_length=0.08 * length, visible=False,
        )  # fmt: skip
        self._place = page.scene.add_cylinder("/world/place", 0.06 * length, 0.01 * length, _GOAL, visible=False)
        self._length, self._stage = length, stage

    def draw(self, frame: Frame, centre: FloatArray) -> None:
        """Show where a frame's robot, whose centre of mass (3,) is given [m], is to go."""
        there, along = bool(np.isfinite(frame.place).all()), bool(np.isfinite(frame.direction).all())
        self._place.visible, self._arrow.visible = there, along
        if there:
            self._place.position = tuple(on_top(self._stage.ground, frame.place[None])[0] + _raised(0.005))
        if along:
            self._arrow.points = self._ahead(centre[:2], frame.direction)[None]

    def _ahead(self, centre: FloatArray, direction: FloatArray) -> FloatArray:
        """(2, 3) a straight arrow from before the robot, as low as it lies on ground and boxes [m]."""
        ends = centre + self._length * np.array([[0.7], [1.05]]) * direction
        laid = draped(self._stage.ground, ends, 0.05 * self._length)
        tilted = np.linspace(laid[0], laid[-1], len(laid))
        return laid[[0, -1]] + _raised(0.01 + float((laid[:, 2] - tilted[:, 2]).max()))

    def follow(self, centre: FloatArray) -> None:
        """Bring a point (3,) of the world [m] to the page's middle: the world is moved, whatever the cameras do."""
        self._offset = -self._turn.apply([centre[0], centre[1], 0.0])
        self._world.position = tuple(self._offset)

    def place_of(self, origin: FloatArray, direction: FloatArray) -> FloatArray | None:
        """Where on z = 0 (2,) [m] a ray of the page meets the ground; None where it meets none."""
        origin, direction = self._turn.inv().apply(np.stack([np.asarray(origin) - self._offset, direction]))
        if direction[2] > -1e-3:  # along the ground, or up
            return None
        return np.asarray((origin - origin[2] / direction[2] * direction)[:2])

    def remove(self) -> None:
        """Take all of it, and the robot, out of the page."""
        self._world.remove()


def _raised(height: float) -> FloatArray:
    return np.array([0.0, 0.0, height])


def light(page: Page) -> None:
    """Plain light: viser's own whitens every colour, and its shadows cost a page without a GPU most of its pictures."""
    page.scene.configure_default_lights(enabled=False)
    page.scene.configure_environment_map(None)
    page.scene.add_light_ambient("/ambient", intensity=1.6)
    page.scene.add_light_directional("/sun", intensity=1.6, position=(1.0, -2.0, 3.0), cast_shadow=False)


def tilt(gravity: FloatArray) -> Rotation:
    """From a robot's world to the page, in which gravity (3,) points down; the shortest turn."""
    up = upward(gravity)
    axis = np.cross(up, [0.0, 0.0, 1.0])
    sine = float(np.linalg.norm(axis))
    return Rotation.from_rotvec(axis / sine * np.arctan2(sine, up[2]) if sine > 1e-12 else np.zeros(3))


def _bumps(page: Page, ground: Ground) -> Any:
    heights = ground.heights
    cut = max(0, (len(heights) - _MOST_ROWS) // 2)
    heights = heights[cut : len(heights) - cut, cut : len(heights) - cut]
    count = len(heights)
    at = (np.arange(count) - (count - 1) / 2) * ground.cell
    x, y = np.meshgrid(at, at, indexing="ij")
    corner = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    return page.scene.add_mesh_simple("/world/ground", np.column_stack([x.ravel(), y.ravel(), heights.ravel()]), faces,
                                      color=_EARTH, flat_shading=True)  # fmt: skip
