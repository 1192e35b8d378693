"""Rods that share a node: a chain in free flight, a double pendulum, a spine that stands and bends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.design.groups import Group
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import Structure
from tensegym.validation.row import Findings, Row

CHAIN = [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.3, 0.3, 0.05], [0.4, 0.4, 0.3]]  # m
HANGING = 0.3, 0.25  # m, rods of the double pendulum
LET_GO = 1.0, 0.4  # rad from the vertical
SPINE = {"structure": {"builder": "spine", "vertebrae": 2}, "attachment_radius": 0.0, "friction": 2.0}
SLOPES = {"stands": 0.0, "bends, on a slope of 0.2 rad": 0.2}


def bare(nodes: Sequence[ArrayLike], **changes: object) -> RobotDesign:
    """A chain of rods alone, from node to node."""
    none, count = np.zeros((0, 2), dtype=int), len(nodes)
    rods = np.column_stack([np.arange(count - 1), np.arange(1, count)])
    structure = Structure(np.array(nodes, dtype=float), rods, none, none)
    return RobotDesign(structure=structure, form_finding=False, spin_damping=0.0).with_(**changes)


def gap(robot: TensegrityRobot) -> float:
    """Largest distance along an axis between two rods' ends at a joint [m]."""
    model, poses = robot.model, robot.poses_in_world
    ends = [poses[bodies, :3] + Rotation.from_quat(poses[bodies, 3:]).apply(points) for bodies, points in zip(
        model.joint_bodies.T, np.split(model.joint_points, 2, axis=1), strict=True)]  # fmt: skip
    return float(np.abs(ends[1] - ends[0]).max())


