"""World: the only module that talks to PyBullet. Every call names its client."""

from __future__ import annotations

import math
import os
import struct
import weakref
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import direct_calls
from .errors import SimulationError
from .state_window import find_window
from .structure import FloatArray, IntArray


@contextmanager
def _quiet_stderr() -> Iterator[None]:
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


with _quiet_stderr():  # it greets on stderr, where a command's error is to stand alone
    import pybullet

_ROBOT_GROUP, _GROUND_GROUP = 1, 2
FIXED, REVOLUTE, PRISMATIC = range(3)  # kinds of joints
# Contact points of one body nearer to each other than this part of its size count as one, the last found of them: on a
# surface of triangles that may be the one with a neighbour of the triangle a foot presses on, which then holds nothing
_MERGING, _FINE_MERGING = 0.02, 0.004  # the engine's own; 1.4 mm on a rod of 0.7 m


def _disconnect(client: int) -> None:
    if pybullet.isConnected(physicsClientId=client):
        pybullet.disconnect(physicsClientId=client)


def _make_plain(client: int, body: int, link: int, friction: float) -> None:
    """Coulomb friction and nothing else: the engine's damping, rolling friction and bounce off."""
    # one call each: on a link but the base the engine drops what stands beside a damping or a speed limit; and it
    # clamps joint speeds at 100 by default, which would hide a divergence. Contacts multiply two bodies' coefficients
    for change in ({"linearDamping": 0, "angularDamping": 0}, {"maxJointVelocity": 1e6}, {"jointDamping": 0},
                   {"lateralFriction": math.sqrt(friction), "restitution": 0, "rollingFriction": 0,
                    "spinningFriction": 0}):  # fmt: skip
        pybullet.changeDynamics(body, link, **change, physicsClientId=client)
    pybullet.setCollisionFilterGroupMask(body, link, _ROBOT_GROUP, _ROBOT_GROUP | _GROUND_GROUP, physicsClientId=client)


