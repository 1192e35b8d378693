"""I1: what free flight keeps, and cables that only pull."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.design.design import RobotDesign, flexible_design
from tensegym.robot.robot import TensegrityRobot

from .check import Check


@dataclass(frozen=True)
class FreeFlight:
    """Relative drift of linear and angular momentum, least tension, and tensions of cables that were slack."""

    linear_drift: float
    angular_drift: float
    least_tension: float
    slack_tension: float
    slack_seen: int


def free_flight(
    dt: float = 1e-3, seconds: float = 2.0, seed: int = 0, design: RobotDesign | None = None, engine: str = "pybullet"
) -> FreeFlight:
    """Fly without gravity, tumbling, the drives commanded at random every 0.2 s; default: six rods, no spin damping."""
    rng = np.random.default_rng(seed)
    with TensegrityRobot(design or RobotDesign(spin_damping=0.0), dt=dt, ground=False, engine=engine) as robot:
        rest = robot.model.rest_poses[:, :3]
        turning, moving = np.array([1.0, 2.0, -1.5]), np.array([0.3, -0.2, 0.1])
        centre = robot.model.masses @ rest / robot.model.masses.sum()
        velocities = np.hstack([moving + np.cross(turning, rest - centre), np.tile(turning, (len(rest), 1))])
        robot.reset_rotated(Rotation.identity(), velocities)
        start = robot.momentum_in_world()
        least, slack_tension, slack_seen, linear, angular = np.inf, 0.0, 0, 0.0, 0.0
        for _ in range(round(seconds / 0.2)):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            for _ in range(round(0.2 / dt)):
                before = robot.natural_lengths.copy()
                robot.step()
                slack = robot.lengths < before
                least = min(least, robot.tensions.min())
                slack_tension = max(slack_tension, np.abs(robot.tensions[slack]).max(initial=0.0))
                slack_seen += int(slack.sum())
            now = robot.momentum_in_world()
            linear = max(linear, float(np.linalg.norm(now[0] - start[0]) / np.linalg.norm(start[0])))
            angular = max(angular, float(np.linalg.norm(now[1] - start[1]) / np.linalg.norm(start[1])))
    return FreeFlight(float(linear), float(angular), float(least), float(slack_tension), slack_seen)


def rows(engine: str = "pybullet") -> Iterator[Check]:
    """I1: momentum and one-sided cables in free flight, of rigid and of flexible rods."""
    for rods, design in (("", RobotDesign()), (", flexible rods", flexible_design())):
        seen = free_flight(design=design.with_(spin_damping=0.0), engine=engine)
        yield Check("I1", f"linear momentum, relative drift in 2 s{rods}", 0.0, seen.linear_drift, 1e-6)
        yield Check("I1", f"angular momentum, relative drift in 2 s{rods}", 0.0, seen.angular_drift, 1e-6)
        yield Check("I1", f"least tension, N, where negative{rods}", 0.0, min(seen.least_tension, 0.0), 0)
        yield Check("I1", f"tension of slack cables, N{rods}", 0.0, seen.slack_tension, 0)
