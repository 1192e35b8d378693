"""Start poses by name: a face's nodes as in 3-5-12, or the paper's two poses."""

from __future__ import annotations

import math

from scipy.spatial.transform import Rotation

from tensegym.errors import StructureError
from tensegym.structure.faces import face_by_nodes

from .robot import TensegrityRobot

PAPER_POSES = {
    "paper-1": Rotation.identity(),  # as in the node table
    "paper-2": Rotation.from_euler("y", 35, degrees=True) * Rotation.from_euler("x", 45, degrees=True),
}


def start_at(robot: TensegrityRobot, pose: str, heading: float = 0.0) -> None:
    """Reset a robot to a named pose, turned by ``heading`` [rad] about the vertical.

    Raises StructureError for a name that is neither a face nor a pose of the paper.
    """
    if not -math.tau <= heading <= math.tau:
        raise StructureError(f"heading = {heading!r} is outside [-2 pi, 2 pi] rad")
    if pose in PAPER_POSES:
        robot.reset_rotated(Rotation.from_euler("z", heading) * PAPER_POSES[pose])
    elif "-" in pose and pose.replace("-", "").isdigit():
        robot.reset(face_by_nodes(robot.faces, pose), heading)
    else:
        raise StructureError(
            f"unknown start {pose!r}; one of {', '.join(PAPER_POSES)}, or the nodes of a face such as "
            f"{robot.faces.names()[0]}"
        )
