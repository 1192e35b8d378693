"""Ball joints between rods that share a node: the leapfrog's projected ones beside both engines' own constraints.

    python benchmarks/joints.py

A chain of three rods tumbles freely for 2 s, joined by `tensegym.engine.joint_step`, by PyBullet's point-to-point
constraint or by MuJoCo's `connect`: how far rods part, what angular momentum and energy change, what a substep costs.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pybullet
from scipy.spatial.transform import Rotation

import tensegym.mujoco.world as mujoco_world
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.mujoco.mjcf import scene_mjcf, text
from tensegym.physics.model import Model
from tensegym.report import table
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import Structure

NODES = [[0, 0, 0], [0.3, 0, 0], [0.3, 0.3, 0.05], [0.4, 0.4, 0.3]]
NONE = np.zeros((0, 2), dtype=int)
WAYS = ("projected, PyBullet", "PyBullet's constraint", "projected, MuJoCo", "MuJoCo's connect")


def chain() -> RobotDesign:
    structure = Structure(np.array(NODES, dtype=float), [(0, 1), (1, 2), (2, 3)], NONE, NONE)  # type: ignore[arg-type]
    return RobotDesign(structure=structure, form_finding=False, spin_damping=0.0)


def robot_of(design: RobotDesign, way: str, dt: float, ground: bool = False) -> tuple[TensegrityRobot, Model]:
    """A robot joined in a way, and its joints as they would be projected."""
    engine = "mujoco" if "MuJoCo" in way else "pybullet"
    model = TensegrityRobot(design, dt=dt, ground=ground).model
    joints = list(zip(model.joint_bodies.tolist(), model.joint_points, strict=True))
    if way == WAYS[3]:
        lines = [f'<connect body1="body_{a}" body2="body_{b}" anchor="{text(at[:3])}"/>' for (a, b), at in joints]
        whole = f"<equality>{''.join(lines)}</equality></mujoco>"
        mujoco_world.scene_mjcf = lambda scene: scene_mjcf(scene).replace("</mujoco>", whole)
    robot = TensegrityRobot(design, dt=dt, ground=ground, engine=engine)
    mujoco_world.scene_mjcf = scene_mjcf
    world: Any = robot.world
    if way == WAYS[1]:
        for (a, b), at in joints:
            one, two, kind = world.body_ids[a], world.body_ids[b], pybullet.JOINT_POINT2POINT
            pybullet.createConstraint(one, -1, two, -1, kind, [0, 0, 0], at[:3].tolist(), at[3:].tolist(),
                                      physicsClientId=world.client)  # fmt: skip
    if way in (WAYS[1], WAYS[3]):
        robot.model = robot.model._replace(joint_bodies=model.joint_bodies[:0], joint_points=model.joint_points[:0],
                                           joint_first=model.joint_first[:0], joined=model.joined[:0])  # fmt: skip
    return robot, model


def tumbling(design: RobotDesign, model: Model) -> np.ndarray:
    """Velocities of the whole, and of the last rod about its joint."""
    centres, turn, own = model.rest_poses[:, :3], np.array([1.0, 3.0, 2.0]), np.array([0.0, 5.0, -4.0])
    velocities = np.hstack([np.cross(turn, centres - centres.mean(axis=0)), np.tile(turn, (len(centres), 1))])
    velocities[-1] += [*np.cross(own, centres[-1] - design.standing.nodes[2]), *own]
    return velocities


def apart(robot: TensegrityRobot, model: Model) -> float:
    poses = robot.poses_in_world
    ends = [poses[model.joint_bodies[:, side], :3] + Rotation.from_quat(poses[model.joint_bodies[:, side], 3:]).apply(
        model.joint_points[:, 3 * side : 3 * side + 3]) for side in range(2)]  # fmt: skip
    return float(np.abs(ends[1] - ends[0]).max())


def flight(way: str, dt: float) -> list[str]:
    design = chain()
    robot, model = robot_of(design, way, dt)
    with robot:
        robot.reset_rotated(Rotation.identity(), tumbling(design, model))
        robot.step(1)
        before, gaps, energies = robot.momentum_in_world()[1], [], [robot.energies().total]
        for _ in range(round(2 / dt) // 20):
            robot.step(20)
            gaps.append(apart(robot, model))
            energies.append(robot.energies().total)
        turned = np.abs(robot.momentum_in_world()[1] - before).max() / np.linalg.norm(before)
    change = np.array(energies) / energies[0] - 1
    found = max(gaps), turned, np.abs(change).max(), change[-1]
    return [way, f"{1e3 * dt:g}", *(f"{number:.1e}" for number in found)]


def cost(vertebrae: int, dt: float, rounds: int = 15) -> list[list[str]]:
    """Microseconds of a substep of a spine that stands, median of rounds in turn."""
    design = design_from_dict({"structure": {"builder": "spine", "vertebrae": vertebrae}})
    robots = {way: robot_of(design, way, dt, ground=True)[0] for way in WAYS}
    times: dict[str, list[float]] = {way: [] for way in WAYS}
    for _ in range(rounds):
        for way, robot in robots.items():
            robot.reset(face=None)
            start = time.perf_counter()
            robot.step(200)
            times[way].append((time.perf_counter() - start) / 200 * 1e6)
    joints = len(robots[WAYS[0]].model.joint_bodies)
    return [[way, str(vertebrae), str(len(design.structure.rods)), str(joints), f"{np.median(t):.0f}"]
            for way, t in times.items()]  # fmt: skip


if __name__ == "__main__":
    header = ["joints", "dt ms", "apart m", "angular momentum", "energy, most", "at the end"]
    print(table(header, [flight(way, dt) for way in WAYS for dt in (1e-3, 2e-3)]))
    header = ["joints", "vertebrae", "rods", "joints", "us a substep, 1 ms"]
    print("\n" + table(header, [row for n in (2, 4) for row in cost(n, 1e-3)]))
