"""Scene: what stands in a world, as an engine is given it."""

from __future__ import annotations

from typing import NamedTuple

from tensegym.arrays import FloatArray
from tensegym.design.bodies import Body
from tensegym.physics.box import Box
from tensegym.physics.terrain import Ground


class Scene(NamedTuple):
    """Bodies, and the ground under them, with one coefficient of friction between all.

    Bodies touch the ground and one another, a body's own two links not each other. There is no bounce, no rolling
    friction, no damping and no sleeping.
    """

    bodies: tuple[Body, ...]
    poses: FloatArray
    """(k, 7) pose of each body's first link where it is made: centre of mass [m], quaternion xyzw; clear of the ground
    and of one another."""
    dt: float
    """Time step [s]."""
    friction: float
    """Coulomb coefficient."""
    gravity: float = 0.0
    """Straight down [m/s^2]; `World.set_gravity` changes it."""
    ground: Ground | None = None
    """The plane z = 0 or a field of heights, with boxes on it that nothing moves; or none."""
    joined: tuple[tuple[int, int], ...] = ()
    """Rows of bodies that do not touch each other, since they share a node."""

    @property
    def boxes(self) -> tuple[Box, ...]:
        """Those that stand on the ground."""
        return self.ground.obstacles if self.ground else ()
