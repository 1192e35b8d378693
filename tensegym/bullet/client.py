"""Client: a physics client of PyBullet with a ground, a camera and gravity."""

from __future__ import annotations

import os
import threading
import weakref
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from tensegym.arrays import FloatArray
from tensegym.engine import Uncopied
from tensegym.errors import SimulationError

from .bodies import make_ground
from .camera import Camera
from .engine import pybullet

# Contact points of one body nearer to each other than this part of its size count as one, the last found of them: on a
# surface of triangles that may be the one with a neighbour of the triangle a foot presses on, which then holds nothing
_MERGING, _FINE_MERGING = 0.02, 0.004  # the engine's own; 1.4 mm on a rod of 0.7 m
# The engine has one such setting for all clients of a process, so one world steps at a time
_STEPPING = threading.RLock()


def _disconnect(client: int) -> None:
    if pybullet.isConnected(physicsClientId=client):
        pybullet.disconnect(physicsClientId=client)


class Client(Uncopied):
    """A connection to the engine. gravity: straight down [m/s^2].

    Raises SimulationError for a window without a display.
    """

    def __init__(self, dt: float, gravity: float, gui: bool = False) -> None:
        if gui and not os.environ.get("DISPLAY"):
            raise SimulationError("no display to open a window on: set DISPLAY, or render to rgb_array instead")
        self.client = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)
        """The client's number."""
        if self.client < 0:
            raise SimulationError("PyBullet gave no physics client; close other worlds first")
        self._finalizer = weakref.finalize(self, _disconnect, self.client)
        self.ground: int | None = None
        """The engine's number of the ground."""
        self.camera = Camera(self.client)
        self._fine_contacts = False
        pybullet.setGravity(0, 0, -gravity, physicsClientId=self.client)
        pybullet.setTimeStep(dt, physicsClientId=self.client)
        pybullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1, physicsClientId=self.client)

    def close(self) -> None:
        """Disconnect; further calls fail."""
        self._finalizer()

    def add_ground(self, friction: float, heights: FloatArray | None = None, cell: float = 0.0) -> int:
        """The plane z = 0, or a grid of heights (n, n) [m] over x and y, ``cell`` [m] apart, about the origin; returns
        the engine's number of it."""
        self.ground = make_ground(self.client, friction, heights, cell)
        self._fine_contacts = heights is not None and len(heights) > 0
        return self.ground

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Gravity (3,) in the world [m/s^2], in place of the one straight down."""
        pybullet.setGravity(*gravity, physicsClientId=self.client)

    def advance(self) -> None:
        """One time step under the forces already given."""
        with _STEPPING:
            pybullet.stepSimulation(self.client)

    @contextmanager
    def stepping(self) -> Iterator[None]:
        """Steps are taken within it, no other client's meanwhile: on rough ground contacts with neighbouring triangles
        are kept apart by a setting that the engine has once a process."""
        with _STEPPING:
            if not self._fine_contacts:
                yield
                return
            pybullet.setPhysicsEngineParameter(contactBreakingThreshold=_FINE_MERGING, physicsClientId=self.client)
            try:
                yield
            finally:
                if pybullet.isConnected(physicsClientId=self.client):
                    pybullet.setPhysicsEngineParameter(contactBreakingThreshold=_MERGING, physicsClientId=self.client)