class World:
    """A physics client with bodies in it.

    Bodies are multibodies of one link, or of two that a pin joins, with true inertia, no damping and no sleeping.
    Maximal coordinates would be a little cheaper, but there the engine solves friction along one direction only, that
    of the sliding the step would begin with, and what is left across it lets loaded feet creep by 7 cm/s at 2 ms on a
    robot at rest.

    Rows of per-link arrays are the bodies' first links in the order of loading, then the second links in that order.

    `compiled` says that substeps may go past Python (`substeps.run`): by default where that can be done. Raises
    SimulationError where it is asked for and cannot.
    """

    def __init__(self, dt: float, gravity: float, gui: bool = False, compiled: bool | None = None) -> None:
        if gui and not os.environ.get("DISPLAY"):
            raise SimulationError("no display to open a window on: set DISPLAY, or render to rgb_array instead")
        self.client = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)
        if self.client < 0:
            raise SimulationError("PyBullet gave no physics client; close other worlds first")
        self._finalizer = weakref.finalize(self, _disconnect, self.client)
        can_compile = direct_calls.AVAILABLE and not gui
        if compiled and not can_compile:
            raise SimulationError("compiled substeps need a world with no window and a PyBullet with a symbol table: "
                                  "leave out compiled=True")  # fmt: skip
        self.compiled = can_compile if compiled is None else compiled
        self.bodies: list[int] = []
        self.pinned: list[int] = []
        """Rows in `bodies` of those with two links."""
        self.ground: int | None = None
        self._second_links: list[int] = []
        self._lines: list[int] = []
        self._pack, self._pack_angles = struct.Struct("0d"), struct.Struct("0d")
        self.poses, self.angles = np.zeros((0, 7)), np.zeros(0)
        self._numbers, self._pinned_rows = np.zeros(0, dtype=np.int32), np.zeros(0, dtype=int)
        self._window: IntArray | None = None
        self._stale = True  # whether the engine has moved since `poses` and `angles` were read
        pybullet.setGravity(0, 0, -gravity, physicsClientId=self.client)
        pybullet.setTimeStep(dt, physicsClientId=self.client)
        pybullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1, physicsClientId=self.client)

    def close(self) -> None:
        """Disconnect; further calls fail."""
        self._finalizer()

    # -- bodies ---------------------------------------------------------------------------------------------------

    def load(self, urdf: Path, pose: Sequence[float], friction: float) -> int:
        """Load a URDF of one link, or of two with a revolute joint, at pose (7,) position and xyzw of the first link's
        centre of mass; returns its row in `bodies`."""
        body = pybullet.loadURDF(
            str(urdf), list(pose[:3]), list(pose[3:]), useMaximalCoordinates=0,
            flags=pybullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=self.client,
        )  # fmt: skip
        links = pybullet.getNumJoints(body, physicsClientId=self.client)
        for link in range(-1, links):
            _make_plain(self.client, body, link, friction)
        if links:
            pybullet.setJointMotorControl2(body, 0, pybullet.VELOCITY_CONTROL, force=0, physicsClientId=self.client)
            self.pinned.append(len(self.bodies))
        self.bodies.append(body)
        self._stale = True
        self.poses, self.angles = np.zeros((len(self.bodies) + len(self.pinned), 7)), np.zeros(len(self.pinned))
        self._pack = struct.Struct(f"{7 * len(self.bodies)}d")
        self._pack_angles = struct.Struct(f"{len(self.pinned)}d")
        self._second_links = [self.bodies[row] for row in self.pinned]
        self._numbers, self._pinned_rows = np.array(self.bodies, dtype=np.int32), np.array(self.pinned, dtype=int)
        return len(self.bodies) - 1

    def add_ground(self, friction: float, heights: FloatArray | None = None, cell: float = 0.0) -> None:
        """The plane z = 0, or a grid of heights (n, n) [m] over x and y, ``cell`` [m] apart, about the origin."""
        if heights is None or not len(heights):
            shape, middle = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self.client), 0.0
        else:
            shape = pybullet.createCollisionShape(
                pybullet.GEOM_HEIGHTFIELD, meshScale=[cell, cell, 1], heightfieldData=heights.T.ravel().tolist(),
                numHeightfieldRows=len(heights), numHeightfieldColumns=len(heights), physicsClientId=self.client,
            )  # fmt: skip
            middle = float(heights.min() + heights.max()) / 2  # which the engine takes for the shape's origin
        self.ground = pybullet.createMultiBody(0, shape, basePosition=[0, 0, middle], physicsClientId=self.client)
        pybullet.changeDynamics(
            self.ground, -1, lateralFriction=math.sqrt(friction), restitution=0, physicsClientId=self.client
        )
        pybullet.setCollisionFilterGroupMask(
            self.ground, -1, _GROUND_GROUP, _ROBOT_GROUP, physicsClientId=self.client
        )

    def place(
        self, poses: FloatArray, velocities: FloatArray, angles: FloatArray | None = None,
        rates: FloatArray | None = None,
    ) -> None:  # fmt: skip
        """Set every first link's pose (b, 7) and velocity (b, 6) linear, angular; pins' angles and rates, else 0."""
        self._stale = True
        for body, pose, velocity in zip(self.bodies, poses.tolist(), velocities.tolist(), strict=True):
            pybullet.resetBasePositionAndOrientation(body, pose[:3], pose[3:], physicsClientId=self.client)
            pybullet.resetBaseVelocity(body, velocity[:3], velocity[3:], physicsClientId=self.client)
        for pin, body in enumerate(self._second_links):
            angle = 0.0 if angles is None else float(angles[pin])
            rate = 0.0 if rates is None else float(rates[pin])
            pybullet.resetJointState(body, 0, angle, rate, physicsClientId=self.client)

    # -- the substep ----------------------------------------------------------------------------------------------

    def read(self) -> tuple[FloatArray, FloatArray]:
        """Up-to-date `poses` (l, 7), position [m] and quaternion xyzw of every link's centre of mass in the
        world, and `angles` (p,) of the pins [rad]. The rows of second links follow from both: the caller fills them."""
        if self._stale:
            self._read()
            self._stale = False
        return self.poses, self.angles

    def _read(self) -> None:
        read, client = pybullet.getBasePositionAndOrientation, self.client
        values: list[float] = []
        for body in self.bodies:
            position, orientation = read(body, client)
            values += position
            values += orientation
        self._pack.pack_into(self.poses.data, 0, *values)
        if self.pinned:
            angles = [pybullet.getJointState(body, 0, client)[0] for body in self._second_links]
            self._pack_angles.pack_into(self.angles.data, 0, *angles)

    @property
    def engine(self) -> tuple[int, int, IntArray, np.ndarray, IntArray, FloatArray, FloatArray]:
        """What `substeps.run` works on: client, number of bodies in it, window onto their states, bodies' numbers, rows
        of those with two links, poses, angles. Whoever takes it may step the world."""
        self._stale = True
        total = len(self.bodies) + (self.ground is not None)
        if self._window is None:
            self._window = find_window(direct_calls.client_handle(self.client, total), self._numbers)
        return self.client, total, self._window, self._numbers, self._pinned_rows, self.poses, self.angles

    def step(self, wrenches: FloatArray) -> None:
        """Apply force and moment (l, 6) about the links' centres, world axes, and advance one time step.

        Of a second link the moment alone: its force has been carried over to the first one.
        """
        self._stale = True
        force, torque, client = pybullet.applyExternalForce, pybullet.applyExternalTorque, self.client
        rows = wrenches.tolist()
        for body, pose, w in zip(self.bodies, self.poses.tolist(), rows, strict=False):
            force(body, -1, w[:3], pose[:3], 2, client)
            torque(body, -1, w[3:], 2, client)
        for body, w in zip(self._second_links, rows[len(self.bodies) :], strict=True):
            torque(body, 0, w[3:], 2, client)
        pybullet.stepSimulation(client)

    @contextmanager
    def fine_contacts(self) -> Iterator[None]:
        """Steps within it keep the contacts with neighbouring triangles of the ground apart.

        The engine has one such setting for all clients of a process, so other worlds must not step meanwhile.
        """
        pybullet.setPhysicsEngineParameter(contactBreakingThreshold=_FINE_MERGING, physicsClientId=self.client)
        try:
            yield
        finally:
            if pybullet.isConnected(physicsClientId=self.client):
                pybullet.setPhysicsEngineParameter(contactBreakingThreshold=_MERGING, physicsClientId=self.client)

    def push(self, velocity: ArrayLike) -> None:
        """Add a velocity (3,) [m/s] to every body."""
        for body in self.bodies:
            linear, angular = pybullet.getBaseVelocity(body, physicsClientId=self.client)
            pybullet.resetBaseVelocity(body, (np.add(linear, velocity)).tolist(), angular, physicsClientId=self.client)

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Gravity (3,) in the world [m/s^2], in place of the one straight down."""
        pybullet.setGravity(*gravity, physicsClientId=self.client)

    def advance(self) -> None:
        """One time step under the forces already given."""
        self._stale = True
        pybullet.stepSimulation(self.client)

    # -- state and pictures ---------------------------------------------------------------------------------------

    def save(self) -> int:
        """Keep the engine's state in memory; `restore` brings it back bitwise."""
        return pybullet.saveState(physicsClientId=self.client)

    def restore(self, state: int) -> None:
        self._stale = True
        pybullet.restoreState(stateId=state, physicsClientId=self.client)

    def contacts(self) -> list[tuple[Any, ...]]:
        """PyBullet's contact rows."""
        return list(pybullet.getContactPoints(physicsClientId=self.client))

    def image(self, eye: Sequence[float], target: Sequence[float], width: int, height: int) -> tuple[Any, ...]:
        """TinyRenderer: rgb (h, w, 3) uint8 and the (4, 4) world-to-clip matrix used."""
        view = pybullet.computeViewMatrix(list(eye), list(target), [0, 0, 1], physicsClientId=self.client)
        projection = pybullet.computeProjectionMatrixFOV(40, width / height, 0.05, 20, physicsClientId=self.client)
        _, _, pixels, _, _ = pybullet.getCameraImage(
            width, height, view, projection, shadow=1, lightDirection=[1, 1, 3],
            renderer=pybullet.ER_TINY_RENDERER, physicsClientId=self.client,
        )  # fmt: skip
        rgb = np.asarray(pixels, dtype=np.uint8).reshape(height, width, 4)[:, :, :3]
        clip = np.reshape(projection, (4, 4), order="F") @ np.reshape(view, (4, 4), order="F")
        return rgb, clip

    def draw_lines(self, ends: FloatArray, colours: Sequence[Sequence[float]]) -> None:
        """Lines (k, 2, 3) in the window, replacing those drawn before."""
        old = self._lines or [-1] * len(ends)
        self._lines = [
            pybullet.addUserDebugLine(a.tolist(), b.tolist(), list(colour), 2, replaceItemUniqueId=line,
                                      physicsClientId=self.client)
            for (a, b), colour, line in zip(ends, colours, old, strict=True)
        ]  # fmt: skip

    def look_at(self, target: FloatArray, distance: float) -> None:
        """Move the window's camera."""
        pybullet.resetDebugVisualizerCamera(distance, 45, -25, target.tolist(), physicsClientId=self.client)


