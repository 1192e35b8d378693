"""BulletWorld: the protocol of engines on PyBullet."""

from __future__ import annotations

import struct
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.urdf_writer import body_urdf
from tensegym.engine import GROUND, Contact, Scene, World
from tensegym.errors import SimulationError
from tensegym.physics.model import Model, Out, State
from tensegym.physics.terrain import Ground

from . import c_interface
from .bodies import load_body, make_box, packaged_urdf
from .client import Client
from .compiled_loop import run
from .engine import pybullet
from .state_buffer import find_window


class EngineAccess(NamedTuple):
    """A client as compiled code drives it, see c_interface.py."""

    client: int
    """The client's number."""
    body_count: int
    """How many bodies it holds, the ground and boxes among them."""
    window: IntArray
    """(3,) where the engine writes states, see state_buffer.py."""
    body_ids: NDArray[np.int32]
    """(k,) the engine's numbers of the bodies."""
    two_link_rows: IntArray
    """(p,) rows in body_ids of those with two links."""


class BulletWorld(Client, World):
    """A scene in a physics client, its bodies loaded from URDF files.

    Bodies are multibodies with true inertia. Maximal coordinates would be a little cheaper, but there the engine solves
    friction along one direction only, that of the sliding the step would begin with, and what is left across it lets
    loaded feet creep by 7 cm/s at 2 ms on a robot at rest.

    `compiled` says that substeps may go past Python (`c_interface`): by default where that can be done. Raises
    SimulationError where it is asked for and cannot.
    """

    def __init__(self, scene: Scene, gui: bool = False, compiled: bool | None = None) -> None:
        World.__init__(self, scene)
        Client.__init__(self, scene.dt, scene.gravity, gui)
        can_compile = c_interface.AVAILABLE and not gui
        if compiled and not can_compile:
            raise SimulationError("compiled substeps need a world with no window and a PyBullet with a symbol table "
                                  f"({c_interface.known_names()}): leave out compiled=True")  # fmt: skip
        self.compiled = can_compile if compiled is None else compiled
        self.body_ids = self._load()
        """The engine's numbers of the robot's bodies, in the order of the scene."""
        for pair in scene.joined:
            one, two = (self.body_ids[row] for row in pair)
            pybullet.setCollisionFilterPair(one, two, -1, -1, 0, physicsClientId=self.client)
        self._two_link_rows = [row for row, body in enumerate(scene.bodies) if body.second]
        self._second_links = [self.body_ids[row] for row in self._two_link_rows]
        self._pack = struct.Struct(f"{7 * len(self.body_ids)}d")
        self._pack_angles = struct.Struct(f"{len(self._second_links)}d")
        self._access: EngineAccess | None = None
        self._stale = True  # whether the engine has moved since `poses` and `angles` were read
        self._fixed: set[int] = set()
        if scene.ground:
            self._fixed.add(self.add_ground(scene.friction, scene.ground.heights, scene.ground.cell))
            self._fixed |= {make_box(self.client, box, scene.friction) for box in scene.boxes}
        self._pristine = self.save()

    def _load(self) -> list[int]:
        """Load every body from the file that ships with the package, where that is its text, or one written for it."""
        ids, paths = [], {}
        with tempfile.TemporaryDirectory() as folder:
            for body, pose in zip(self.scene.bodies, self.scene.poses, strict=True):
                if body.name not in paths:
                    text, name = body_urdf(body), f"{body.name}.urdf"
                    shipped = packaged_urdf(name)
                    paths[body.name] = shipped if shipped and shipped.read_text() == text else Path(folder) / name
                    if paths[body.name] != shipped:
                        paths[body.name].write_text(text)
                ids.append(load_body(self.client, paths[body.name], pose, self.scene.friction))
        return ids

    # -- placing ------------------------------------------------------------------------------------------------------

    def place(
        self, poses: FloatArray, velocities: FloatArray, angles: FloatArray | None = None,
        rates: FloatArray | None = None,
    ) -> None:  # fmt: skip
        self._stale = True
        for body, pose, velocity in zip(self.body_ids, poses.tolist(), velocities.tolist(), strict=False):
            pybullet.resetBasePositionAndOrientation(body, pose[:3], pose[3:], physicsClientId=self.client)
            pybullet.resetBaseVelocity(body, velocity[:3], velocity[3:], physicsClientId=self.client)
        for pin, body in enumerate(self._second_links):
            angle = 0.0 if angles is None else float(angles[pin])
            rate = 0.0 if rates is None else float(rates[pin])
            pybullet.resetJointState(body, 0, angle, rate, physicsClientId=self.client)

    def restart(self, poses: FloatArray, velocities: FloatArray, rates: FloatArray) -> None:
        self.restore(self._pristine)
        if self._second_links:
            # restoring leaves something of the last step in bodies of two links; a step in the air takes it out
            self.advance()
            self.restore(self._pristine)
        self.place(poses, velocities, rates=rates)

    def push(self, velocity: ArrayLike) -> None:
        for body in self.body_ids:
            linear, angular = pybullet.getBaseVelocity(body, physicsClientId=self.client)
            pybullet.resetBaseVelocity(body, (np.add(linear, velocity)).tolist(), angular, physicsClientId=self.client)

    # -- stepping -----------------------------------------------------------------------------------------------------

    def read(self) -> tuple[FloatArray, FloatArray]:
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
        if self._second_links:
            angles = [pybullet.getJointState(body, 0, client)[0] for body in self._second_links]
            self._pack_angles.pack_into(self.angles.data, 0, *angles)

    def step(self, wrenches: FloatArray) -> None:
        self._stale = True
        force, torque, client = pybullet.applyExternalForce, pybullet.applyExternalTorque, self.client
        rows = wrenches.tolist()
        for body, pose, w in zip(self.body_ids, self.poses.tolist(), rows, strict=False):
            force(body, -1, w[:3], pose[:3], 2, client)
            torque(body, -1, w[3:], 2, client)
        for body, w in zip(self._second_links, rows[len(self.body_ids) :], strict=True):
            torque(body, 0, w[3:], 2, client)
        pybullet.stepSimulation(client)

    def run(
        self, count: int, model: Model, ground: Ground, state: State, out: Out, dt: float, implicit: bool
    ) -> None:
        with self.stepping():
            if not self.compiled:
                super().run(count, model, ground, state, out, dt, implicit)
            elif run(count, self.hand_over(), model, ground, state, out, dt, implicit) < count:
                raise SimulationError("the robot's world is closed, or a body is gone from it")

    def hand_over(self) -> EngineAccess:
        """Let compiled code step the world: its client, and where states are read. `poses` and `angles` count as out of
        date from now on."""
        self._stale = True
        if self._access is None:
            total = len(self.body_ids) + len(self._fixed)
            numbers = np.array(self.body_ids, dtype=np.int32)
            window = find_window(c_interface.client_handle(self.client, total), numbers)
            rows = np.array(self._two_link_rows, dtype=np.int64)
            self._access = EngineAccess(self.client, total, window, numbers, rows)
        return self._access

    # -- state --------------------------------------------------------------------------------------------------------

    def save(self) -> int:
        return pybullet.saveState(physicsClientId=self.client)

    def restore(self, state: int) -> None:
        self._stale = True
        pybullet.restoreState(stateId=state, physicsClientId=self.client)

    def contacts(self) -> list[Contact]:
        rows = {(body, -1): row for row, body in enumerate(self.body_ids)}
        rows |= {(body, 0): len(self.body_ids) + pin for pin, body in enumerate(self._second_links)}
        found = []
        for point in pybullet.getContactPoints(physicsClientId=self.client):
            _, a, b, link_a, link_b, on_a, place, normal, distance, push, along, one, across, two, *_ = point
            sign = 1.0
            if a in self._fixed:
                a, b, link_a, link_b, place, sign = b, a, link_b, link_a, on_a, -1.0
            other = GROUND if b in self._fixed else rows[b, link_b]
            friction = along * np.array(one) + across * np.array(two)
            found.append(Contact(rows[a, link_a], other, np.array(place), sign * np.array(normal), distance, push,
                                 sign * friction))  # fmt: skip
        return found
