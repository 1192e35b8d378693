"""World: a client with the bodies of a robot in it, and its time step."""

from __future__ import annotations

import os
import struct
import threading
import weakref
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import SimulationError

from . import c_interface
from .bodies import load_body, make_ground
from .camera import Camera
from .engine import pybullet
from .state_buffer import find_window

# Contact points of one body nearer to each other than this part of its size count as one, the last found of them: on a
# surface of triangles that may be the one with a neighbour of the triangle a foot presses on, which then holds nothing
_MERGING, _FINE_MERGING = 0.02, 0.004  # the engine's own; 1.4 mm on a rod of 0.7 m
# The engine has one such setting for all clients of a process, so one world steps at a time
_STEPPING = threading.RLock()


class EngineAccess(NamedTuple):
    """A client as compiled code drives it, see c_interface.py."""

    client: int
    """The client's number."""
    body_count: int
    """How many bodies it holds, the ground among them."""
    window: IntArray
    """(3,) where the engine writes states, see state_buffer.py."""
    body_ids: NDArray[np.int32]
    """(k,) the engine's numbers of the bodies."""
    two_link_rows: IntArray
    """(p,) rows in body_ids of those with two links."""


def _disconnect(client: int) -> None:
    if pybullet.isConnected(physicsClientId=client):
        pybullet.disconnect(physicsClientId=client)


