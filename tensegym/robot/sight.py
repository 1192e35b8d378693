"""Sight: what there is to be seen of a robot at one time, for whatever draws it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.solids import Solid, solids
from tensegym.physics.geometry import points_at
from tensegym.physics.model import Model
from tensegym.physics.terrain import FLAT, Ground

from .robot import TensegrityRobot

FULL_SCALE = 60.0  # N, where the colours of tensions end
SLACK, SLACK_BELOW = (165, 170, 175), 0.01  # N: at rest the last bit decides whether a wound cable pulls
# Matplotlib's plasma up to where it grows too light for a white page: even steps in print, and for the colour-blind
_TAUT = np.array([[13, 8, 135], [126, 3, 168], [204, 71, 120], [248, 149, 64]], dtype=float)


class Sight(NamedTuple):
    """A robot and what is about it, in the world [m]."""

    solids: tuple[Solid, ...]
    poses: FloatArray
    """(b, 7) of the bodies."""
    cables: FloatArray
    """(c, 2, 3) ends."""
    tensions: FloatArray
    """(c,) [N]."""
    driven: slice
    """Rows of the wound cables."""
    length: float
    """Of the longest rod."""
    centre: FloatArray
    """(3,) of mass."""
    up: FloatArray = np.array([0.0, 0.0, 1.0])
    """(3,) against gravity, which on a slope is not across the ground."""
    ground: Ground | None = FLAT
    support: FloatArray | None = None
    """(3, 3) nodes of the face it stands on."""
    direction: FloatArray | None = None
    """(2,) unit vector that it is wanted to go along."""
    place: FloatArray | None = None
    """(2,) it is to go to."""
    path: FloatArray = np.zeros((0, 2))
    """(k, 2) it is to follow."""


def cable_ends(model: Model, poses: FloatArray) -> FloatArray:
    """(c, 2, 3) end points of every cable [m] at poses (b, 7)."""
    count = model.first_flexure
    bodies, points = model.spring_bodies[:count].ravel(), model.spring_params[:count, :6].reshape(-1, 3)
    return np.asarray(points_at(poses, bodies, points).reshape(count, 2, 3))


def upward(gravity: FloatArray) -> FloatArray:
    """(3,) unit vector against gravity (3,), the world's z axis without any."""
    size = float(np.linalg.norm(gravity))
    return -gravity / size if size else np.array([0.0, 0.0, 1.0])


def sight_of(robot: TensegrityRobot, direction: FloatArray | None = None) -> Sight:
    """A robot now, and the direction (2,) it is wanted to go along."""
    poses = robot.poses_in_world
    return Sight(
        solids(robot.design), poses, cable_ends(robot.model, poses), robot.tensions, robot.model.driven,
        robot.design.length, robot.centre_of_mass_in_world(), upward(robot.gravity), robot.world.scene.ground,
        direction=direction,
    )  # fmt: skip


def tension_colour(tension: float) -> tuple[int, int, int]:
    """Red, green, blue of a cable: grey when slack, else from blue over purple to orange at FULL_SCALE [N]."""
    if not tension > SLACK_BELOW:
        return SLACK
    red, green, blue = tension_colours(np.array([tension]))[0].astype(int).tolist()
    return red, green, blue


def tension_colours(tensions: FloatArray) -> FloatArray:
    """(c, 3) the same of many, 0 to 255."""
    stops = np.linspace(0, FULL_SCALE, len(_TAUT))
    colours = np.column_stack([np.interp(tensions, stops, part) for part in _TAUT.T])
    return np.where((tensions > SLACK_BELOW)[:, None], colours.round(), SLACK)
