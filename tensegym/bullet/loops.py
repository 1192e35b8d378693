"""Loops: a point of a link held where it is, which closes a chain of links to a loop."""

from __future__ import annotations

from collections.abc import Sequence

from .articulated import Articulated
from .engine import pybullet

_STRONG = 1e6  # N


def hold_point(body: Articulated, link: int, point: Sequence[float], place: Sequence[float]) -> None:
    """Hold a point of a link, in the link's centre and principal axes [m], at a place in the world [m].

    By PyBullet's own constraint: an impulse a step, and a spring for what has drifted. A chain of joints has no such
    thing; a loop keeps its energy only as well as the engine closes it.
    """
    constraint = pybullet.createConstraint(
        body.body, link, -1, -1, pybullet.JOINT_POINT2POINT, [0, 0, 0], list(point), list(place),
        physicsClientId=body.client,
    )  # fmt: skip
    pybullet.changeConstraint(constraint, maxForce=_STRONG, physicsClientId=body.client)
