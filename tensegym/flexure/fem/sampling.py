"""States of a hinge over its box of rotations and forces, by the FEM: for fits, and held out from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from tensegym.errors import FlexureError
from tensegym.flexure.hinge.hinge import Hinge, positive
from tensegym.flexure.hinge.states import FloatArray, States

from . import solve as fem


@dataclass(frozen=True)
class Box:
    """Where a model is fitted and meant to be used: |theta| and the dead force at the tip in base axes, each axis."""

    max_angle: float
    """[rad], in (0, pi/2)."""
    max_force: float
    """|Fx| and |Fy| at most [N], in (0, inf)."""

    def __post_init__(self) -> None:
        if not 0 < self.max_angle < np.pi / 2:
            raise FlexureError(f"max_angle = {self.max_angle:g} rad is outside (0, pi/2)")
        positive("max_force", self.max_force, "N")


def moment_at(hinge: Hinge, angle: float, elements: int = fem.ELEMENTS) -> float:
    """Pure moment that turns the tip by ``angle`` [rad], [N m]."""
    solution = fem.rotate(hinge, np.array([angle]), elements=elements)
    if solution.status[0] != fem.CONVERGED:
        raise FlexureError(f"{hinge.name}: {solution.reason(0)} (pure moment up to {angle:g} rad); lower max_angle")
    return float(solution.moment[0])


def default_box(hinge: Hinge, max_angle: float | None = None, max_force: float | None = None) -> Box:
    """The hinge's own range of rotation, and forces up to M / L with M the pure moment at the largest rotation."""
    angle = hinge.max_angle if max_angle is None else max_angle
    if not 0 < angle < np.pi / 2:
        raise FlexureError(f"max_angle = {angle:g} rad is outside (0, pi/2)")
    return Box(angle, moment_at(hinge, angle) / hinge.length if max_force is None else max_force)


def fit_states(hinge: Hinge, box: Box, count: int = 600, seed: int = 0, elements: int = fem.ELEMENTS) -> States:
    """States for a fit: a scrambled Sobol sequence over the box, denser at its faces, where polynomials err most."""
    if count < 8:
        raise FlexureError(f"count = {count}; a fit needs 8 states or more")
    draws = qmc.Sobol(3, seed=seed).random_base2(int(np.ceil(np.log2(count))))[:count]
    return states_at(hinge, box, -np.cos(np.pi * draws), elements)


def held_out_states(
    hinge: Hinge, box: Box, count: int = 300, seed: int = 12345, elements: int = fem.ELEMENTS
) -> States:
    """Uniformly random wrenches of the box; keep the seed out of any fit."""
    return states_at(hinge, box, np.random.default_rng([seed, 1]).uniform(-1, 1, (count, 3)), elements)


def states_at(hinge: Hinge, box: Box, unit: FloatArray, elements: int = fem.ELEMENTS) -> States:
    """States at ``unit`` (n, 3) in [-1, 1]: theta, force x, force y in units of the box, each by its path from rest.

    Raises FlexureError when one cannot be reached or is unstable under its dead load: the box goes past buckling.
    """
    force = box.max_force * unit[:, 1:]
    solution = fem.rotate(hinge, box.max_angle * unit[:, 0], force=force, elements=elements, from_rest=True)
    bad = np.flatnonzero((solution.status != fem.CONVERGED) | ~solution.stable)
    if len(bad):
        i = int(bad[0])
        why = solution.reason(i) or "is unstable under that dead load: past buckling"
        raise FlexureError(
            f"{hinge.name}: at theta = {np.degrees(box.max_angle * unit[i, 0]):.3g} deg with the force "
            f"({force[i, 0]:.4g}, {force[i, 1]:.4g}) N the hinge {why}; lower max_force = {box.max_force:.4g} N or "
            "max_angle"
        )
    return solution.states()
