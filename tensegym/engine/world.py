"""World: what a robot needs of an engine."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tensegym.arrays import FloatArray
from tensegym.physics.model import Model, Out
from tensegym.physics.model import State as Arrays
from tensegym.physics.terrain import Ground

from .leapfrog import engine_substep
from .scene import Scene
from .uncopied import Uncopied

State = Any
"""An engine's state as `World.save` gives it."""
GROUND = -1  # in place of a link's row


class Contact(NamedTuple):
    """A point where a link touches the ground or another link: of the last step, as it began; world axes."""

    link: int
    """Row of the link."""
    other: int
    """Row of the other one, or GROUND, which boxes are a part of."""
    place: FloatArray
    """(3,) on the other one [m]."""
    normal: FloatArray
    """(3,) unit vector from the other one to the link."""
    distance: float
    """Along it [m], negative where they overlap."""
    push: float
    """What the other one exerts on the link along the normal [N]."""
    friction: FloatArray
    """(3,) and what along the surface [N]."""


class World(Uncopied, ABC):
    """Rigid bodies of one link, or of two that a pin joins, which touch the ground and each other: the protocol of
    engines.

    A robot sees only this, and its cables, drives and flexures are not in it: it reads poses, gives every link a force
    and a moment, and lets the engine take one time step, which integrates, finds contacts and solves them. Velocities
    live half a step before poses, as in the leapfrog scheme (an engine's semi-implicit Euler step is one): a robot
    tells them from two poses and never reads the engine's.

    Rows of per-link arrays are the bodies' first links in the order of the scene, then the second links in that order;
    columns of per-pin arrays are in that order too. Equal calls give equal bits.
    """

    scene: Scene
    poses: FloatArray
    """(l, 7) centre of mass [m], quaternion xyzw of every link, as last read; the caller fills second links' rows."""
    angles: FloatArray
    """(p,) of the pins [rad], as last read."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        pins = sum(body.second is not None for body in scene.bodies)
        self.poses, self.angles = np.zeros((len(scene.bodies) + pins, 7)), np.zeros(pins)

    @abstractmethod
    def close(self) -> None:
        """Free the engine; further calls fail."""

    # -- placing ------------------------------------------------------------------------------------------------------

    @abstractmethod
    def place(
        self, poses: FloatArray, velocities: FloatArray, angles: FloatArray | None = None,
        rates: FloatArray | None = None,
    ) -> None:  # fmt: skip
        """Set every first link's pose (k, 7) and velocity (k, 6) linear [m/s], angular [rad/s], world axes; pins'
        angles (p,) [rad] and rates (p,) [rad/s], else 0. Rows of second links, which follow, may be left out."""

    @abstractmethod
    def restart(self, poses: FloatArray, velocities: FloatArray, rates: FloatArray) -> None:
        """The same with the pins straight, and nothing left of what was before: equal starts go on in equal bits."""

    @abstractmethod
    def push(self, velocity: ArrayLike) -> None:
        """Add a velocity (3,) [m/s] to every body."""

    @abstractmethod
    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Gravity (3,) in the world [m/s^2], until it is set again; what `save` keeps is without it."""

    # -- stepping -----------------------------------------------------------------------------------------------------

    @abstractmethod
    def read(self) -> tuple[FloatArray, FloatArray]:
        """Bring `poses` and `angles` up to date and return them. Second links' rows follow from both: the caller fills
        them."""

    @abstractmethod
    def step(self, wrenches: FloatArray) -> None:
        """Apply force [N] and moment [N m], (l, 6), about the links' centres as last read, world axes, and advance one
        time step. Forces on second links may be left out: `engine_substep` makes none."""

    def run(
        self, count: int, model: Model, ground: Ground, state: Arrays, out: Out, dt: float, implicit: bool
    ) -> None:
        """Take ``count`` substeps of a robot whose arrays (see physics/model.py) share this world's `poses` and
        `angles`. Engines that can do the same in compiled code do, to the same bits."""
        for _ in range(count):
            self.read()
            engine_substep(model, ground, state, out, dt, implicit)
            self.step(out.wrenches)

    # -- state --------------------------------------------------------------------------------------------------------

    @abstractmethod
    def save(self) -> State:
        """Keep the engine's state in memory."""

    @abstractmethod
    def restore(self, state: State) -> None:
        """Bring a state back: what follows is the same to the last bit."""

    @abstractmethod
    def contacts(self) -> list[Contact]:
        """Those of the last step."""
