"""SweepTimes: seconds of one 60-point sweep of a hinge by the FEM and by its potential, warm, in this process."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tensegym.flexure import fem
from tensegym.flexure.fem import newton
from tensegym.flexure.fem.path import sweep

from . import potential_kernel
from .joint import Joint
from .potential import Potential

POINTS = 60


@dataclass(frozen=True)
class SweepTimes:
    """Best of several runs."""

    fem: float
    """[s]."""
    potential: float
    """[s]."""


def best_of(call: Callable[[], object], runs: int) -> float:
    """Shortest time of one call [s], after one to warm up."""
    call()
    best = np.inf
    for _ in range(runs):
        began = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - began)
    return float(best)


def sweep_times(joint: Joint, runs: int = 20, elements: int = fem.ELEMENTS) -> SweepTimes:
    """Both from the same rotations and forces, from rest to the box's angle: the force across the arm the FEM found.

    Arrays in, arrays out on both sides; a mesh or a table made once is not counted.
    """
    assert joint.hinge is not None
    potential = joint.models["potential"]
    assert isinstance(potential, Potential)
    theta = joint.box.max_angle * np.arange(1, POINTS + 1) / POINTS
    direction = fem.arm_direction(theta, joint.hinge.arm) if joint.hinge.arm else np.tile([0.0, 0.0, 1.0], (POINTS, 1))
    cases = np.zeros((POINTS, 8))
    cases[:, newton.THETA] = theta
    cases[:, newton.WX : newton.WM + 1] = direction
    mesh = fem.mesh_of(joint.hinge, elements)
    force = np.ascontiguousarray(sweep(mesh, newton.ROTATION, cases, False, False)[0][:, 3:5])
    slow = best_of(lambda: sweep(mesh, newton.ROTATION, cases, False, False), runs)
    model = (potential.coefficients, potential.scales)
    fast = best_of(lambda: potential_kernel.pose_batch(*model, theta, force), 50 * runs)
    return SweepTimes(slow, fast)
