"""Rods that share a node: momentum, energy, a double pendulum against its equations."""

import numpy as np
import pybullet
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tensegym.design.design import RobotDesign
from tensegym.design.groups import Group
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import Structure

NONE = np.zeros((0, 2), dtype=int)
GRAVITY = 9.81


def bare(nodes, pairs, **changes):
    """Rods alone."""
    structure = Structure(np.array(nodes, dtype=float), pairs, NONE, NONE)
    return RobotDesign(structure=structure, form_finding=False, spin_damping=0.0, **changes)


CHAIN = bare([[0, 0, 0], [0.3, 0, 0], [0.3, 0.3, 0.05], [0.4, 0.4, 0.3]], [(0, 1), (1, 2), (2, 3)])
CORNERS = 0.2 * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
OCTAHEDRON = bare(CORNERS, [(a, b) for a in range(6) for b in range(a + 1, 6) if b != a + 1 or a % 2])


def apart(robot):
    """Largest distance along an axis between two rods' ends at a joint [m]."""
    model, poses = robot.model, robot.poses_in_world
    turns = Rotation.from_quat(poses[:, 3:])
    ends = [poses[model.joint_bodies[:, side], :3] + turns[model.joint_bodies[:, side]].apply(
        model.joint_points[:, 3 * side : 3 * side + 3]) for side in range(2)]  # fmt: skip
    return np.abs(ends[1] - ends[0]).max()


def tumbling(design, swing=True):
    """Velocities of the whole about its middle, and of the last rod about its joint."""
    with TensegrityRobot(design, ground=False) as robot:
        model = robot.model
        centres, turn = model.rest_poses[:, :3], np.array([1.0, 3.0, 2.0])
        middle = model.masses @ centres / model.masses.sum()
        velocities = np.hstack([np.cross(turn, centres - middle), np.tile(turn, (len(centres), 1))])
        if swing:
            node = design.structure.rods[-1][0]
            own = np.array([0.0, 5.0, -4.0])
            velocities[-1] += [*np.cross(own, centres[-1] - design.standing.nodes[node]), *own]
        return velocities


def flight(design, velocities, dt, engine="pybullet", seconds=2.0):
    """Change of both momenta, widest gap at a joint, and the energies."""
    with TensegrityRobot(design, ground=False, dt=dt, engine=engine) as robot:
        robot.reset_rotated(Rotation.identity(), velocities)
        robot.step(1)
        before, gaps, energies = np.concatenate(robot.momentum_in_world()), [], []
        for _ in range(round(seconds / dt) // 40):
            robot.step(40)
            gaps.append(apart(robot))
            energies.append(robot.energies().total)
        return np.abs(np.concatenate(robot.momentum_in_world()) - before).max(), max(gaps), np.array(energies)


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_a_chain_in_free_flight_keeps_its_momentum_and_stays_together(engine):
    if engine == "mujoco":
        pytest.importorskip("mujoco")
    velocities = tumbling(CHAIN)
    changed, gap, fine = flight(CHAIN, velocities, 1e-3, engine)
    assert changed < 1e-12
    assert gap < 1e-12
    coarse = flight(CHAIN, velocities, 2e-3, engine)[2]
    assert np.ptp(fine) / fine[0] < 1e-5
    assert np.ptp(coarse) / np.ptp(fine) == pytest.approx(4, rel=0.05)  # no drift: an error of second order


def test_a_frame_of_rods_flies_as_the_rigid_body_that_it_is():
    """Twelve rods along an octahedron's edges leave its six rigid motions and the rods' spins."""
    changed, gap, energies = flight(OCTAHEDRON, tumbling(OCTAHEDRON, swing=False), 2e-3, seconds=1.0)
    assert changed < 1e-12
    assert gap < 1e-12
    assert np.ptp(energies) / energies[0] < 1e-4


def pendulum(time, state, first, second):
    """Of two rods, each of mass m, moment i about its middle and length l, hung one from the other; angles from the
    vertical. (Lagrange's equations.)"""
    (m1, i1, l1), (m2, i2, l2) = first, second
    a, b, u, v = state
    across, along = m2 * l1 * l2 / 2 * np.sin(a - b), m2 * l1 * l2 / 2 * np.cos(a - b)
    mass = [[i1 + m1 * l1**2 / 4 + m2 * l1**2, along], [along, i2 + m2 * l2**2 / 4]]
    force = [-across * v**2 - (m1 / 2 + m2) * l1 * GRAVITY * np.sin(a),
             across * u**2 - m2 * l2 / 2 * GRAVITY * np.sin(b)]  # fmt: skip
    return [u, v, *np.linalg.solve(mass, force)]


def test_a_double_pendulum_swings_as_its_equations_say():
    """Its upper rod hangs from the end of a third one, which is put back in its place after every step."""
    first, second, start, dt = 0.3, 0.25, np.array([1.0, 0.4]), 1e-3
    sides = np.array([[np.sin(angle), 0, -np.cos(angle)] for angle in start])
    nodes = [[0, -0.3, 0], [0, 0, 0], first * sides[0], first * sides[0] + second * sides[1]]
    heavy = Group("base", ((0, 1),), {"tube_mass": 100.0, "end_mass": 100.0})
    design = bare(nodes, [(0, 1), (1, 2), (2, 3)], rods=(heavy,))
    rods = [(design.rod(i).mass, design.rod(i).transverse_inertia(length), length)
            for i, length in ((1, first), (2, second))]  # fmt: skip
    at_rest = [*start, 0.0, 0.0]
    times = np.arange(0, 2.0, 20 * dt)
    angles = solve_ivp(pendulum, (0, 2.0), at_rest, t_eval=times, args=rods, rtol=1e-10, atol=1e-12).y[:2]
    wanted = np.array([first * np.sin(angles[0]) + second * np.sin(angles[1]),
                       -first * np.cos(angles[0]) - second * np.cos(angles[1])])  # fmt: skip
    # velocities live half a step before poses: a little before it was let go
    rates = -dt / 2 * np.array(pendulum(0, at_rest, *rods)[2:])
    velocities = np.zeros((3, 6))
    velocities[1:, 4] = -rates  # about y, which turns x towards -z
    ends = [rate * length * np.array([-side[2], 0, side[0]])
            for rate, length, side in zip(rates, (first, second), sides, strict=True)]  # fmt: skip
    velocities[1, :3], velocities[2, :3] = ends[0] / 2, ends[0] + ends[1] / 2
    found, gap = [], 0.0
    with TensegrityRobot(design, dt=dt) as robot:
        robot.reset_rotated(Rotation.identity(), velocities, height=2.0)
        base, place = robot.world.body_ids[0], robot.poses_in_world[0].copy()
        pivot = robot.node_positions_in_world()[1]
        for step in range(2000):
            if step % 20 == 0:
                found.append(robot.node_positions_in_world()[3] - pivot)
                gap = max(gap, apart(robot))
            robot.step(1)
            pybullet.resetBasePositionAndOrientation(base, place[:3], place[3:], physicsClientId=robot.world.client)
            pybullet.resetBaseVelocity(base, [0, 0, 0], [0, 0, 0], physicsClientId=robot.world.client)
            robot.world._stale = True
            robot._state.last_poses[0] = place
    found = np.array(found)
    assert np.abs(found[:, 1]).max() < 1e-9  # in its plane
    assert np.abs(found[:, [0, 2]].T - wanted).max() < 1e-3 * (first + second)
    assert gap < 2e-5  # what the base would fall in a step, g dt^2