class Articulated:
    """A body of many links in a world, its joints free: motors and the engine's damping off, no sleeping.

    Rows of per-link arrays are the base, then the links in the engine's order; columns of per-joint arrays are the
    joints that move, in that order. Revolute and prismatic joints only.
    """

    def __init__(self, world: World, urdf: Path, pose: Sequence[float], friction: float, fixed_base: bool) -> None:
        self.world, self.client = world, world.client
        try:
            self.body = body = pybullet.loadURDF(
                str(urdf), list(pose[:3]), list(pose[3:]), useFixedBase=fixed_base,
                flags=pybullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=self.client,
            )  # fmt: skip
        except pybullet.error as error:
            raise SimulationError(f"PyBullet cannot load {urdf.name}: {error}") from error
        count = pybullet.getNumJoints(body, physicsClientId=self.client)
        self.joint_info = [pybullet.getJointInfo(body, i, physicsClientId=self.client) for i in range(count)]
        for link in range(-1, count):
            _make_plain(self.client, body, link, friction)
        kinds = {pybullet.JOINT_REVOLUTE: REVOLUTE, pybullet.JOINT_PRISMATIC: PRISMATIC, pybullet.JOINT_FIXED: FIXED}
        for info in self.joint_info:
            if info[2] not in kinds:
                raise SimulationError(f"joint {info[1].decode()!r} is neither revolute, prismatic nor fixed")
        self.kinds = [kinds[info[2]] for info in self.joint_info]
        self.moving = [i for i, kind in enumerate(self.kinds) if kind != FIXED]
        pybullet.setJointMotorControlArray(
            body, self.moving, pybullet.VELOCITY_CONTROL, forces=[0.0] * len(self.moving), physicsClientId=self.client
        )

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


def packaged_urdf(name: str) -> Path | None:
    """Path of a URDF that ships with the package, or None."""
    path = resources.files("tensegym.urdf") / name
    return Path(str(path)) if path.is_file() else None