class World:
    """A physics client with bodies in it.

    Bodies are multibodies of one link, or of two that a pin joins, with true inertia, no damping and no sleeping.
    Maximal coordinates would be a little cheaper, but there the engine solves friction along one direction only, that
    of the sliding the step would begin with, and what is left across it lets loaded feet creep by 7 cm/s at 2 ms on a
    robot at rest.

    Rows of per-link arrays are the bodies' first links in the order of loading, then the second links in that order.

    `compiled` says that substeps may go past Python (`c_interface`): by default where that can be done. Raises
    SimulationError where it is asked for and cannot.
    """

    def __init__(self, dt: float, gravity: float, gui: bool = False, compiled: bool | None = None) -> None:
        if gui and not os.environ.get("DISPLAY"):
            raise SimulationError("no display to open a window on: set DISPLAY, or render to rgb_array instead")
        self.client = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)
        if self.client < 0:
            raise SimulationError("PyBullet gave no physics client; close other worlds first")
        self._finalizer = weakref.finalize(self, _disconnect, self.client)
        can_compile = c_interface.AVAILABLE and not gui
        if compiled and not can_compile:
            raise SimulationError("compiled substeps need a world with no window and a PyBullet with a symbol table "
                                  f"({c_interface.known_names()}): leave out compiled=True")  # fmt: skip
        self.compiled = can_compile if compiled is None else compiled
        self.body_ids: list[int] = []
        """The engine's numbers of the robot's bodies, in the order of loading."""
        self._two_link_rows: list[int] = []
        self.ground: int | None = None
        self.camera = Camera(self.client)
        self._second_links: list[int] = []
        self._pack, self._pack_angles = struct.Struct("0d"), struct.Struct("0d")
        self.poses, self.angles = np.zeros((0, 7)), np.zeros(0)
        self._access: EngineAccess | None = None
        self._fine_contacts = False
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
        centre of mass; returns its row in `body_ids`."""
        body = load_body(self.client, urdf, pose, friction)
        if pybullet.getNumJoints(body, physicsClientId=self.client):
            self._two_link_rows.append(len(self.body_ids))
        self.body_ids.append(body)
        self._stale = True
        pins = len(self._two_link_rows)
        self.poses, self.angles = np.zeros((len(self.body_ids) + pins, 7)), np.zeros(pins)
        self._pack = struct.Struct(f"{7 * len(self.body_ids)}d")
        self._pack_angles = struct.Struct(f"{pins}d")
        self._second_links = [self.body_ids[row] for row in self._two_link_rows]
        self._access = None
        return len(self.body_ids) - 1

    def add_ground(self, friction: float, heights: FloatArray | None = None, cell: float = 0.0) -> None:
        """The plane z = 0, or a grid of heights (n, n) [m] over x and y, ``cell`` [m] apart, about the origin."""
        self.ground, self._access = make_ground(self.client, friction, heights, cell), None
        self._fine_contacts = heights is not None and len(heights) > 0

    def place(
        self, poses: FloatArray, velocities: FloatArray, angles: FloatArray | None = None,
        rates: FloatArray | None = None,
    ) -> None:  # fmt: skip
        """Set every first link's pose (l, 7) and velocity (l, 6) linear, angular; pins' angles and rates, else 0.

        Rows of second links, which follow, may be left out.
        """
        self._stale = True
        for body, pose, velocity in zip(self.body_ids, poses.tolist(), velocities.tolist(), strict=False):
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
        for body in self.body_ids:
            position, orientation = read(body, client)
            values += position
            values += orientation
        self._pack.pack_into(self.poses.data, 0, *values)
        if self._two_link_rows:
            angles = [pybullet.getJointState(body, 0, client)[0] for body in self._second_links]
            self._pack_angles.pack_into(self.angles.data, 0, *angles)

    def hand_over(self) -> EngineAccess:
        """Let compiled code step the world: its client, and where states are read. `poses` and `angles` count as out of
        date from now on."""
        self._stale = True
        if self._access is None:
            total = len(self.body_ids) + (self.ground is not None)
            numbers = np.array(self.body_ids, dtype=np.int32)
            window = find_window(c_interface.client_handle(self.client, total), numbers)
            rows = np.array(self._two_link_rows, dtype=np.int64)
            self._access = EngineAccess(self.client, total, window, numbers, rows)
        return self._access

    def step(self, wrenches: FloatArray) -> None:
        """Apply force and moment (l, 6) about the links' centres, world axes, and advance one time step.

        Of a second link the moment alone: its force has been carried over to the first one.
        """
        self._stale = True
        force, torque, client = pybullet.applyExternalForce, pybullet.applyExternalTorque, self.client
        rows = wrenches.tolist()
        for body, pose, w in zip(self.body_ids, self.poses.tolist(), rows, strict=False):
            force(body, -1, w[:3], pose[:3], 2, client)
            torque(body, -1, w[3:], 2, client)
        for body, w in zip(self._second_links, rows[len(self.body_ids) :], strict=True):
            torque(body, 0, w[3:], 2, client)
        pybullet.stepSimulation(client)

    @contextmanager
    def stepping(self) -> Iterator[None]:
        """Steps are taken within it, no other world's meanwhile: on rough ground contacts with neighbouring triangles
        are kept apart by a setting that the engine has once a process."""
        with _STEPPING:
            if not self._fine_contacts:
                yield
                return
            pybullet.setPhysicsEngineParameter(contactBreakingThreshold=_FINE_MERGING, physicsClientId=self.client)
            try:
                yield
            finally:
                if pybullet.isConnected(physicsClientId=self.client):
                    pybullet.setPhysicsEngineParameter(contactBreakingThreshold=_MERGING, physicsClientId=self.client)

    def push(self, velocity: ArrayLike) -> None:
        """Add a velocity (3,) [m/s] to every body."""
        for body in self.body_ids:
            linear, angular = pybullet.getBaseVelocity(body, physicsClientId=self.client)
            pybullet.resetBaseVelocity(body, (np.add(linear, velocity)).tolist(), angular, physicsClientId=self.client)

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Gravity (3,) in the world [m/s^2], in place of the one straight down."""
        pybullet.setGravity(*gravity, physicsClientId=self.client)

    def advance(self) -> None:
        """One time step under the forces already given."""
        self._stale = True
        with _STEPPING:
            pybullet.stepSimulation(self.client)

    # -- state ---------------------------------------------------------------------------------------

    def save(self) -> int:
        """Keep the engine's state in memory; `restore` brings it back bitwise."""
        return pybullet.saveState(physicsClientId=self.client)

    def restore(self, state: int) -> None:
        self._stale = True
        pybullet.restoreState(stateId=state, physicsClientId=self.client)

    def contacts(self) -> list[tuple[Any, ...]]:
        """PyBullet's contact rows."""
        return list(pybullet.getContactPoints(physicsClientId=self.client))
