"""The MuJoCo twin of a robot: free bodies, one-sided tendons, the ground, from the same arrays as the force kernel.

What differs from ours: a tendon's damper acts on a slack cable too, contacts are soft, there is no spin damping, and
drives are left to whoever moves the tendons' rest lengths.
"""

from __future__ import annotations

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.physics.model import DAMPING, END_A, END_B, STIFFNESS
from tensegym.physics.robot_arrays import robot_model

INTEGRATORS = {"MuJoCo Euler": "Euler", "MuJoCo implicitfast": "implicitfast", "MuJoCo RK4": "RK4"}


def twin_xml(design: RobotDesign, dt: float, integrator: str = "Euler", ground: bool = True) -> str:
    """MJCF of the design at time step dt [s]. Bodies, sites and tendons stand in the order of the kernel's arrays."""
    model = robot_model(design)
    sites: list[list[str]] = [[] for _ in model.masses]
    tendons = []
    for c, (params, natural) in enumerate(zip(model.spring_params, model.rest_lengths, strict=True)):
        for side, local in enumerate((params[END_A], params[END_B])):
            sites[model.spring_bodies[c, side]].append(f'<site name="{c}-{side}" pos="{_text(local)}"/>')
        tendons.append(
            f'<spatial stiffness="{params[STIFFNESS]:.17g}" damping="{params[DAMPING]:.17g}" '
            f'springlength="0 {natural:.17g}"><site site="{c}-0"/><site site="{c}-1"/></spatial>'
        )
    bodies = []
    for b, pose in enumerate(model.rest_poses):
        if b < len(design.standing.rods):
            half = design.standing.rod_lengths[b] / 2
            shape = f'<geom type="capsule" size="{design.rod(b).tube_outer_radius:.17g} {half:.17g}"/>'
        else:
            shape = f'<geom type="sphere" size="{design.payload.radius:.17g}"/>'
        bodies.append(
            f'<body pos="{_text(pose[:3])}" quat="{_text(np.roll(pose[3:], 1))}"><freejoint/>'
            f'<inertial pos="0 0 0" mass="{model.masses[b]:.17g}" diaginertia="{_text(model.inertias[b])}"/>'
            f"{shape}{''.join(sites[b])}</body>"
        )
    gravity = f"0 0 {-design.gravity if ground else 0:.17g}"
    plane = '<geom type="plane" size="0 0 1"/>' if ground else ""
    return (
        f'<mujoco><option timestep="{dt:.17g}" integrator="{integrator}" gravity="{gravity}"/>'
        f'<default><geom friction="{design.friction:.17g} 0 0"/></default>'
        f"<worldbody>{plane}{''.join(bodies)}</worldbody><tendon>{''.join(tendons)}</tendon></mujoco>"
    )


def _text(values: FloatArray) -> str:
    return " ".join(f"{value:.17g}" for value in values)


class Twin:
    """A design in MuJoCo, started where a robot of ours stands."""

    def __init__(self, design: RobotDesign, dt: float, integrator: str = "Euler", ground: bool = True) -> None:
        self.model = mujoco.MjModel.from_xml_string(twin_xml(design, dt, integrator, ground))
        self.data = mujoco.MjData(self.model)

    def place(self, poses: FloatArray, velocities: FloatArray | None = None) -> None:
        """Poses (b, 7) position and xyzw; velocities (b, 6) linear, angular, in the world; at rest by default."""
        mujoco.mj_resetData(self.model, self.data)
        for b, pose in enumerate(poses):
            self.data.qpos[7 * b : 7 * b + 7] = [*pose[:3], *np.roll(pose[3:], 1)]
            if velocities is not None:
                turn = np.empty(9)
                mujoco.mju_quat2Mat(turn, self.data.qpos[7 * b + 3 : 7 * b + 7])
                self.data.qvel[6 * b : 6 * b + 3] = velocities[b, :3]
                self.data.qvel[6 * b + 3 : 6 * b + 6] = turn.reshape(3, 3).T @ velocities[b, 3:]  # body axes

    def poses(self) -> FloatArray:
        """(b, 7) position [m] and quaternion xyzw of every body."""
        poses = self.data.qpos.reshape(-1, 7).copy()
        poses[:, 3:] = np.roll(poses[:, 3:], -1, axis=1)
        return poses

    def velocities(self) -> FloatArray:
        """(b, 6) linear [m/s] and angular [rad/s], in the world."""
        velocities = self.data.qvel.reshape(-1, 6).copy()
        velocities[:, 3:] = Rotation.from_quat(self.poses()[:, 3:]).apply(velocities[:, 3:])  # from body axes
        return velocities

    def set_rest_lengths(self, natural: FloatArray) -> None:
        """Rest lengths (c,) of the tendons [m]."""
        self.model.tendon_lengthspring[:, 1] = natural

    def step(self, steps: int) -> None:
        mujoco.mj_step(self.model, self.data, nstep=steps)
