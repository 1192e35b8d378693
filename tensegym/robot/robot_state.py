"""RobotState: a robot's bodies, cables and drives as the substep leaves them, and what can be read of them."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.bullet import World
from tensegym.design.design import RobotDesign
from tensegym.physics import drives as drive_kernel
from tensegym.physics import substep as kernel
from tensegym.physics.cable_geometry import points_in_world
from tensegym.physics.cable_law import STIFFNESS
from tensegym.physics.readings import (
    Account,
    Energies,
    mechanical_energy,
    momentum,
    nodes_in_world,
    velocities_between,
)
from tensegym.physics.robot_arrays import CableArrays
from tensegym.physics.split_rods import second_poses
from tensegym.physics.terrain import distances_to_ground
from tensegym.structure.faces import Faces, hull_faces


class RobotState:
    """A design's bodies in a world, with the arrays that its substeps write. Nothing here changes them.

    Rows of per-body arrays are the rods in their order (of split rods the first halves), then the payload, then the
    second halves. Rows of per-cable arrays are the elastic cables, the stiff cables, the payload's cables.
    """

    def __init__(
        self, design: RobotDesign, cables: CableArrays, world: World, dt: float, heights: FloatArray, cell: float
    ) -> None:
        self.design, self.cables, self.world, self.dt = design, cables, world, dt
        self.gravity = np.array([0.0, 0.0, -design.gravity if world.ground is not None else 0.0])
        self._heights, self._cell = heights, cell
        self.drives = np.zeros((cables.driven, drive_kernel.STATE_SIZE))
        self._springs = np.zeros((4, len(cables.ends)))
        self._springs[3] = cables.natural
        true = cables.first_flexure
        self.lengths, self.rates, self.tensions, self.natural_lengths = self._springs[:, :true]
        self.flexure_moments = self._springs[2, true:]
        self._last_poses = np.zeros_like(world.poses)
        self._foot_positions = np.zeros((len(cables.feet), 3))
        self._account = np.zeros(kernel.ACCOUNT_SIZE)
        self.time = 0.0

    @cached_property
    def faces(self) -> Faces:
        """Hull triangles of the standing structure."""
        return hull_faces(self.design.standing)

    @cached_property
    def command_limit(self) -> FloatArray:
        """(w,) spool angle [rad] of the deepest allowed pull of each stiff cable."""
        design = self.design
        return design.stiff_cable.max_pull * design.stiff_cable_lengths / design.drive.spool_radius

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
        return momentum(
            self.poses_in_world, self.velocities_in_world(), self.cables.masses, self.cables.inertias, self.dt
        )

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
