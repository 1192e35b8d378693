"""Recording: what a robot did in one episode, as frozen arrays over time."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray, IntArray, frozen
from tensegym.design.design import RobotDesign
from tensegym.errors import InputError
from tensegym.physics.geometry import points_at
from tensegym.physics.model import Model
from tensegym.physics.robot_arrays import robot_model
from tensegym.physics.terrain import FLAT, Ground
from tensegym.structure.faces import Faces, hull_faces

SHAPES: dict[str, tuple[str | int, ...]] = {
    "times": ("t",), "poses": ("t", "b", 7), "bends": ("t", "p"), "tensions": ("t", "c"), "commands": ("t", "w"),
    "angles": ("t", "w"), "currents": ("t", "w"), "torques": ("t", "w"), "directions": ("t", 2), "places": ("t", 2),
    "faces": ("t",), "path": ("k", 2), "gravity": (3,), "heights": ("y", "y"), "boxes": ("x", 10),
}  # fmt: skip
"""Of each array its axes: t times, b bodies, p pins, c cables, w drives; what is over time has t first."""

_OF_GROUND = ("heights", "boxes")


class Limits(NamedTuple):
    """Of one drive, and of the cable that it winds."""

    current: float
    """[A]."""
    torque: float
    """At the spool, at that current [N m]."""
    tension: float
    """Of the cable, at that torque [N]."""


@dataclass(frozen=True, eq=False)
class Recording:
    """What a robot did, a row a time; rows of bodies and of cables as in `RobotState`. World axes, z up, SI units.

    Raises:
        InputError: arrays that do not fit the design or one another, or a time that does not grow.
    """

    design: RobotDesign
    times: FloatArray
    """(t,) since the robot was reset, growing [s]."""
    poses: FloatArray
    """(t, b, 7) centre of mass [m] and quaternion xyzw of every body."""
    bends: FloatArray
    """(t, p) angle of the pin of each split rod [rad]."""
    tensions: FloatArray
    """(t, c) of the elastic cables, the stiff cables, the payload's cables [N]."""
    commands: FloatArray
    """(t, w) commanded spool angles [rad]."""
    angles: FloatArray
    """(t, w) spool angles [rad]."""
    currents: FloatArray
    """(t, w) of the drives [A]."""
    torques: FloatArray
    """(t, w) load of the cable on its spool [N m]."""
    directions: FloatArray
    """(t, 2) unit vector that the robot is wanted to go along, nan where there is none."""
    places: FloatArray
    """(t, 2) where it is to go to [m], nan where there is no place."""
    faces: IntArray
    """(t,) index of the face it stands on, as last read; -1 where that is not known."""
    path: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    """(k, 2) points of the path it is to follow [m]."""
    ground: Ground | None = FLAT
    """The plane z = 0 or bumps about the origin, with boxes on it; or none."""
    gravity: FloatArray = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    """(3,) [m/s^2]; on a slope it leans, since z = 0 is the slope's plane."""
    title: str = ""
    """What the page is called."""
    engine: str = "pybullet"
    """It was simulated in."""
    dt: float = 2e-3
    """Physics time step [s]."""

    def __post_init__(self) -> None:
        model, what = self.model, f"a recording of {self.design.name}"
        sizes: dict[str | int, int] = {"b": len(model.masses), "p": len(model.pin_bodies), "c": model.first_flexure,
                                       "w": model.driven_count}  # fmt: skip
        for name, array in self.arrays().items():
            axes = SHAPES[name]
            if array.ndim == len(axes):  # the first array that has an axis says how long it is
                sizes |= {axis: n for axis, n in zip(axes, array.shape, strict=True) if axis not in sizes}
            wanted = tuple(axis if isinstance(axis, int) else sizes.get(axis) for axis in axes)
            if array.shape != wanted:
                raise InputError(f"{what}: {name} has shape {array.shape}, not {wanted}")
            if name not in ("directions", "places") and not np.isfinite(array).all():
                raise InputError(f"{what}: {name} has an entry that is no finite number")
            if name not in _OF_GROUND:
                frozen(array)
        if not len(self.times) or not (np.diff(self.times) > 0).all():
            raise InputError(f"{what} needs one time or more, each after the one before")

    def arrays(self) -> dict[str, FloatArray | IntArray]:
        """All arrays by their names in SHAPES; heights and boxes are the ground's."""
        found = {name: getattr(self, name) for name in SHAPES if name not in _OF_GROUND}
        return found | {name: getattr(self.ground or FLAT, name) for name in _OF_GROUND}

    @cached_property
    def model(self) -> Model:
        """The design's arrays: bodies of nodes and cables, and their points."""
        return robot_model(self.design)

    @property
    def limits(self) -> Limits:
        """Of each drive, where they differ of the strongest."""
        drive = max(self.design.each_drive, key=lambda drive: drive.torque_limit, default=self.design.drive)
        return Limits(drive.current_limit, drive.torque_limit, drive.torque_limit / drive.spool_radius)

    @property
    def seconds(self) -> float:
        """From the first time to the last [s]."""
        return float(self.times[-1] - self.times[0])

    @cached_property
    def nodes(self) -> FloatArray:
        """(t, n, 3) positions of the nodes [m]."""
        bodies, points = self.model.node_bodies, self.model.node_points
        return np.stack([points_at(poses, bodies, points) for poses in self.poses])

    @cached_property
    def _faces(self) -> Faces:
        return hull_faces(self.design.standing)

    @property
    def triangles(self) -> IntArray:
        """(f, 3) nodes of the faces that `faces` counts."""
        return self._faces.triangles

    @property
    def planes(self) -> IntArray:
        """(f,) of each face the first one that is level with it: standing on either is the same."""
        return self._faces.planes

    @cached_property
    def centres(self) -> FloatArray:
        """(t, 3) centre of mass [m]."""
        masses = self.model.masses
        return np.einsum("b,tbi->ti", masses / masses.sum(), self.poses[:, :, :3])
