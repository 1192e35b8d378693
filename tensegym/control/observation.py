"""What the policy sees: everything the simulation knows, or only what the real robot could sense."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.physics import drives
from tensegym.physics.model import DAMPING, STIFFNESS
from tensegym.robot.energy_check import SPEED_BOUND
from tensegym.robot.reading import NODE_REACH, Reading, heading_rotation, read
from tensegym.robot.robot import TensegrityRobot

from .bearing import Bearing


@dataclass(frozen=True)
class Part:
    """A run of the observation: its name, what its items are, and the bound of each entry."""

    name: str
    kind: str  # node, drive, cable, rod, robot: what one row belongs to
    rows: int
    width: int  # entries a row
    bound: float
    scale: float = 1.0  # what an entry of 1 is in SI units
    unit: str = ""

    @property
    def size(self) -> int:
        return self.rows * self.width


class Observation:
    """Base: a fixed list of parts and one array laid out as them.

    Every entry is divided by a natural scale (rod length, rod lengths a second, a drive's limit), so that it is of
    order one; the bounds hold since an episode whose nodes leave theirs has ended.
    """

    parts: tuple[Part, ...]

    @cached_property
    def bound(self) -> FloatArray:
        """(size,) largest absolute value of each entry."""
        return np.concatenate([np.full(p.size, p.bound) for p in self.parts]).astype(np.float32)

    def values(self, robot: TensegrityRobot, reading: Reading, bearing: Bearing) -> FloatArray:
        """(size,) what is seen of a robot, as it was just read, that is to go by a bearing."""
        raise NotImplementedError

    def see(self, robot: TensegrityRobot, bearing: Bearing, reading: Reading | None = None) -> NDArray[np.float32]:
        """(size,) the observation through the robot's sensors; pass its reading where there is one already."""
        values = self.values(robot, read(robot) if reading is None else reading, bearing)
        if robot.sensors is not None:
            values = robot.sensors.through(values, self.parts)
        return values.astype(np.float32)


def _drive_readings(robot: TensegrityRobot) -> list[FloatArray]:
    drive, (speed, current) = robot.drives, _limits(robot)
    angle = robot.drive_angles / robot.command_limit
    return [2 * angle - 1, drive[:, drives.ROTOR_SPEED] / speed, drive[:, drives.CURRENT] / current]


def _limits(robot: TensegrityRobot) -> tuple[float, float]:
    """Largest speed [rad/s] and current [A] of any drive."""
    kinds = robot.design.each_drive or (robot.design.drive,)
    return max(drive.speed_limit for drive in kinds), max(drive.current_limit for drive in kinds)


ANGLE_BOUND = 2.0  # a spool overshoots its commanded range by less than half of it


def _drive_parts(robot: TensegrityRobot) -> list[Part]:
    wound, (speed, current) = len(robot.drives), _limits(robot)
    range_of_angles = float(robot.command_limit.mean()) if wound else 2.0
    return [
        Part("drive angle", "drive", wound, 1, ANGLE_BOUND, range_of_angles / 2, "rad"),  # from the middle of its range
        Part("drive speed", "drive", wound, 1, 1.0, speed, "rad/s"),
        Part("drive current", "drive", wound, 1, 1.0, current, "A"),
    ]


class FullObservation(Observation):
    """Nodes and their velocities in the heading frame, drives, tensions, foot contacts.

    The wanted direction is the frame's x axis. Heights are above the reading's level, horizontal positions from the
    centre of mass.
    """

    def __init__(self, robot: TensegrityRobot) -> None:
        nodes, cables = len(robot.model.node_bodies), len(robot.tensions)
        self.length = robot.design.length
        cable = robot.model.spring_params[:, STIFFNESS : DAMPING + 1]
        self.tension_scale = max(1.0, 5 * max((c.pretension for c in robot.design.each_cable), default=0.0))
        reach = 2 * NODE_REACH * self.length
        most = float((cable[:, 0] * reach + cable[:, 1] * SPEED_BOUND).max()) / self.tension_scale
        self.parts = (
            Part("node position", "node", nodes, 3, NODE_REACH, self.length, "m"),
            Part("node velocity", "node", nodes, 3, SPEED_BOUND / self.length, self.length, "m/s"),
            Part("foot contact", "node", nodes, 1, 1.0),
            *_drive_parts(robot),
            Part("tension", "cable", cables, 1, most, self.tension_scale, "N"),
        )

    def values(self, robot: TensegrityRobot, reading: Reading, bearing: Bearing) -> FloatArray:
        """As `Observation` has it."""
        turn = heading_rotation(bearing.direction)
        below = np.array([*reading.centre[:2], reading.level])
        return np.concatenate([
            ((reading.nodes - below) @ turn.T).ravel() / self.length,
            (reading.node_velocities @ turn.T).ravel() / self.length,
            robot.foot_contacts(),
            *_drive_readings(robot),
            robot.tensions / self.tension_scale,
        ])  # fmt: skip


class OnboardObservation(Observation):
    """What sensors on the robot give: an inertial unit on each rod (attitude and turn rate, as its fusion filter
    reports them, in the heading frame), the drives' angles, speeds and currents.

    Rods look alike along their axes, so attitude is the rod's axis and the rate's part across it.
    """

    def __init__(self, robot: TensegrityRobot) -> None:
        rods = len(robot.design.standing.rods)
        self.rods = rods
        self.rate_scale, fastest = 5.0, 4 * SPEED_BOUND / robot.design.length  # rad/s
        self.parts = (
            Part("rod axis", "rod", rods, 3, 1.0),
            Part("rod rate", "rod", rods, 3, fastest / self.rate_scale, self.rate_scale, "rad/s"),
            *_drive_parts(robot),
        )

    def values(self, robot: TensegrityRobot, reading: Reading, bearing: Bearing) -> FloatArray:
        """As `Observation` has it."""
        poses = robot.poses_in_world[: self.rods]
        axes = Rotation.from_quat(poses[:, 3:]).as_matrix()[:, :, 2]
        rates = reading.velocities[: self.rods, 3:]
        rates = rates - (rates * axes).sum(axis=1)[:, None] * axes
        turn = heading_rotation(bearing.direction)
        return np.concatenate([
            (axes @ turn.T).ravel(), (rates @ turn.T).ravel() / self.rate_scale, *_drive_readings(robot)
        ])  # fmt: skip
