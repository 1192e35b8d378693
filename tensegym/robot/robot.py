"""TensegrityRobot: a design standing in a world; reset it, command its drives, step it."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.bullet import World
from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError, SimulationError
from tensegym.physics import drives as drive_kernel
from tensegym.physics import substep as kernel
from tensegym.physics.cable_geometry import points_in_world
from tensegym.physics.cable_law import start
from tensegym.physics.robot_arrays import cable_arrays, explicit_step_limit
from tensegym.physics.rod_rotation import step_back
from tensegym.physics.terrain import FLAT, Terrain, distances_to_ground
from tensegym.structure.faces import resting_rotation

from .compiled_loop import run
from .placement import load_bodies, pin_rates, placed, reach
from .robot_state import RobotState

Integrator = Literal["auto", "explicit", "implicit"]
LEAST_TIME_STEP, LARGEST_TIME_STEP = 1e-6, 4e-3  # s; at 5 ms feet and rods in contact make energy, at 4 ms none did
_MOST_AT_ONCE = 1000  # compiled substeps, some 20 ms of them, between two looks at signals such as Ctrl-C
SPEED_BOUND = 50.0  # m/s; nothing on these robots moves so fast unless the integration has diverged


class TensegrityRobot(RobotState):
    """A design in a PyBullet world, with its cables and drives; RobotState has its readings.

    A context manager; `close` frees the physics client.

    dt is the physics time step [s]. ground: the plane z = 0, none and no gravity, or a Terrain, flat where the robot
    starts. ``integrator`` picks explicit or linearly implicit cable forces; "auto" takes
    explicit ones where dt is within their stability limit. Raises DesignError for a dt no integrator holds.
    ``compiled`` picks the substep loop, see World: both give the same bits.
    """

    def __init__(
        self, design: RobotDesign | None = None, *, dt: float = 1e-3, ground: bool | Terrain = True,
        integrator: Integrator = "auto", gui: bool = False, compiled: bool | None = None,
    ) -> None:  # fmt: skip
        design = design or RobotDesign()
        if not LEAST_TIME_STEP <= dt <= LARGEST_TIME_STEP:
            raise DesignError(f"dt = {dt!r} is outside [{LEAST_TIME_STEP:g}, {LARGEST_TIME_STEP:g}] s")
        cables = cable_arrays(design)
        limit = explicit_step_limit(cables)
        if integrator == "explicit" and dt > limit:
            raise DesignError(f"dt = {dt:g} s is over the explicit limit of {limit:.3g} s; take integrator='implicit'")
        self.implicit = integrator == "implicit" or (integrator == "auto" and dt > limit)

        heights, cell = FLAT, 1.0
        if isinstance(ground, Terrain):
            heights, cell = ground.heights(reach(cables)), ground.cell
        world = World(dt, design.gravity if ground else 0.0, gui, compiled)
        load_bodies(world, design, cables.rest_poses)
        if ground:
            world.add_ground(design.friction, heights, cell)
        self._pristine = world.save()
        super().__init__(design, cables, world, dt, heights, cell)
        self._wrenches = np.zeros((len(world.poses), 6))
        self._drive_constants = drive_kernel.drive_constants(design.drive)
        self._kernel_arguments = self._flat()
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

    def close(self) -> None:
        self.world.close()

    def __enter__(self) -> TensegrityRobot:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    # -- start ----------------------------------------------------------------------------------------------------

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
        poses = placed(cables, rotation)
        moving = np.zeros((len(poses), 6)) if velocities is None else velocities
        rates = pin_rates(cables, rotation, moving)
        first = len(self.world.bodies)
        self.world.restore(self._pristine)
        self.world.place(poses[:first], moving[:first], rates=rates)
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
        self._springs[0, cables.first_flexure :] -= self.dt * rates  # the rates are those over the last step

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
