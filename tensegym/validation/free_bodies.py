"""FreeBodies: single bodies in an engine, without cables, stepped as a robot's are or as the engine does alone."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.bodies import Body, Link, Shape
from tensegym.engine import Scene
from tensegym.physics.model import Model, new_out, new_state
from tensegym.physics.readings import step_back, velocities_between
from tensegym.physics.terrain import FLAT
from tensegym.robot.engines import open_world


def body(name: str, mass: float, inertia: Sequence[float], *shapes: Shape) -> Body:
    """One link with its principal moments [kg m^2] about x, y, z; without shapes it touches nothing."""
    x, y, z = inertia
    return Body(name, Link(name, mass, (x, y, z), shapes))


class FreeBodies:
    """Bodies of one link each in a world of an engine; a context manager.

    Args:
        engine: its name.
        bodies: what there is; the same name means the same body.
        dt: time step [s].
        friction: between all of them and the ground, the plane z = 0; no ground where it is None.
        gravity: straight down [m/s^2].
    """

    def __init__(
        self, engine: str, bodies: Sequence[Body], dt: float, friction: float | None = None, gravity: float = 0.0
    ) -> None:
        apart = np.array([[0, 0, 100.0 * (k + 1), 0, 0, 0, 1] for k in range(len(bodies))])
        ground = None if friction is None else FLAT
        self.dt = dt
        self.world = open_world(engine, Scene(tuple(bodies), apart, dt, friction or 0.0, gravity, ground))
        self.model = _free_model([b.link for b in bodies])
        self.out = new_out(self.model)
        self.state = new_state(self.model, self.world.poses, self.world.angles)

    def __enter__(self) -> FreeBodies:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.world.close()

    def start(self, poses: FloatArray, velocities: FloatArray) -> None:
        """Poses (b, 7) now and velocities (b, 6) in the world, of half a step ago as the leapfrog counts them."""
        self.world.restart(poses, velocities, np.zeros(0))
        self.world.read()
        self.state.last_poses[:] = poses
        step_back(self.state.last_poses, velocities, self.dt)

    def run(self, count: int) -> None:
        """Steps with the turning mended, as a robot's bodies are stepped. Bodies are symmetric about z."""
        self.world.run(count, self.model, FLAT, self.state, self.out, self.dt, False)

    def step(self, wrenches: FloatArray) -> None:
        """One step of the engine alone under forces and moments (b, 6) in the world."""
        self.state.last_poses[:] = self.world.read()[0]
        self.world.step(wrenches)

    @property
    def poses(self) -> FloatArray:
        """(b, 7) now, a copy."""
        return self.world.read()[0].copy()

    @property
    def velocities(self) -> FloatArray:
        """(b, 6) half a step ago, from the last two poses."""
        return velocities_between(self.state.last_poses, self.world.read()[0], self.dt)


def _free_model(links: Sequence[Link]) -> Model:
    """The arrays of bodies that no spring holds."""
    count = len(links)
    masses, inertias = np.array([link.mass for link in links]), np.array([link.inertia for link in links])
    params = np.column_stack([1 / masses, 1 / inertias[:, 0], 1 / inertias[:, 2], np.zeros(count)])
    return Model(
        spring_bodies=np.zeros((0, 2), int), spring_params=np.zeros((0, 9)), rest_lengths=np.zeros(0), first_driven=0,
        driven_count=0, drive_params=np.zeros((0, 14)), body_params=params, other_half=np.full(count, -1),
        masses=masses, inertias=inertias, rest_poses=np.zeros((count, 7)), pin_bodies=np.zeros((0, 2), int),
        pin_params=np.zeros((0, 9)), joint_bodies=np.zeros((0, 2), int), joint_points=np.zeros((0, 6)),
        joint_first=np.zeros(0, int), joined=np.zeros(0, int), node_bodies=np.zeros(0, int),
        node_points=np.zeros((0, 3)), foot_radii=np.zeros(0),
    )  # fmt: skip
