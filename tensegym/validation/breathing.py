"""M1 and M3: the breathing mode, in which all rods move outwards together, in the engine."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.design.design import RobotDesign
from tensegym.design.parameters import ElasticCable, Rod
from tensegym.robot.engines import TITLES
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.modes import breathing_frequency
from tensegym.structure.structure import Structure, six_rod

from .check import Check


def equal_rods(damping: float) -> RobotDesign:
    """Six equal rods and the 24 elastic cables tied on the axes, no spin damping: the closed forms' robot."""
    whole = six_rod()
    return RobotDesign(
        structure=Structure(whole.nodes, whole.rods, whole.cables, np.zeros((0, 2), int)),
        active_rod=Rod(),
        passive_rod=Rod(),
        elastic_cable=ElasticCable(damping=damping),
        attachment_radius=0.0,
        spin_damping=0.0,
    )


def breathe(
    damping: float, dt: float = 1e-3, periods: int = 30, engine: str = "pybullet"
) -> tuple[float, float]:
    """Breathing mode in free flight: frequency [Hz] from zero crossings, damping ratio from peaks."""
    with TensegrityRobot(equal_rods(damping), dt=dt, ground=False, engine=engine) as robot:
        poses = robot.model.rest_poses
        outward = poses[:, :3] - poses[:, :3].mean(axis=0)
        velocities = np.zeros((6, 6))
        velocities[:, :3] = 2e-3 * outward / np.linalg.norm(outward, axis=1)[:, None]
        robot.reset_rotated(Rotation.identity(), velocities)
        expected = breathing_frequency(10.0, robot.design.mass / 6, robot.design.standing.lengths([[0, 4]])[0])
        speeds = []
        for _ in range(int(periods / expected / dt)):
            robot.step()
            v, x = robot.velocities_in_world()[:, :3], robot.poses_in_world[:, :3]
            radial = x - x.mean(axis=0)
            speeds.append(((v * radial).sum(axis=1) / np.linalg.norm(radial, axis=1)).mean())
    s = np.array(speeds)
    falls = np.flatnonzero((s[:-1] > 0) & (s[1:] <= 0))
    crossings = (falls + s[falls] / (s[falls] - s[falls + 1])) * dt
    frequency = (len(crossings) - 1) / (crossings[-1] - crossings[0])
    peaks = [s[a:b].max() for a, b in pairwise(falls)]
    decrement = np.log(peaks[0] / peaks[-1]) / (len(peaks) - 1)
    return float(frequency), float(decrement / (2 * np.pi))


def rows(engine: str = "pybullet") -> Iterator[Check]:
    """M1 and M3 in an engine at 1 ms."""
    design = equal_rods(0.0)
    expected = breathing_frequency(10.0, design.passive_rod.mass, design.standing.lengths([[0, 4]])[0])
    frequency, _ = breathe(0.0, engine=engine)
    yield Check("M1", f"breathing mode in {TITLES[engine]}, 1 ms: Hz", expected, frequency, 5e-4 * expected)
    _, ratio = breathe(5.0, engine=engine)
    yield Check("M3", "its damping ratio with cable dampers of 5 N s/m", 0.0, ratio, 1e-4)
