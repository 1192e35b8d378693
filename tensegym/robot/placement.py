"""A design's bodies where they are to stand: made in the air, then on the ground."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.bodies import design_bodies
from tensegym.design.design import RobotDesign
from tensegym.engine import Scene
from tensegym.physics.geometry import points_at
from tensegym.physics.model import PIN_AXIS, Model
from tensegym.physics.terrain import Ground


def robot_scene(design: RobotDesign, model: Model, dt: float, ground: Ground | None) -> Scene:
    """Rods and payload as they stand, but far above the ground, so that nothing is in contact; no gravity without a
    ground."""
    bodies = design_bodies(design)
    poses = model.rest_poses[: len(bodies)].copy()
    poses[:, 2] += 10
    joined = tuple((a, b) for a, b in design.structure.joined.tolist())
    gravity = design.gravity if ground else 0.0
    return Scene(bodies, poses, dt, design.friction, gravity, ground, joined)


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
