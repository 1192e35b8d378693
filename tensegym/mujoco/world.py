"""MujocoWorld: the protocol of engines on MuJoCo."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray
from tensegym.engine import GROUND, Contact, Scene, World
from tensegym.errors import SimulationError
from tensegym.physics.model import Model, Out, State
from tensegym.physics.terrain import Ground

from . import c_interface
from .mjcf import scene_mjcf

_WORLD = 0  # MuJoCo's number of what does not move
_KEPT = mujoco.mjtState.mjSTATE_INTEGRATION  # all that the next step depends on, the solver's first guess among it


@contextmanager
def _quiet() -> Iterator[None]:
    """Of a simulation that diverges, which a robot sees itself, MuJoCo would write a file where the program runs."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda message: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


class EngineAccess(NamedTuple):
    """A world as compiled code drives it, see c_interface.py."""

    model: int
    """Address of the model."""
    data: int
    """And of its data."""
    coordinates: FloatArray
    """(q,) MuJoCo's, read in place."""
    applied: FloatArray
    """(n, 6) its forces and moments on bodies, written in place."""
    places: IntArray
    """(k,) first coordinate of every body."""
    pins: IntArray
    """(p,) coordinate of every pin."""
    links: IntArray
    """(l,) rows of the links in ``applied``."""


class MujocoWorld(World):
    """A scene in MuJoCo: free bodies under forces and moments of ours, its contacts, and none of its tendons.

    Contacts are soft (`mjcf.CONTACT_TIME`), and the step is semi-implicit Euler's. Raises SimulationError where
    compiled substeps are asked for and cannot be had.
    """

    def __init__(self, scene: Scene, compiled: bool | None = None) -> None:
        super().__init__(scene)
        if compiled and not c_interface.AVAILABLE:
            raise SimulationError("compiled substeps need MuJoCo's shared library beside its Python package: "
                                  "leave out compiled=True")  # fmt: skip
        self.compiled = c_interface.AVAILABLE if compiled is None else compiled
        self.model = mujoco.MjModel.from_xml_string(scene_mjcf(scene))
        if scene.ground and scene.ground.rough:
            heights = scene.ground.heights
            scaled = (heights - heights.min()) / max(np.ptp(heights), 1e-6)
            self.model.hfield_data[:] = scaled.T.ravel()  # its rows run along y
        self.data = mujoco.MjData(self.model)
        self._access = self._where()
        self._pristine = self.save()

    def _where(self) -> EngineAccess:
        """The bodies are MuJoCo's in the order of the scene, a second link directly after the first."""
        model, data, firsts, seconds, row = self.model, self.data, [], [], 1
        for body in self.scene.bodies:
            firsts.append(row)
            if body.second:
                seconds.append(row + 1)
            row += 1 + (body.second is not None)
        joints = model.jnt_qposadr[model.body_jntadr]
        self._velocities = model.body_dofadr[firsts]  # first velocity of every body
        self._rates = model.body_dofadr[np.array(seconds, dtype=int)]
        return EngineAccess(
            model._address, data._address, data.qpos, data.xfrc_applied, joints[firsts].astype(np.int64),
            joints[np.array(seconds, dtype=int)].astype(np.int64), np.array(firsts + seconds, dtype=np.int64),
        )  # fmt: skip

    def close(self) -> None:
        if hasattr(self, "data"):
            del self._access, self.data, self.model

    # -- placing ------------------------------------------------------------------------------------------------------

    def place(
        self, poses: FloatArray, velocities: FloatArray, angles: FloatArray | None = None,
        rates: FloatArray | None = None,
    ) -> None:  # fmt: skip
        data, access = self.data, self._access
        for at, moving, pose, velocity in zip(access.places, self._velocities, poses, velocities, strict=False):
            data.qpos[at : at + 7] = [*pose[:3], pose[6], *pose[3:6]]
            data.qvel[moving : moving + 3] = velocity[:3]
            data.qvel[moving + 3 : moving + 6] = Rotation.from_quat(pose[3:]).inv().apply(velocity[3:])  # body axes
        data.qpos[access.pins] = 0.0 if angles is None else angles
        data.qvel[self._rates] = 0.0 if rates is None else rates

    def restart(self, poses: FloatArray, velocities: FloatArray, rates: FloatArray) -> None:
        self.restore(self._pristine)
        self.place(poses, velocities, rates=rates)

    def push(self, velocity: ArrayLike) -> None:
        for moving in self._velocities:
            self.data.qvel[moving : moving + 3] += velocity

    def set_gravity(self, gravity: Sequence[float]) -> None:
        self.model.opt.gravity[:] = gravity

    # -- stepping -----------------------------------------------------------------------------------------------------

    def read(self) -> tuple[FloatArray, FloatArray]:
        access = self._access
        c_interface.read_poses(access.places, access.pins, access.coordinates, self.poses, self.angles)
        return self.poses, self.angles

    def step(self, wrenches: FloatArray) -> None:
        c_interface.write_wrenches(self._access.links, wrenches, self._access.applied)
        mujoco.mj_step(self.model, self.data)

    def run(
        self, count: int, model: Model, ground: Ground, state: State, out: Out, dt: float, implicit: bool
    ) -> None:
        with _quiet():
            if self.compiled:
                c_interface.run(count, self._access, model, ground, state, out, dt, implicit)
            else:
                super().run(count, model, ground, state, out, dt, implicit)

    # -- state --------------------------------------------------------------------------------------------------------

    def save(self) -> FloatArray:
        state = np.empty(mujoco.mj_stateSize(self.model, _KEPT))
        mujoco.mj_getState(self.model, self.data, state, _KEPT)
        return state

    def restore(self, state: FloatArray) -> None:
        mujoco.mj_setState(self.model, self.data, state, _KEPT)

    def contacts(self) -> list[Contact]:
        rows = {int(body): row for row, body in enumerate(self._access.links)}
        found, force = [], np.empty(6)
        for number, contact in enumerate(self.data.contact):
            if contact.efc_address < 0:
                continue  # left out of the solution
            mujoco.mj_contactForce(self.model, self.data, number, force)
            frame, sign = contact.frame.reshape(3, 3), 1.0  # its rows: the normal from the first to the second geom
            bodies = self.model.geom_bodyid[contact.geom]
            link, other = bodies[1], bodies[0]
            if bodies[1] == _WORLD:  # the ground, or a box on it
                link, other, sign = other, link, -1.0
            normal = sign * frame[0]
            place = contact.pos - 0.5 * contact.dist * normal
            found.append(Contact(rows[int(link)], rows.get(int(other), GROUND), place, normal, float(contact.dist),
                                 float(force[0]), sign * force[1:3] @ frame[1:]))  # fmt: skip
        return found
