"""Reading: what is computed from a robot's poses once a control step, for all that look at it then."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray

from .robot_state import RobotState

NODE_REACH = 2.0  # rod lengths: twice what an intact six-rod robot spans; a node beyond it has come off


class Reading(NamedTuple):
    """A robot at one time, in the world's frame."""

    velocities: FloatArray
    """(b, 6) linear [m/s] and angular [rad/s] velocity of every body."""
    nodes: FloatArray
    """(n, 3) positions [m]."""
    node_velocities: FloatArray
    """(n, 3) [m/s]."""
    centre: FloatArray
    """(3,) of mass [m]."""
    level: float = 0.0
    """Height that heights count from [m]: 0, or that of the lowest foot where there are boxes to stand on."""


def read(robot: RobotState) -> Reading:
    """The robot now."""
    velocities = robot.velocities_in_world()
    nodes, node_velocities = robot.nodes_in_world(velocities)
    return Reading(velocities, nodes, node_velocities, robot.centre_of_mass_in_world(), robot.level(nodes))


def farthest_node(reading: Reading) -> float:
    """Largest distance of a node: sideways from the centre of mass, or up from its level [m]."""
    sideways = np.linalg.norm(reading.nodes[:, :2] - reading.centre[:2], axis=1)
    return float(max(sideways.max(), np.abs(reading.nodes[:, 2] - reading.level).max()))


def heading_rotation(direction: FloatArray) -> FloatArray:
    """(3, 3) from the world to the heading frame: x along the unit vector ``direction`` (2,), z up."""
    c, s = direction
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
