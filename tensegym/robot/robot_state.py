"""RobotState: a robot's bodies, cables and drives as the substep leaves them, and what can be read of them."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.groups import column
from tensegym.engine import Uncopied, World
from tensegym.physics.drives import ROTOR_ANGLE
from tensegym.physics.geometry import points_at
from tensegym.physics.model import PEAK_TENSION, STIFFNESS, Model, new_out, new_state
from tensegym.physics.readings import (
    Energies,
    Totals,
    mechanical_energy,
    momentum,
    nodes_in_world,
    step_back,
    velocities_between,
)
from tensegym.physics.split_rods import second_poses
from tensegym.physics.substep import GROUND_TOLERANCE, reset_springs
from tensegym.physics.terrain import Ground, distances_to_ground
from tensegym.structure.faces import Faces, hull_faces

from .sensors import Sensors


class RobotState(Uncopied):
    """A design's bodies in a world and the arrays of its substeps, which nothing else writes to.

    Rows of per-body arrays are the rods in their order (of split rods the first halves), then the payload, then the
    second halves. Rows of per-cable arrays are the elastic cables, the stiff cables, the payload's cables.
    """

    def __init__(self, design: RobotDesign, model: Model, ground: Ground, world: World, dt: float) -> None:
        self.design, self.model, self.world, self.dt = design, model, world, dt
        self.gravity = np.array([0.0, 0.0, -world.scene.gravity])
        self.time = 0.0
        self.resets = 0
        """How many."""
        self.sensors: Sensors | None = None
        """What observations come through; None for exact ones. A reset takes them away."""
        self._as_made = model.spring_params.copy(), model.drive_params.copy()
        self._ground, self._out = ground, new_out(model)
        self._state = state = new_state(model, world.poses, world.angles)
        cables = model.first_flexure
        self.drives = state.drives
        self.lengths, self.rates = state.lengths[:cables], state.rates[:cables]
        self.tensions, self.natural_lengths = state.tensions[:cables], state.natural[:cables]
        self.flexure_moments = state.tensions[cables:]

    def _restart(self, pin_rates: FloatArray, velocities: FloatArray | None) -> None:
        """Time and totals zero, drives and cables as at rest and as they were made, where the bodies stand now.

        pin_rates (p,) [rad/s]; velocities (b, 6) of the bodies, None at rest.
        """
        state, self.sensors = self._state, None
        self.resets += 1
        self.model.spring_params[:], self.model.drive_params[:] = self._as_made
        state.natural[:] = self.model.rest_lengths
        state.drives[:], state.totals[:], self.time = 0.0, 0.0, 0.0
        state.last_poses[:] = self.poses_in_world
        if velocities is not None:
            step_back(state.last_poses, velocities, self.dt)
        state.node_positions[:] = self.node_positions_in_world()
        reset_springs(self.model, state, self._out)
        state.lengths[self.model.first_flexure :] -= self.dt * pin_rates  # the rates are those over the last step

    def _shift_velocity(self, velocity: FloatArray) -> None:
        """Let the last step have ended with a velocity (3,) [m/s] more, of the whole robot."""
        self._state.last_poses[:, :3] -= self.dt * velocity

    @cached_property
    def faces(self) -> Faces:
        """Hull triangles of the standing structure."""
        return hull_faces(self.design.standing)

    @cached_property
    def command_limit(self) -> FloatArray:
        """(w,) spool angle [rad] of the deepest allowed pull of each stiff cable."""
        design = self.design
        pull = column(design.each_stiff_cable, "max_pull") * design.stiff_cable_lengths
        return pull / column(design.each_drive, "spool_radius")

    @cached_property
    def _gear_ratios(self) -> FloatArray:
        return column(self.design.each_drive, "gear_ratio")

    @property
    def drive_angles(self) -> FloatArray:
        """(w,) how far each drive has turned its spool, play apart [rad], against the commanded angles."""
        return self.drives[:, ROTOR_ANGLE] / self._gear_ratios

    @property
    def poses_in_world(self) -> FloatArray:
        """(b, 7) position [m] and quaternion xyzw of every body, now."""
        poses, angles = self.world.read()
        if len(angles):
            second_poses(self.model, angles, poses)
        return poses

    def velocities_in_world(self) -> FloatArray:
        """(b, 6) linear [m/s] and angular [rad/s] velocity of every body.

        The engine's velocities live half a step before its poses, as in the leapfrog scheme, and so do these.
        """
        return velocities_between(self._state.last_poses, self.poses_in_world, self.dt)

    def node_positions_in_world(self) -> FloatArray:
        """(n, 3) [m], now."""
        return points_at(self.poses_in_world, self.model.node_bodies, self.model.node_points)

    def nodes_in_world(self, velocities: FloatArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Positions (n, 3) [m] and velocities (n, 3) [m/s], now; pass ``velocities`` (b, 6) when read already."""
        v = self.velocities_in_world() if velocities is None else velocities
        return nodes_in_world(self.poses_in_world, v, self.model.node_bodies, self.model.node_points)

    def centre_of_mass_in_world(self) -> FloatArray:
        """(3,) [m], now."""
        return self.model.masses @ self.poses_in_world[:, :3] / self.model.masses.sum()

    def momentum_in_world(self) -> tuple[FloatArray, FloatArray]:
        """Linear [kg m/s] and angular [kg m^2/s] momentum about the world origin, each (3,), half a step ago."""
        model = self.model
        return momentum(self.poses_in_world, self.velocities_in_world(), model.masses, model.inertias, self.dt)

    def energies(self, velocities: FloatArray | None = None) -> Energies:
        """Kinetic, gravity and elastic energy, flexures' in it, now; pass ``velocities`` (b, 6) when read already."""
        model, cables = self.model, self.model.first_flexure
        v = self.velocities_in_world() if velocities is None else velocities
        kinetic, potential, elastic = mechanical_energy(
            self.poses_in_world, v, model.masses, model.inertias, -self.gravity[2], model.spring_bodies[:cables],
            model.spring_params, self.natural_lengths,
        )  # fmt: skip
        potential -= float(model.masses @ self.poses_in_world[:, :2] @ self.gravity[:2])
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
        stiffness = self.model.spring_params[self.model.first_flexure :, STIFFNESS]
        return float(0.5 * stiffness @ self.flexure_angles**2)

    def forget_peak(self) -> None:
        """Let the largest tension of the totals be that from now on."""
        self._state.totals[PEAK_TENSION] = 0.0

    def totals(self) -> Totals:
        """What has added up since the last reset."""
        return Totals(*self._state.totals.tolist())

    def heights_of(self, points: FloatArray) -> FloatArray:
        """(k,) signed distance [m] of points (k, 3) to the ground; nan beyond its edges."""
        return distances_to_ground(points, self._ground)

    def level(self, nodes: FloatArray) -> float:
        """Height that heights count from [m]: that of the lowest foot, by the nodes (n, 3), where there are boxes to
        stand on, else 0."""
        return float((nodes[:, 2] - self.model.foot_radii).min()) if len(self._ground.boxes) else 0.0

    def foot_contacts(self) -> FloatArray:
        """(n,) 1.0 where a foot is within a millimetre of the ground, else 0.0."""
        if self.world.scene.ground is None:
            return np.zeros(len(self.model.node_bodies))
        gap = self.heights_of(self.node_positions_in_world()) - self.model.foot_radii
        return (gap <= GROUND_TOLERANCE).astype(float)
