"""What the policy sees: everything the simulation knows, or only what the real robot could sense."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.variation import Variation
from tensegym.physics import drives
from tensegym.physics.model import DAMPING, STIFFNESS
from tensegym.robot.robot import SPEED_BOUND, TensegrityRobot


@dataclass(frozen=True)
class Part:
    """A run of the observation: its name, what its items are, and the bound of each entry."""

    name: str
    kind: str  # node, drive, cable, rod, robot: what one row belongs to
    rows: int
    width: int  # entries a row
    bound: float

    @property
    def size(self) -> int:
        return self.rows * self.width


def heading_rotation(direction: FloatArray) -> FloatArray:
    """(3, 3) world to heading frame: x along the wanted direction (2,), z up."""
    c, s = direction
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


class Observation:
    """Base: a fixed list of parts and one array laid out as them.

    Every entry is divided by a natural scale (rod length, rod lengths a second, a drive's limit), so that it is of
    order one; bounds follow from when the environment ends an episode.
    """

    parts: tuple[Part, ...]

    @cached_property
    def bound(self) -> FloatArray:
        """(size,) largest absolute value of each entry."""
        return np.concatenate([np.full(p.size, p.bound) for p in self.parts]).astype(np.float32)

    def read(self, robot: TensegrityRobot, direction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        raise TypeError("take FullObservation or OnboardObservation")


def _drive_readings(robot: TensegrityRobot) -> list[FloatArray]:
    drive, design = robot.drives, robot.design.drive
    angle = drive[:, drives.ROTOR_ANGLE] / design.gear_ratio / robot.command_limit
    speed, current = drive[:, drives.ROTOR_SPEED] / design.speed_limit, drive[:, drives.CURRENT] / design.current_limit
    return [2 * angle - 1, speed, current]


ANGLE_BOUND = 2.0  # a spool overshoots its commanded range by less than half of it
NODE_REACH = 2.0  # rod lengths from the centre of mass: twice what an intact six-rod robot spans


class FullObservation(Observation):
    """Nodes and their velocities in the heading frame, drives, tensions, foot contacts.

    The wanted direction is the frame's x axis. Heights are above the ground, horizontal positions from the centre of
    mass.
    """

    def __init__(self, robot: TensegrityRobot) -> None:
        nodes, wound, cables = len(robot.model.node_bodies), len(robot.drives), len(robot.tensions)
        self.length = robot.design.length
        cable = robot.model.spring_params[:, STIFFNESS : DAMPING + 1]
        self.tension_scale = max(1.0, 5 * robot.design.elastic_cable.pretension)
        reach = 2 * NODE_REACH * self.length
        most = float((cable[:, 0] * reach + cable[:, 1] * SPEED_BOUND).max()) / self.tension_scale
        self.parts = (
            Part("node position", "node", nodes, 3, NODE_REACH),
            Part("node velocity", "node", nodes, 3, SPEED_BOUND / self.length),
            Part("foot contact", "node", nodes, 1, 1.0),
            Part("drive angle", "drive", wound, 1, ANGLE_BOUND),
            Part("drive speed", "drive", wound, 1, 1.0),
            Part("drive current", "drive", wound, 1, 1.0),
            Part("tension", "cable", cables, 1, most),
        )

    def read(self, robot: TensegrityRobot, direction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The observation (size,), and the node positions (n, 3) and body velocities (b, 6) it was made from."""
        velocities = robot.velocities_in_world()
        nodes, speeds = robot.nodes_in_world(velocities)
        turn = heading_rotation(direction)
        centre = robot.centre_of_mass_in_world()
        centre[2] = 0.0
        contact = nodes[:, 2] - robot.model.foot_radii <= 1e-3
        values = np.concatenate([
            ((nodes - centre) @ turn.T).ravel() / self.length,
            (speeds @ turn.T).ravel() / self.length,
            contact,
            *_drive_readings(robot),
            robot.tensions / self.tension_scale,
        ])  # fmt: skip
        return values, nodes, velocities


class OnboardObservation(Observation):
    """What sensors on the robot give: an inertial unit on each rod (attitude and turn rate, as its fusion filter
    reports them, in the heading frame), the drives' angles, speeds and currents.

    Rods look alike along their axes, so attitude is the rod's axis and the rate's part across it.
    """

    def __init__(self, robot: TensegrityRobot) -> None:
        rods, wound = len(robot.design.standing.rods), len(robot.drives)
        self.rods = rods
        self.rate_scale = 5.0  # rad/s
        self.parts = (
            Part("rod axis", "rod", rods, 3, 1.0),
            Part("rod rate", "rod", rods, 3, 4 * SPEED_BOUND / robot.design.length / self.rate_scale),
            Part("drive angle", "drive", wound, 1, ANGLE_BOUND),
            Part("drive speed", "drive", wound, 1, 1.0),
            Part("drive current", "drive", wound, 1, 1.0),
        )

    def read(self, robot: TensegrityRobot, direction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """As FullObservation.read."""
        velocities = robot.velocities_in_world()
        poses = robot.poses_in_world[: self.rods]
        axes = Rotation.from_quat(poses[:, 3:]).as_matrix()[:, :, 2]
        rates = velocities[: self.rods, 3:]
        rates = rates - (rates * axes).sum(axis=1)[:, None] * axes
        turn = heading_rotation(direction)
        values = np.concatenate([
            (axes @ turn.T).ravel(), (rates @ turn.T).ravel() / self.rate_scale, *_drive_readings(robot)
        ])  # fmt: skip
        return values, robot.nodes_in_world(velocities)[0], velocities


OBSERVATIONS = {"full": FullObservation, "onboard": OnboardObservation}


class ConditionedObservation(Observation):
    """Another observation, and where the robot's design lies in the ranges that designs vary over."""

    def __init__(self, observation: Observation, robot: TensegrityRobot, variation: Variation) -> None:
        self._observation = observation
        self._place = variation.place(robot.design)
        self.parts = (*observation.parts, Part("design", "robot", len(self._place), 1, 1.0))

    def read(self, robot: TensegrityRobot, direction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """As FullObservation.read."""
        values, nodes, velocities = self._observation.read(robot, direction)
        return np.concatenate([values, self._place]), nodes, velocities


def observer(kind: str, robot: TensegrityRobot, variation: Variation | None = None) -> Observation:
    """What reads a robot: one of OBSERVATIONS, with its design where designs vary."""
    plain = OBSERVATIONS[kind](robot)
    return ConditionedObservation(plain, robot, variation) if variation else plain
