"""TensegrityRobot: a design standing in a world; step it, read it."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from . import drives as drive_kernel
from . import kernel
from .bullet import World, packaged_urdf
from .cable_forces import STIFFNESS, start
from .cables import CableArrays, cable_arrays, explicit_step_limit
from .design import RobotDesign
from .errors import DesignError, SimulationError
from .faces import Faces, hull_faces, resting_rotation
from .geometry import points_in_world
from .pins import AXIS, second_poses
from .readings import mechanical_energy, nodes_in_world, velocities_between
from .rotation import step_back
from .structure import FloatArray
from .substeps import run
from .terrain import FLAT, Terrain, distances_to_ground
from .urdf_model import rod_files, urdf_files

Integrator = Literal["auto", "explicit", "implicit"]
LEAST_TIME_STEP, LARGEST_TIME_STEP = 1e-6, 4e-3  # s; at 5 ms feet and rods in contact make energy, at 4 ms none did
_MOST_AT_ONCE = 1000  # compiled substeps, some 20 ms of them, between two looks at signals such as Ctrl-C
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

    Rows of per-body arrays are the rods in their order (of split rods the first halves), then the payload, then the
    second halves. Rows of per-cable arrays are the elastic cables, the stiff cables, the payload's cables. A context
    manager; `close` frees the physics client.

    dt is the physics time step [s]. ground: the plane z = 0, none and no gravity, or a Terrain, flat where the robot
    starts. ``integrator`` picks explicit or linearly implicit cable forces; "auto" takes
    explicit ones where dt is within their stability limit. Raises DesignError for a dt no integrator holds.
    ``compiled`` picks the substep loop, see World: both give the same bits.
    """

    def __init__(
        self, design: RobotDesign | None = None, *, dt: float = 1e-3, ground: bool | Terrain = True,
        integrator: Integrator = "auto", gui: bool = False, compiled: bool | None = None,
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

        self.gravity = np.array([0.0, 0.0, -design.gravity if ground else 0.0])
        self.world = World(dt, design.gravity if ground else 0.0, gui, compiled)
        self._load_bodies()
        self._heights, self._cell = FLAT, 1.0
        if isinstance(ground, Terrain):
            self._heights, self._cell = ground.heights(self._radius()), ground.cell
        if ground:
            self.world.add_ground(design.friction, self._heights, self._cell)
        self._pristine = self.world.save()

        cables, drives = self.cables.first_flexure, len(design.standing.stiff_cables)
        self.drives = np.zeros((drives, drive_kernel.STATE_SIZE))
        self._springs = np.zeros((4, len(self.cables.ends)))
        self._springs[3] = self.cables.natural
        self.lengths, self.rates, self.tensions, self.natural_lengths = self._springs[:, :cables]
        self.flexure_moments = self._springs[2, cables:]
        self._last_poses = np.zeros_like(self.world.poses)
        self._foot_positions = np.zeros((len(design.standing.nodes), 3))
        self._account = np.zeros(kernel.ACCOUNT_SIZE)
        self._wrenches = np.zeros((len(self.world.poses), 6))
        self._drive_constants = drive_kernel.drive_constants(design.drive)
        self._kernel_arguments = self._flat()
        self.time = 0.0
        self.reset()

    def _flat(self) -> tuple[Any, ...]:
        """What the force kernel takes after the wrenches, in its order: arrays that keep their place."""
        cables, pins = self.cables, self.cables.pins
        lengths, rates, tensions, natural = self._springs
        return (
            self._last_poses, cables.ends, cables.params, cables.bodies, pins.partner, pins.bodies, pins.params,
            natural, lengths, tensions, rates, self._drive_constants, self.drives, cables.first_driven, self._heights,
            self._cell, cables.feet, cables.foot_points, cables.foot_radii, self._foot_positions, cables.masses,
            self._account, self.dt, self.implicit,
        )  # fmt: skip

    def _radius(self) -> float:
        """How far any foot reaches from the centre of mass at rest [m]."""
        cables = self.cables
        feet = np.empty((len(cables.feet), 3))
        points_in_world(cables.rest_poses, cables.feet, cables.foot_points, feet)
        centre = cables.masses @ cables.rest_poses[:, :3] / cables.masses.sum()
        return float((np.linalg.norm(feet - centre, axis=1) + cables.foot_radii).max())

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
            for name, pose in zip(names, poses[: len(names)], strict=True):
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

        velocities (b, 6): linear [m/s] and angular [rad/s] of every body, halves as their pin allows; at rest by
        default.
        """
        cables, pins = self.cables, self.cables.pins
        poses, masses = cables.rest_poses.copy(), cables.masses
        centre = masses @ poses[:, :3] / masses.sum()
        poses[:, :3] = rotation.apply(poses[:, :3] - centre)
        poses[:, 3:] = (rotation * Rotation.from_quat(poses[:, 3:])).as_quat()
        feet = np.empty_like(self._foot_positions)
        points_in_world(poses, cables.feet, cables.foot_points, feet)
        poses[:, 2] -= (feet[:, 2] - cables.foot_radii).min()

        moving = np.zeros((len(poses), 6)) if velocities is None else velocities
        axes = rotation.apply(Rotation.from_quat(cables.rest_poses[pins.bodies[:, 0], 3:]).apply(pins.params[:, AXIS]))
        pin_rates = ((moving[pins.bodies[:, 1], 3:] - moving[pins.bodies[:, 0], 3:]) * axes).sum(axis=1)
        first = len(self.world.bodies)
        self.world.restore(self._pristine)
        self.world.place(poses[:first], moving[:first], rates=pin_rates)
        self.drives[:] = 0.0
        self._springs[:] = 0.0
        self._springs[3] = cables.natural
        self._account[:] = 0.0
        self.time = 0.0
        poses = self.poses_in_world
        self._last_poses[:] = poses
        if velocities is not None:
            step_back(self._last_poses, velocities, self.dt)
        points_in_world(poses, cables.feet, cables.foot_points, self._foot_positions)
        start(poses, self.world.angles, cables.ends, cables.params, pins.bodies, pins.params, self._springs)
        self._springs[0, cables.first_flexure :] -= self.dt * pin_rates  # the rates are those over the last step

    def push(self, velocity: ArrayLike) -> None:
        """Add a velocity (3,) [m/s] to the whole robot, a disturbance that no cable notices."""
        self.world.push(velocity)
        self._last_poses[:, :3] -= self.dt * np.asarray(velocity)

    def slope(self, angle: float, uphill: FloatArray) -> None:
        """Tilt gravity as on a plane that rises by ``angle`` [rad] towards ``uphill``, a horizontal unit vector (2,).

        The ground stays z = 0, and so the frame of all readings is the slope's; it holds until it is changed.
        """
        down = -np.array([*(np.sin(angle) * np.asarray(uphill)), np.cos(angle)])
        self.gravity = self.design.gravity * down
        self.world.set_gravity(self.gravity.tolist())

    # -- step -----------------------------------------------------------------------------------------------------

    @cached_property
    def command_limit(self) -> FloatArray:
        """(w,) spool angle [rad] of the deepest allowed pull of each stiff cable."""
        design = self.design
        return design.stiff_cable.max_pull * design.stiff_cable_lengths / design.drive.spool_radius

    def command(self, angles: FloatArray) -> None:
        """Set the commanded spool angles (w,) [rad]; 0 leaves a stiff cable just slack at rest, more winds it in."""
        self.drives[:, drive_kernel.COMMAND] = angles

    def step(self, substeps: int = 1) -> None:
        """Advance by ``substeps`` time steps. Raises SimulationError when the simulation has diverged."""
        if len(self._heights):
            with self.world.fine_contacts():
                self._advance(substeps)
        else:
            self._advance(substeps)
        self.time += substeps * self.dt
        if len(self._heights):
            self._check_ground()
        fastest = np.abs(self.rates).max(initial=0.0)
        if not fastest < SPEED_BOUND:
            raise SimulationError(f"diverged at t = {self.time:.4g} s: a cable changes length at {fastest:.3g} m/s")

    def _advance(self, substeps: int) -> None:
        world, wrenches, arguments = self.world, self._wrenches, self._kernel_arguments
        if world.compiled:
            for first in range(0, substeps, _MOST_AT_ONCE):
                count = min(substeps - first, _MOST_AT_ONCE)
                if run(count, *world.engine, wrenches, *arguments) < count:
                    raise SimulationError("the robot's world is closed, or a body is gone from it")
        else:
            for _ in range(substeps):
                kernel.substep(*world.read(), wrenches, *arguments)
                world.step(wrenches)

    def _check_ground(self) -> None:
        """Raise SimulationError for a foot that is lost: other than a plane, bumps have an edge, and an underside."""
        heights = distances_to_ground(self._foot_positions, self._heights, self._cell)
        if not (heights >= -self.cables.foot_radii).all():
            foot = int((~(heights >= -self.cables.foot_radii)).argmax())
            where = "over the edge of" if np.isnan(heights[foot]) else "through"
            raise SimulationError(f"foot {foot + 1} went {where} the ground by t = {self.time:.4g} s")

    # -- readings -------------------------------------------------------------------------------------------------

    @property
    def poses_in_world(self) -> FloatArray:
        """(b, 7) position [m] and quaternion xyzw of every body, now."""
        poses, angles = self.world.read()
        if len(angles):
            second_poses(self.cables.pins.bodies, self.cables.pins.params, angles, poses)
        return poses

    def velocities_in_world(self) -> FloatArray:
        """(b, 6) linear [m/s] and angular [rad/s] velocity of every body.

        The engine's velocities live half a step before its poses, as in the leapfrog scheme, and so do these.
        """
        return velocities_between(self._last_poses, self.poses_in_world, self.dt)

    def node_positions_in_world(self) -> FloatArray:
        """(n, 3) [m], now."""
        out = np.empty_like(self._foot_positions)
        points_in_world(self.poses_in_world, self.cables.feet, self.cables.foot_points, out)
        return out

    def nodes_in_world(self, velocities: FloatArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Positions (n, 3) [m] and velocities (n, 3) [m/s], now; pass ``velocities`` (b, 6) when read already."""
        v = self.velocities_in_world() if velocities is None else velocities
        return nodes_in_world(self.poses_in_world, v, self.cables.feet, self.cables.foot_points)

    def centre_of_mass_in_world(self) -> FloatArray:
        """(3,) [m], now."""
        return self.cables.masses @ self.poses_in_world[:, :3] / self.cables.masses.sum()

    def momentum_in_world(self) -> tuple[FloatArray, FloatArray]:
        """Linear [kg m/s] and angular [kg m^2/s] momentum about the world origin, each (3,), half a step ago."""
        v, poses = self.velocities_in_world(), self.poses_in_world.copy()
        linear = self.cables.masses[:, None] * v[:, :3]
        middle = poses.copy()
        step_back(middle, v, self.dt / 2)
        turns = Rotation.from_quat(middle[:, 3:])
        spin = turns.apply(self.cables.inertias * turns.inv().apply(v[:, 3:]))
        return linear.sum(axis=0), (np.cross(poses[:, :3], linear) + spin).sum(axis=0)

    def energies(self, velocities: FloatArray | None = None) -> Energies:
        """Kinetic, gravity and elastic energy, flexures' in it, now; pass ``velocities`` (b, 6) when read already."""
        cables = self.cables
        v = self.velocities_in_world() if velocities is None else velocities
        flexures = cables.first_flexure
        kinetic, potential, elastic = mechanical_energy(
            self.poses_in_world, v, cables.masses, cables.inertias, -self.gravity[2], cables.ends[:flexures],
            cables.params, self.natural_lengths,
        )  # fmt: skip
        potential -= float(cables.masses @ self.poses_in_world[:, :2] @ self.gravity[:2])
        return Energies(kinetic, potential, elastic + self.flexure_energy())

    @property
    def flexure_angles(self) -> FloatArray:
        """(f,) bend of each split rod [rad], now."""
        return self.world.read()[1].copy()

    def flexure_margins(self) -> FloatArray:
        """(f,) distance of each flexure to its stops, where its fitted range ends: 1 straight, 0 on a stop."""
        limit = self.design.flexure.max_angle if self.design.flexure else 1.0
        return 1 - np.abs(self.flexure_angles) / limit

    def flexure_energy(self) -> float:
        """Energy stored in the flexures of split rods [J], now."""
        if not len(self.flexure_moments):
            return 0.0
        stiffness = self.cables.params[self.cables.first_flexure :, STIFFNESS]
        return float(0.5 * stiffness @ self.flexure_angles**2)

    def account(self) -> Account:
        """Running totals since the last reset."""
        return Account(*self._account.tolist())

    def foot_contacts(self) -> FloatArray:
        """(n,) 1.0 where a foot is within a millimetre of the ground, else 0.0."""
        if self.world.ground is None:
            return np.zeros(len(self._foot_positions))
        gap = distances_to_ground(self.node_positions_in_world(), self._heights, self._cell) - self.cables.foot_radii
        return (gap <= kernel.GROUND_TOLERANCE).astype(float)
