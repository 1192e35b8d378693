"""A design's bodies placed in a world: loaded there, stood on the ground."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.bullet import World, packaged_urdf
from tensegym.design.design import RobotDesign
from tensegym.design.urdf_writer import rod_files, urdf_files
from tensegym.physics.cable_geometry import points_in_world
from tensegym.physics.robot_arrays import CableArrays
from tensegym.physics.split_rods import AXIS


def load_bodies(world: World, design: RobotDesign, poses: FloatArray) -> None:
    """Load rods and payload at ``poses`` (b, 7), but far above the ground, so that nothing is in contact."""
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
            world.load(paths[name], [pose[0], pose[1], pose[2] + 10, *pose[3:]], design.friction)


def reach(cables: CableArrays) -> float:
    """How far any foot reaches from the centre of mass at rest [m]."""
    feet = _feet(cables, cables.rest_poses)
    return float((np.linalg.norm(feet - _centre(cables), axis=1) + cables.foot_radii).max())


def placed(cables: CableArrays, rotation: Rotation) -> FloatArray:
    """(b, 7) poses of the standing robot rotated about its centre of mass, which is above the origin, the lowest foot
    touching z = 0."""
    poses = cables.rest_poses.copy()
    poses[:, :3] = rotation.apply(poses[:, :3] - _centre(cables))
    poses[:, 3:] = (rotation * Rotation.from_quat(poses[:, 3:])).as_quat()
    poses[:, 2] -= (_feet(cables, poses)[:, 2] - cables.foot_radii).min()
    return poses


def pin_rates(cables: CableArrays, rotation: Rotation, velocities: FloatArray) -> FloatArray:
    """(p,) rates [rad/s] of the pins of the standing robot, so rotated, under the bodies' velocities (b, 6)."""
    pins = cables.pins
    axes = rotation.apply(Rotation.from_quat(cables.rest_poses[pins.bodies[:, 0], 3:]).apply(pins.params[:, AXIS]))
    return ((velocities[pins.bodies[:, 1], 3:] - velocities[pins.bodies[:, 0], 3:]) * axes).sum(axis=1)


def _centre(cables: CableArrays) -> FloatArray:
    return cables.masses @ cables.rest_poses[:, :3] / cables.masses.sum()


def _feet(cables: CableArrays, poses: FloatArray) -> FloatArray:
    feet = np.empty((len(cables.feet), 3))
    points_in_world(poses, cables.feet, cables.foot_points, feet)
    return feet
