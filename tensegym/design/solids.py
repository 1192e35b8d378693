"""Solids: what is seen of a design, as plain shapes on the rows of a robot's poses; for whatever draws one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray

from .bodies import Kind, Link, design_bodies
from .design import RobotDesign


class Solid(NamedTuple):
    """A shape about the z axis of a body."""

    kind: Kind
    size: tuple[float, ...]
    """[m], as that of `tensegym.design.bodies.Shape`."""
    body: int
    """Row of the robot's poses (`tensegym.robot.robot_state.RobotState`)."""
    z: float
    """Of its middle, from the body's centre of mass [m]."""
    colour: tuple[float, float, float, float]
    """Red, green, blue and opacity, from 0 to 1."""


def solids(design: RobotDesign) -> tuple[Solid, ...]:
    """What is seen of a robot: tubes, end masses, leaves and the payload."""
    bodies = design_bodies(design)
    links = [body.link for body in bodies] + [body.second for body in bodies if body.second]
    return tuple(solid for row, link in enumerate(links) for solid in _seen(row, link))


def _seen(row: int, link: Link) -> list[Solid]:
    found = []
    for shape in link.shapes:
        if shape.colour:
            red, green, blue, opacity = map(float, shape.colour.split())
            found.append(Solid(shape.kind, shape.size, row, shape.z - link.centre, (red, green, blue, opacity)))
    return found


def middles(shown: tuple[Solid, ...], poses: FloatArray) -> FloatArray:
    """(k, 3) where the middles of solids are in the world [m], at poses (b, 7)."""
    rows = [solid.body for solid in shown]
    x, y, z, w = poses[rows, 3:].T
    axes = np.column_stack([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)])
    return np.asarray(poses[rows, :3] + axes * np.array([solid.z for solid in shown])[:, None])
