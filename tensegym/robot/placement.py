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
from tensegym.physics.geometry import points_at
from tensegym.physics.model import PIN_AXIS, Model


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


def reach(model: Model) -> float:
    """How far any foot reaches from the centre of mass at rest [m]."""
    feet = _feet(model, model.rest_poses)
    return float((np.linalg.norm(feet - _centre(model), axis=1) + model.foot_radii).max())


def placed(model: Model, rotation: Rotation) -> FloatArray:
    """(b, 7) poses of the standing robot rotated about its centre of mass, which is above the origin, the lowest foot
    touching z = 0."""
    poses = model.rest_poses.copy()
    poses[:, :3] = rotation.apply(poses[:, :3] - _centre(model))
    poses[:, 3:] = (rotation * Rotation.from_quat(poses[:, 3:])).as_quat()
    poses[:, 2] -= (_feet(model, poses)[:, 2] - model.foot_radii).min()
    return poses


def pin_rates(model: Model, rotation: Rotation, velocities: FloatArray) -> FloatArray:
    """(p,) rates [rad/s] of the pins of the standing robot, so rotated, under the bodies' velocities (b, 6)."""
    first, second = model.pin_bodies.T
    axes = rotation.apply(Rotation.from_quat(model.rest_poses[first, 3:]).apply(model.pin_params[:, PIN_AXIS]))
    return ((velocities[second, 3:] - velocities[first, 3:]) * axes).sum(axis=1)


def _centre(model: Model) -> FloatArray:
    return model.masses @ model.rest_poses[:, :3] / model.masses.sum()


def _feet(model: Model, poses: FloatArray) -> FloatArray:
    return points_at(poses, model.node_bodies, model.node_points)
