"""TensegrityRobot: a design standing in a world; step it, read it."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from . import cable_forces as kernel
from . import drives as drive_kernel
from .bullet import World, packaged_urdf
from .cables import CableArrays, cable_arrays, explicit_step_limit
from .design import RobotDesign
from .errors import DesignError, SimulationError
from .faces import Faces, hull_faces, resting_rotation
from .readings import mechanical_energy, nodes_in_world
from .rotation import step_back
from .structure import FloatArray
from .urdf_model import rod_files, urdf_files

Integrator = Literal["auto", "explicit", "implicit"]
LEAST_TIME_STEP, LARGEST_TIME_STEP = 1e-6, 4e-3  # s; at 5 ms feet and rods in contact make energy, at 4 ms none did
SPEED_BOUND = 50.0  # m/s; nothing on these robots moves so fast unless the integration has diverged


@dataclass(frozen=True)
class Energies:
    """Mechanical energy of the robot [J]; gravity's is zero with every body centre at z = 0."""

    kinetic: float
    gravity: float
    elastic: float

    @property
    def total(self) -> float:
        return self.kinetic + self.gravity + self.elastic


@dataclass(frozen=True)
class Account:
    """What has added up since the last reset. Lengths are horizontal [m], energies [J].

    foot_path is the mean over the grounded feet of the path of their centres, foot_path_sum the sum over them.
    """

    drive_work: float
    electrical_energy: float
    centre_path: float
    foot_path: float
    foot_path_sum: float


