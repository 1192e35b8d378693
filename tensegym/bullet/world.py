"""World: a client with the bodies of a robot in it, and its time step."""

from __future__ import annotations

import os
import struct
import weakref
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import SimulationError

from . import c_interface as direct_calls
from .bodies import load_body, make_ground
from .camera import Camera
from .engine import pybullet
from .state_buffer import find_window

# Contact points of one body nearer to each other than this part of its size count as one, the last found of them: on a
# surface of triangles that may be the one with a neighbour of the triangle a foot presses on, which then holds nothing
_MERGING, _FINE_MERGING = 0.02, 0.004  # the engine's own; 1.4 mm on a rod of 0.7 m


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
        self.camera = Camera(self.client)
        self._second_links: list[int] = []
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
        body = load_body(self.client, urdf, pose, friction)
        if pybullet.getNumJoints(body, physicsClientId=self.client):
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
        self.ground = make_ground(self.client, friction, heights, cell)

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
