"""Whether a robot has fallen flat, by what is left of its volume."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from tensegym.arrays import FloatArray

from .robot_state import RobotState

FALLEN = 0.5  # of the volume at rest: with less a robot whose drives are let out has fallen
FLAT = 0.25  # the same where drives may pull, which takes up to half the volume of a robot that rolls


def hull_volume(nodes: FloatArray) -> float:
    """Volume of the convex hull of nodes (n, 3) [m^3]; 0 where they span none, nan where one is not finite."""
    if not np.isfinite(nodes).all():
        return float("nan")
    try:
        return float(ConvexHull(nodes).volume)
    except QhullError:
        return 0.0


def has_fallen(robot: RobotState, left: float = FALLEN) -> bool:
    """Whether a robot, as it is now, has less than this part of its volume at rest, or is nowhere."""
    return not hull_volume(robot.node_positions_in_world()) >= left * hull_volume(robot.design.standing.nodes)
