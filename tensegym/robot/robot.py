"""TensegrityRobot: a design standing in a world; reset it, command its drives, step it."""

from __future__ import annotations

from types import TracebackType
from typing import cast

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.engine import Closed, World
from tensegym.errors import DesignError, SimulationError
from tensegym.physics.drives import COMMAND
from tensegym.physics.robot_arrays import robot_model
from tensegym.physics.terrain import FLAT, Ground, Terrain
from tensegym.structure.faces import resting_rotation

from .clearance import check_clear
from .energy_check import SPEED_BOUND
from .engines import open_world
from .fault import divergence
from .placement import pin_rates, placed, reach, robot_scene
from .robot_state import RobotState
from .step_check import Integrator, held_implicit

_MOST_AT_ONCE = 1000  # substeps, some 20 ms of them, between two looks at signals such as Ctrl-C


class TensegrityRobot(RobotState):
    """A design in an engine's world, with its cables and drives; RobotState has its readings.

    A context manager; `close` frees the engine.

    dt is the physics time step [s]. ground: the plane z = 0, none and no gravity, a Terrain, flat where the robot
    starts, or a Ground with boxes on it. ``integrator`` picks explicit or linearly implicit cable forces; "auto" takes
    explicit ones where dt is within their stability limit. Raises DesignError for a dt no integrator holds.
    ``engine``, ``gui`` and ``compiled``: see `tensegym.robot.engines.open_world`.
    """

    def __init__(
        self, design: RobotDesign | None = None, *, dt: float = 1e-3, ground: bool | Terrain | Ground = True,
        integrator: Integrator = "auto", gui: bool = False, compiled: bool | None = None, engine: str = "pybullet",
    ) -> None:  # fmt: skip
        design = design or RobotDesign()
        model = robot_model(design)
        self.implicit = held_implicit(design, model, dt, integrator)
        check_clear(design)

        surface = ground if isinstance(ground, Ground) else FLAT
        if isinstance(ground, Terrain):
            surface = Ground(ground.heights(reach(model)), ground.cell)
        scene = robot_scene(design, model, dt, surface if ground else None)
        self.engine = engine
        super().__init__(design, model, surface, open_world(engine, scene, gui, compiled), dt)
        self.reset()

    def close(self) -> None:
        """Free the engine; what needs it raises SimulationError from now on."""
        self.world.close()
        self.world = cast(World, Closed())

    def __enter__(self) -> TensegrityRobot:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    # -- start ----------------------------------------------------------------------------------------------------

    def reset(self, face: int | None = 0, heading: float = 0.0, height: float = 0.0) -> None:
        """Stand at rest on a face (an index into `faces`), turned by ``heading`` [rad] about the vertical.

        With a ``height`` [m] the lowest foot is so far above z = 0, and the robot is about to fall.
        ``face=None`` leaves the structure unrotated, its lowest foot on the ground: the paper's first pose.
        """
        nodes = self.design.standing.nodes
        if face is None:
            turn = Rotation.from_euler("z", heading)
        else:
            if not 0 <= face < len(self.faces.triangles):
                raise DesignError(f"face = {face} is outside 0..{len(self.faces.triangles) - 1}")
            turn = Rotation.from_matrix(resting_rotation(nodes, self.faces.triangles[face], heading))
        self.reset_rotated(turn, height=height)

    def reset_rotated(
        self, rotation: Rotation, velocities: FloatArray | None = None, height: float = 0.0
    ) -> None:
        """Start with the standing structure rotated about its centre of mass, lowest foot ``height`` [m] above z = 0.

        velocities (b, 6): linear [m/s] and angular [rad/s] of every body, halves as their pin allows; at rest by
        default.
        """
        poses = placed(self.model, rotation)
        poses[:, 2] += height
        moving = np.zeros((len(poses), 6)) if velocities is None else velocities
        rates = pin_rates(self.model, rotation, moving)
        self.world.restart(poses, moving, rates)
        self._restart(rates, velocities)

    def push(self, velocity: ArrayLike) -> None:
        """Add a velocity (3,) [m/s] to the whole robot, a disturbance that no cable notices."""
        self.world.push(velocity)
        self._shift_velocity(np.asarray(velocity))

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
        self.drives[:, COMMAND] = angles

    def angles_of(self, action: FloatArray) -> FloatArray:
        """Spool angles (w,) [rad] of an action (w,): -1 lets a cable out to its rest length, 1 is the deepest pull."""
        return (action + 1) / 2 * self.command_limit

    def step(self, substeps: int = 1) -> None:
        """Advance by ``substeps`` time steps. Raises SimulationError when the simulation has diverged."""
        for first in range(0, substeps, _MOST_AT_ONCE):
            self.world.run(min(substeps - first, _MOST_AT_ONCE), self.model, self._ground, self._state, self._out,
                           self.dt, self.implicit)  # fmt: skip
        self.time += substeps * self.dt
        if self._ground.rough or len(self._ground.boxes):
            self._check_ground()
        # bodies that diverge drag their cables along
        whole = len(self.rates) or np.isfinite(self.poses_in_world).all()
        if not (whole and np.abs(self.rates).max(initial=0.0) < SPEED_BOUND):
            raise SimulationError(divergence(self))

    def _check_ground(self) -> None:
        """Raise SimulationError for a foot that is lost: other than a plane, bumps have an edge, and an underside."""
        heights = self.heights_of(self._state.node_positions)
        lost = ~(heights >= -self.model.foot_radii)
        if lost.any():
            foot = int(lost.argmax())
            where = "over the edge of" if np.isnan(heights[foot]) else "through"
            raise SimulationError(f"foot {foot + 1} went {where} the ground by t = {self.time:.4g} s")
