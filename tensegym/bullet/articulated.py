"""Articulated: a body of many links in a client."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from tensegym.arrays import FloatArray
from tensegym.errors import SimulationError

from .bodies import FIXED, joint_kind, load_body
from .client import Client
from .engine import captured, pybullet


class Articulated:
    """A body of many links in a client, its joints free: motors and the engine's damping off, no sleeping.

    Rows of per-link arrays are the base, then the links in the engine's order; columns of per-joint arrays are the
    joints that move, in that order. Revolute and prismatic joints only.

    Raises SimulationError, with what the engine says, for a file that it cannot load.
    """

    def __init__(self, world: Client, urdf: Path, pose: Sequence[float], friction: float, fixed_base: bool) -> None:
        self.world, self.client = world, world.client
        body = None
        with captured() as said, suppress(SimulationError):
            body = load_body(self.client, urdf, pose, friction, fixed_base)
        self.said = "".join(said)
        """What the engine had to say about the file, in one line."""
        if body is None:
            raise SimulationError(f"PyBullet cannot load {urdf.name}: {self.said or 'it says not why'}")
        self.body = body
        joints = range(pybullet.getNumJoints(body, physicsClientId=self.client))
        self.joint_info = [pybullet.getJointInfo(body, i, physicsClientId=self.client) for i in joints]
        self.kinds = [joint_kind(self.client, body, i) for i in joints]
        self.moving = [i for i, kind in enumerate(self.kinds) if kind != FIXED]

    def remove(self) -> None:
        """Take the body out of the world."""
        pybullet.removeBody(self.body, physicsClientId=self.client)

    def inertias(self) -> list[tuple[float, Sequence[float], Sequence[float], Sequence[float]]]:
        """Mass, principal moments, centre and principal axes (xyzw) in the link's frame of every link."""
        rows = [pybullet.getDynamicsInfo(self.body, link, physicsClientId=self.client)
                for link in range(-1, len(self.kinds))]  # fmt: skip
        return [(row[0], row[2], row[3], row[4]) for row in rows]

    def link_frames(self) -> list[tuple[Sequence[float], Sequence[float]]]:
        """Position and quaternion of the URDF frame of every link but the base, in the world, now."""
        states = [pybullet.getLinkState(self.body, i, computeForwardKinematics=1, physicsClientId=self.client)
                  for i in range(len(self.kinds))]  # fmt: skip
        return [(state[4], state[5]) for state in states]

    def place(self, pose: Sequence[float], twist: Sequence[float], joints: FloatArray, rates: FloatArray) -> None:
        """Base centre's pose (7,) and velocity (6,) linear, angular in the world; joint positions and rates."""
        body, client = self.body, self.client
        pybullet.resetBasePositionAndOrientation(body, list(pose[:3]), list(pose[3:]), physicsClientId=client)
        pybullet.resetBaseVelocity(body, list(twist[:3]), list(twist[3:]), physicsClientId=client)
        for joint, value, rate in zip(self.moving, joints.tolist(), rates.tolist(), strict=True):
            pybullet.resetJointState(body, joint, value, rate, physicsClientId=client)

    def read_joints(self, positions: FloatArray, rates: FloatArray) -> None:
        """Write every moving joint's position and rate."""
        if not self.moving:  # the engine answers None
            return
        states = pybullet.getJointStates(self.body, self.moving, self.client)
        positions[:] = [state[0] for state in states]
        rates[:] = [state[1] for state in states]

    def read_base(self, pose: FloatArray, twist: FloatArray) -> None:
        """Write the base centre's pose (7,) and velocity (6,) linear, angular, in the world."""
        position, orientation = pybullet.getBasePositionAndOrientation(self.body, self.client)
        linear, angular = pybullet.getBaseVelocity(self.body, self.client)
        pose[:3], pose[3:], twist[:3], twist[3:] = position, orientation, linear, angular

    def near(self, other: int, within: float) -> list[tuple[Any, ...]]:
        """PyBullet's rows of the points nearer than ``within`` [m] to another body."""
        return list(pybullet.getClosestPoints(self.body, other, within, physicsClientId=self.client))

    def contact_forces(self) -> list[tuple[Any, ...]]:
        """PyBullet's contact rows of the last step."""
        return list(pybullet.getContactPoints(self.body, physicsClientId=self.client))

    def push_joints(self, torques: list[float]) -> None:
        """Force or torque on every moving joint for the next step."""
        pybullet.setJointMotorControlArray(
            self.body, self.moving, pybullet.TORQUE_CONTROL, forces=torques, physicsClientId=self.client
        )

    def push_link(self, link: int, force: list[float], point: list[float], torque: list[float]) -> None:
        """Force at a point and torque, all in the world, on a link (-1 the base) for the next step."""
        pybullet.applyExternalForce(self.body, link, force, point, 2, self.client)
        pybullet.applyExternalTorque(self.body, link, torque, 2, self.client)
