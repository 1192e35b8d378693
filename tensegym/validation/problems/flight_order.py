"""Convergence in the time step, in free flight: the order of either cable integrator."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation.breathing import equal_rods
from tensegym.validation.row import Findings, Row

Integrator = Literal["explicit", "implicit"]
FINEST, SECONDS = 0.02e-3, 0.5
DAMPERS = 5.0  # N s/m, as the robot's cables have
SERIES: dict[str, tuple[Integrator, float, tuple[float, ...]]] = {
    "explicit": ("explicit", 0.0, (0.1e-3, 0.2e-3, 0.5e-3, 1e-3, 1.25e-3)),
    "implicit": ("implicit", 0.0, (0.01e-3, 0.02e-3, 0.05e-3, 0.1e-3, 0.2e-3, 0.5e-3, 1e-3, 2e-3, 4e-3)),
    "implicit, with dampers": ("implicit", DAMPERS, (0.1e-3, 0.2e-3, 0.5e-3, 1e-3, 2e-3, 4e-3)),
}  # fmt: skip


def flight(engine: str, integrator: Integrator, dt: float, damping: float) -> FloatArray:
    """Nodes (n, 3) [m] of a robot, let go with its rods moving apart at random, after half a second in the air."""
    design = equal_rods(damping)  # without stiff cables, which would fall slack and snap taut
    moving = np.zeros((len(design.structure.rods), 6))
    moving[:, :3] = np.random.default_rng(0).normal(0, 0.05, (len(moving), 3))
    with TensegrityRobot(design, dt=dt, ground=False, integrator=integrator, engine=engine) as robot:
        robot.reset_rotated(Rotation.identity(), moving)
        robot.step(round(SECONDS / dt))
        return robot.node_positions_in_world()


def flight_order(engine: str) -> Findings:
    """The leapfrog with explicit cable forces is of second order; with implicit ones, those of the step's end, it is of
    the first, and takes vibration of cables without dampers away. The robots' have dampers, which do so first."""
    errors, curves = {}, {}
    for name, (integrator, damping, steps) in SERIES.items():
        exact = flight(engine, "explicit", FINEST, damping)
        errors[name] = [float(np.sqrt(((flight(engine, integrator, dt, damping) - exact) ** 2).sum(axis=1).mean()))
                        for dt in steps]  # fmt: skip
        curves[name] = [[1e3 * dt for dt in steps], [1e3 * error for error in errors[name]]]

    def order(name: str, count: int) -> float:
        return float(np.polyfit(np.log(SERIES[name][2][:count]), np.log(errors[name][:count]), 1)[0])

    dampened = errors["implicit, with dampers"][SERIES["implicit, with dampers"][2].index(2e-3)]
    return Findings([
        Row("flight", "order of the nodes' error, explicit", 2.0, order("explicit", 5), 0.1),
        Row("flight", "order of the nodes' error, implicit, steps up to 0.05 ms", 1.0, order("implicit", 3), 0.15),
        Row("flight", "error with the robot's dampers, implicit, rod lengths", 0.0, dampened / 0.7, 1e-4, 2e-3),
    ], curves)  # fmt: skip