class TensegrityRobot:
    """A design in a PyBullet world, with its cables and drives.

    Rows of per-body arrays are the rods in their order, then the payload. Rows of per-cable arrays are the elastic
    cables, the stiff cables, the payload's cables. A context manager; `close` frees the physics client.

    dt is the physics time step [s]. ``integrator`` picks explicit or linearly implicit cable forces; "auto" takes
    explicit ones where dt is within their stability limit. Raises DesignError for a dt no integrator holds.
    """

    def __init__(
        self, design: RobotDesign | None = None, *, dt: float = 1e-3, ground: bool = True,
        integrator: Integrator = "auto", gui: bool = False,
    ) -> None:  # fmt: skip
        self.design = design = design or RobotDesign()
        if not LEAST_TIME_STEP <= dt <= LARGEST_TIME_STEP:
            raise DesignError(f"dt = {dt!r} is outside [{LEAST_TIME_STEP:g}, {LARGEST_TIME_STEP:g}] s")
        self.dt = dt
        self.cables: CableArrays = cable_arrays(design)
        limit = explicit_step_limit(self.cables)
        if integrator == "explicit" and dt > limit:
            raise DesignError(f"dt = {dt:g} s is over the explicit limit of {limit:.3g} s; take integrator='implicit'")
        self.implicit = integrator == "implicit" or (integrator == "auto" and dt > limit)

        self.world = World(dt, design.gravity if ground else 0.0, gui)
        self._load_bodies()
        if ground:
            self.world.add_ground(design.friction)
        self._pristine = self.world.save()

        cables, drives = len(self.cables.ends), len(design.standing.stiff_cables)
        self.drives = np.zeros((drives, drive_kernel.STATE_SIZE))
        self.lengths, self.rates, self.tensions = np.zeros(cables), np.zeros(cables), np.zeros(cables)
        self.natural_lengths = self.cables.natural.copy()
        self._last_poses = np.zeros_like(self.world.poses)
        self._foot_positions = np.zeros((len(design.standing.nodes), 3))
        self._account = np.zeros(kernel.ACCOUNT_SIZE)
        self._wrenches = np.zeros((len(self.world.bodies), 6))
        self._drive_constants = drive_kernel.drive_constants(design.drive)
        self.time = 0.0
        self.reset()

    def _load_bodies(self) -> None:
        design, poses = self.design, self.cables.rest_poses
        texts = urdf_files(design)
        names = rod_files(design) + (["payload.urdf"] if design.payload else [])
        with tempfile.TemporaryDirectory() as folder:
            paths: dict[str, Path] = {}
            for name, text in texts.items():
                shipped = packaged_urdf(name)
                if shipped and shipped.read_text() == text:
                    paths[name] = shipped
                else:
                    paths[name] = Path(folder) / name
                    paths[name].write_text(text)
            for name, pose in zip(names, poses, strict=True):
                # far above the ground, so that the pristine state has no contacts
                self.world.load(paths[name], [pose[0], pose[1], pose[2] + 10, *pose[3:]], design.friction)

    def close(self) -> None:
        self.world.close()

    def __enter__(self) -> TensegrityRobot:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    # -- start ----------------------------------------------------------------------------------------------------

    @cached_property
    def faces(self) -> Faces:
        """Hull triangles of the standing structure."""
        return hull_faces(self.design.standing)

    def reset(self, face: int | None = 0, heading: float = 0.0) -> None:
        """Stand at rest on a face (an index into `faces`), turned by ``heading`` [rad] about the vertical.

        ``face=None`` leaves the structure unrotated, its lowest foot on the ground: the paper's first pose.
        """
        nodes = self.design.standing.nodes
        if face is None:
            turn = Rotation.from_euler("z", heading)
        else:
            if not 0 <= face < len(self.faces.triangles):
                raise DesignError(f"face = {face} is outside 0..{len(self.faces.triangles) - 1}")
            turn = Rotation.from_matrix(resting_rotation(nodes, self.faces.triangles[face], heading))
        self.reset_rotated(turn)

    def reset_rotated(self, rotation: Rotation, velocities: FloatArray | None = None) -> None:
        """Start with the standing structure rotated about its centre of mass, lowest foot touching z = 0.

        velocities (b, 6): linear [m/s] and angular [rad/s] of every body; at rest by default.
        """
        poses = self.cables.rest_poses.copy()
        masses = self.cables.masses
        centre = masses @ poses[:, :3] / masses.sum()
        poses[:, :3] = rotation.apply(poses[:, :3] - centre)
        poses[:, 3:] = (rotation * Rotation.from_quat(poses[:, 3:])).as_quat()
        feet = np.empty_like(self._foot_positions)
        kernel.points_in_world(poses, self.cables.feet, self.cables.foot_points, feet)
        poses[:, 2] -= (feet[:, 2] - self.cables.foot_radii).min()

        self.world.restore(self._pristine)
        self.world.place(poses, velocities)
        self.drives[:] = 0.0
        self.natural_lengths[:] = self.cables.natural
        self.tensions[:] = 0.0
        self._account[:] = 0.0
        self.time = 0.0
        poses = self.world.read_poses()
        self._last_poses[:] = poses
        if velocities is not None:
            step_back(self._last_poses, velocities, self.dt)
        kernel.points_in_world(poses, self.cables.feet, self.cables.foot_points, self._foot_positions)
        arms, directions = np.empty((len(self.lengths), 2, 3)), np.empty((len(self.lengths), 3))
        kernel.cable_geometry(poses, self.cables.ends, self.cables.params, arms, directions, self.lengths)
        self.rates[:] = 0.0
        kernel.explicit_tensions(self.cables.params, self.lengths, self.rates, self.natural_lengths, self.tensions)

    # -- step -----------------------------------------------------------------------------------------------------

    @property
    def command_limit(self) -> FloatArray:
        """(w,) spool angle [rad] of the deepest allowed pull of each stiff cable."""
        design = self.design
        return design.stiff_cable.max_pull * design.stiff_cable_lengths / design.drive.spool_radius

    def command(self, angles: FloatArray) -> None:
        """Set the commanded spool angles (w,) [rad]; 0 leaves a stiff cable just slack at rest, more winds it in."""
        self.drives[:, drive_kernel.COMMAND] = angles

    def step(self, substeps: int = 1) -> None:
        """Advance by ``substeps`` time steps. Raises SimulationError when the simulation has diverged."""
        world, cables, dt = self.world, self.cables, self.dt
        for _ in range(substeps):
            kernel.substep(
                world.read_poses(), self._last_poses, cables.ends, cables.params, cables.bodies,
                self.natural_lengths, self.lengths, self.tensions, self.rates, self._drive_constants, self.drives,
                cables.first_driven, cables.feet, cables.foot_points, cables.foot_radii, self._foot_positions,
                cables.masses, self._account, dt, self.implicit, self._wrenches,
            )  # fmt: skip
            world.step(self._wrenches)
        self.time += substeps * dt
        fastest = np.abs(self.rates).max(initial=0.0)
        if not fastest < SPEED_BOUND:
            raise SimulationError(f"diverged at t = {self.time:.4g} s: a cable changes length at {fastest:.3g} m/s")

    # -- readings -------------------------------------------------------------------------------------------------

    @property
    def poses_in_world(self) -> FloatArray:
        """(b, 7) position [m] and quaternion xyzw of every body, now."""
        return self.world.read_poses()

    def node_positions_in_world(self) -> FloatArray:
        """(n, 3) [m], now."""
        out = np.empty_like(self._foot_positions)
        kernel.points_in_world(self.world.read_poses(), self.cables.feet, self.cables.foot_points, out)
        return out

    def nodes_in_world(self, velocities: FloatArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Positions (n, 3) [m] and velocities (n, 3) [m/s], now; pass ``velocities`` (b, 6) when read already."""
        v = self.world.velocities() if velocities is None else velocities
        return nodes_in_world(self.world.read_poses(), v, self.cables.feet, self.cables.foot_points)

    def centre_of_mass_in_world(self) -> FloatArray:
        """(3,) [m], now."""
        return self.cables.masses @ self.world.read_poses()[:, :3] / self.cables.masses.sum()

    def momentum_in_world(self) -> tuple[FloatArray, FloatArray]:
        """Linear [kg m/s] and angular [kg m^2/s] momentum about the world origin, each (3,).

        The engine's velocities live half a step before its poses, as in the leapfrog scheme, and so does this.
        """
        v, poses = self.world.velocities(), self.world.read_poses().copy()
        linear = self.cables.masses[:, None] * v[:, :3]
        middle = poses.copy()
        step_back(middle, v, self.dt / 2)
        turns = Rotation.from_quat(middle[:, 3:])
        spin = turns.apply(self.cables.inertias * turns.inv().apply(v[:, 3:]))
        return linear.sum(axis=0), (np.cross(poses[:, :3], linear) + spin).sum(axis=0)

    def energies(self, velocities: FloatArray | None = None) -> Energies:
        """Kinetic, gravity and elastic energy, now; pass ``velocities`` (b, 6) when they have been read already."""
        cables = self.cables
        gravity = self.design.gravity if self.world.ground is not None else 0.0
        v = self.world.velocities() if velocities is None else velocities
        return Energies(*mechanical_energy(
            self.world.read_poses(), v, cables.masses, cables.inertias, gravity, cables.ends, cables.params,
            self.natural_lengths,
        ))  # fmt: skip

    def account(self) -> Account:
        """Running totals since the last reset."""
        return Account(*self._account.tolist())

    def foot_contacts(self) -> FloatArray:
        """(n,) 1.0 where a foot is within a millimetre of the ground, else 0.0."""
        if self.world.ground is None:
            return np.zeros(len(self._foot_positions))
        gap = self.node_positions_in_world()[:, 2] - self.cables.foot_radii
        return (gap <= kernel.GROUND_TOLERANCE).astype(float)
