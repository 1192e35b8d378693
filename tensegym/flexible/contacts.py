"""Contacts with the ground, foreseen: which points the engine will stop in the coming step, for the springs to know.

A point at the gap d above the ground may move down by d in one step and no more: J (v + dt a) >= -d / dt along its
normal, and not along the ground unless that takes more than the friction: then Coulomb's force stands in its place. The
set is found by trial: points that would pass the ground are added, points that would have to be pulled are dropped. The
engine's own solution is what counts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.bullet import Articulated

from .step_kernel import add_load
from .tree import Tree

WEIGHT = 1e4  # of the robot's mass: what is held gives by a ten-thousandth
REACH = 0.05  # m; points farther from the ground are not asked for
PASSES = 4


@dataclass
class Point:
    """One candidate."""

    jacobian: FloatArray
    """(n,) velocity along the normal."""
    sideways: FloatArray
    """(2, n) velocities along the ground."""
    gap: float
    """[m], never negative."""
    active: bool
    slip: FloatArray | None = None
    """(n,) generalised friction force of a point that slides; None of one that sticks."""


def candidates(body: Articulated, ground: int, tree: Tree, base: FloatArray, q: FloatArray, count: int) -> list[Point]:
    """Points of the body near the ground; active are those that carried a load in the last step."""
    near = body.near(ground, REACH)
    if not near:
        return []
    loaded = {row[3] for row in body.contact_forces() if row[2] == ground and row[9] > 0}
    points = []
    for row in near:
        place, normal = np.array(row[5]), np.array(row[7])
        side = np.cross(normal, [1.0, 0.0, 0.0] if abs(normal[0]) < 0.9 else [0.0, 1.0, 0.0])
        side /= np.linalg.norm(side)
        rows = np.zeros((3, count))
        for direction, out in zip((normal, side, np.cross(normal, side)), rows, strict=True):
            add_world_load(tree, base, q, row[3] + 1, direction, place, out)
        points.append(Point(rows[0], rows[1:], max(float(row[8]), 0.0), row[3] in loaded))
    return points


def add_world_load(tree: Tree, base: FloatArray, q: FloatArray, link: int, force: FloatArray, place: FloatArray,
                   out: FloatArray) -> None:  # fmt: skip
    """Add to out (n,) a force at a point in the world."""
    zero = np.zeros(3)
    origin = add_load(tree, base, q, link, zero, zero, zero, np.zeros_like(out))
    # a force at the origin of the link and its torque about it
    add_load(tree, base, q, link, force, zero, np.cross(place - origin, force), out)


def holds(points: list[Point], v: FloatArray, dt: float, weight: float) -> tuple[FloatArray, FloatArray]:
    """H (n, n) and stop (n,) of the active points."""
    hold, stop = np.zeros((len(v), len(v))), np.zeros(len(v))
    for point in points:
        if not point.active:
            continue
        rows = np.vstack([point.jacobian, point.sideways]) if point.slip is None else point.jacobian[None]
        gaps = np.zeros(len(rows))
        gaps[0] = point.gap
        hold += weight * rows.T @ rows
        stop += weight * rows.T @ ((rows @ v + gaps / dt) / dt)
        if point.slip is not None:
            stop -= point.slip
    return hold, stop


def revise(points: list[Point], v: FloatArray, a: FloatArray, dt: float, weight: float, friction: float) -> bool:
    """Add points that would pass the ground, drop those that would be pulled, let slide what friction cannot hold;
    whether anything changed."""
    changed = False
    for point in points:
        excess = point.jacobian @ (v + dt * a) + point.gap / dt  # m/s over the fastest way down allowed
        active = bool(excess < 0)  # of an active point: the small give under a push
        changed |= active != point.active
        if point.active and active and point.slip is None:
            push = -weight * excess / dt
            drag = -weight * (point.sideways @ (v + dt * a)) / dt
            size = float(np.hypot(*drag))
            if size > friction * push:
                point.slip, changed = friction * push / size * (drag @ point.sideways), True
        point.active = active
    return changed
