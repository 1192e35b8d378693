"""Rods that share a node: momentum, energy, a frame; a double pendulum is among the problems of the validation page."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.design.design import RobotDesign
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import Structure

NONE = np.zeros((0, 2), dtype=int)


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