def chain_in_flight(engine: str, dt: float, seconds: float = 2.0) -> tuple[float, float, float]:
    """Drift of linear and of angular momentum as parts of what they were, and the widest gap at a joint [m]."""
    with TensegrityRobot(bare(CHAIN), ground=False, dt=dt, engine=engine) as robot:
        centres, turn, own = robot.model.rest_poses[:, :3], np.array([1.0, 3.0, 2.0]), np.array([0.0, 5.0, -4.0])
        velocities = np.hstack([0.3 + np.cross(turn, centres - centres.mean(axis=0)), np.tile(turn, (3, 1))])
        velocities[2] += [*np.cross(own, centres[2] - CHAIN[2]), *own]
        robot.reset_rotated(Rotation.identity(), velocities)
        robot.step(1)
        start, drift, widest = robot.momentum_in_world(), np.zeros(2), 0.0
        for _ in range(round(seconds / dt) // 20):
            robot.step(20)
            now = [np.linalg.norm(b - a) / np.linalg.norm(a)
                   for a, b in zip(start, robot.momentum_in_world(), strict=True)]  # fmt: skip
            drift, widest = np.maximum(drift, now), max(widest, gap(robot))
    return float(drift[0]), float(drift[1]), widest


def equations(time: float, state: FloatArray, first: FloatArray, second: FloatArray, gravity: float) -> FloatArray:
    """Lagrange's, of a double pendulum: angles from the vertical and their rates (4,) to what they change by.

    first, second (3,): mass [kg], moment of inertia about the middle [kg m^2] and length [m] of a rod.
    """
    (m1, i1, l1), (m2, i2, l2) = first, second
    a, b, u, v = state
    across, along = m2 * l1 * l2 / 2 * np.sin(a - b), m2 * l1 * l2 / 2 * np.cos(a - b)
    mass = [[i1 + m1 * l1**2 / 4 + m2 * l1**2, along], [along, i2 + m2 * l2**2 / 4]]
    force = [-across * v**2 - (m1 / 2 + m2) * l1 * gravity * np.sin(a),
             across * u**2 - m2 * l2 / 2 * gravity * np.sin(b)]  # fmt: skip
    return np.array([u, v, *np.linalg.solve(mass, force)])


def double_pendulum(engine: str, dt: float, seconds: float = 2.0) -> tuple[float, float]:
    """How far the free end is at most from where scipy puts it, in the plane and out of it, as parts of both lengths.

    The upper rod hangs from the end of a third one, heavy, which is put back in its place after every step.
    """
    (first, second), start, every = HANGING, np.array(LET_GO), 20
    sides = np.stack([np.sin(start), np.zeros(2), -np.cos(start)], axis=1)
    nodes: list[ArrayLike] = [[0, -0.3, 0], [0, 0, 0], first * sides[0], first * sides[0] + second * sides[1]]
    design = bare(nodes, rods=(Group("base", ((0, 1),), {"tube_mass": 100.0, "end_mass": 100.0}),))
    rods = [np.array([design.rod(i).mass, design.rod(i).transverse_inertia(length), length])
            for i, length in ((1, first), (2, second))]  # fmt: skip
    given = rods[0], rods[1], design.gravity
    at_rest, times = np.array([*start, 0.0, 0.0]), np.arange(0, seconds, every * dt)
    a, b = solve_ivp(equations, (0, seconds), at_rest, t_eval=times, args=given, rtol=1e-10, atol=1e-12).y[:2]
    wanted = np.stack([first * np.sin(a) + second * np.sin(b), -first * np.cos(a) - second * np.cos(b)], axis=1)
    # velocities live half a step before poses: a little before it was let go
    rates = -dt / 2 * equations(0, at_rest, *given)[2:]
    velocities = np.zeros((3, 6))
    velocities[1:, 4] = -rates  # about y, which turns x towards -z
    ends = (rates * HANGING)[:, None] * np.stack([-sides[:, 2], sides[:, 1], sides[:, 0]], axis=1)
    velocities[1, :3], velocities[2, :3] = ends[0] / 2, ends[0] + ends[1] / 2
    found = []
    with TensegrityRobot(design, dt=dt, engine=engine) as robot:
        robot.reset_rotated(Rotation.identity(), velocities, height=2.0)
        place, pivot = robot.poses_in_world[0].copy(), robot.node_positions_in_world()[1]
        for step in range(every * len(times)):
            if step % every == 0:
                found.append(robot.node_positions_in_world()[3] - pivot)
            robot.step(1)
            poses, moving = robot.poses_in_world.copy(), robot.velocities_in_world()
            poses[0], moving[0] = place, 0.0
            robot.world.place(poses, moving)
    apart = np.abs(np.array(found)) / sum(HANGING)
    off = np.abs(np.array(found)[:, [0, 2]] - wanted) / sum(HANGING)
    return float(off.max()), float(apart[:, 1].max())


def spine_at_rest(engine: str, slope: float) -> tuple[float, float]:
    """How far statics move a node of the upper vertebra [m], and how far from there the simulation leaves one [m].

    Statics: moved as one rigid body, it has least energy of cables and weight.
    """
    design = design_from_dict(SPINE)
    with TensegrityRobot(design, dt=2e-3, engine=engine) as robot:
        robot.reset(face=None)
        robot.slope(slope, np.array([1.0, 0.0]))
        robot.step(1500)
        rest, weight = robot.node_positions_in_world(), 6 * design.rod(0).mass * robot.gravity
    built, cables, natural = design.standing.nodes, design.structure.cables, design.cable_natural_lengths
    given = built[4:] + (rest[:4] - built[:4]).mean(axis=0)
    middle = given.mean(axis=0)  # of its nodes, and of its mass

    def nodes(move: FloatArray) -> FloatArray:
        turned = Rotation.from_rotvec(move[3:]).apply(given - middle)
        return np.vstack([rest[:4], turned + middle + move[:3]])

    def energy(move: FloatArray) -> float:
        at = nodes(move)
        stretch = np.linalg.norm(at[cables[:, 1]] - at[cables[:, 0]], axis=1) - natural
        elastic = design.elastic_cable.stiffness / 2 * (np.maximum(stretch, 0) ** 2).sum()
        return float(elastic - weight @ at[4:].mean(axis=0))

    found = nodes(minimize(energy, np.zeros(6), method="BFGS", options={"gtol": 1e-9}).x)[4:]
    moved = float(np.linalg.norm(found - given, axis=1).max())
    return moved, float(np.linalg.norm(rest[4:] - found, axis=1).max())


def shared_nodes(engine: str) -> Findings:
    """Three rods in a chain tumble for 2 s; two hang as a double pendulum, let go at 1 and 0.4 rad, for 2 s; a spine of
    two tetrahedra settles, level and on a slope, where its upper vertebra has the least energy of a rigid body's."""
    dt, rows = 1e-3, list[Row]()
    linear, angular, widest = chain_in_flight(engine, dt)
    off, aside = double_pendulum(engine, dt)
    rows += [Row("joints", "chain in flight: linear momentum, relative drift", 0.0, linear, 1e-9, dt),
             Row("joints", "chain in flight: angular momentum, relative drift", 0.0, angular, 1e-9, dt),
             Row("joints", "chain in flight: widest gap at a joint, m", 0.0, widest, 1e-12, dt),
             Row("joints", "double pendulum: free end from scipy's, lengths", 0.0, off, 1e-3, dt),
             Row("joints", "double pendulum: out of its plane, lengths", 0.0, aside, 2e-9, dt)]  # fmt: skip
    for name, slope in SLOPES.items():
        moved, apart = spine_at_rest(engine, slope)
        rows.append(Row("joints", f"spine that {name}: nodes from its statics, of how far they move", 0.0,
                        apart / moved, 0.02, 2e-3, f"Statics move a node by {1e3 * moved:.3g} mm."))  # fmt: skip
    return Findings(rows)
