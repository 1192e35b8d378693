"""Springs: the models of a robot's flexure joints as flat arrays for the kernels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box
from tensegym.flexure.models.planar_spring import PlanarSpring
from tensegym.flexure.models.potential import Potential
from tensegym.flexure.models.stiffness_diagram import StiffnessDiagram
from tensegym.flexure.models.torsion_spring import TorsionSpring

from . import spring_kernel

Spring = Potential | PlanarSpring | TorsionSpring


class Springs(NamedTuple):
    """One row a flexure joint. A named tuple, as compiled functions take one."""

    kind: IntArray
    """(f,) POTENTIAL, PLANAR or TORSION of spring_kernel."""
    columns: IntArray
    """(f, 6) columns of x, y, theta, z, turn about y, turn about x among the moving joints; -1 where held."""
    coefficients: FloatArray
    """(f, 8, d) of the potentials, padded with zeros."""
    rows: FloatArray
    """(f, 5) potential: L, M0, theta0; planar: L, b L, kx, ky, kz; torsion: L, lambda L, stiffness."""
    across: FloatArray
    """(f, 3) stiffness of z [N/m], of the turns about y and x [N m/rad]."""
    loss_time: FloatArray
    """(f,) B = loss time x K(q) [s]."""
    box: FloatArray
    """(f, 5) largest rotation [rad], and middle x, y and half range x, y of the forces on the base axes [N]."""


def spring_row(spring: Spring | StiffnessDiagram) -> tuple[int, list[float]]:
    """Kind and parameters. Raises FlexureError for a model that has no energy."""
    if isinstance(spring, Potential):
        return spring_kernel.POTENTIAL, [spring.length, spring.moment_scale, spring.angle_scale, 0.0, 0.0]
    if isinstance(spring, PlanarSpring):
        return spring_kernel.PLANAR, [spring.length, spring.b * spring.length, spring.kx, spring.ky, spring.kz]
    if isinstance(spring, TorsionSpring):
        return spring_kernel.TORSION, [spring.length, spring.fraction * spring.length, spring.stiffness, 0.0, 0.0]
    raise FlexureError(f"a {type(spring).__name__} is no gradient of an energy: take potential, planar or torsion")


def spring_table(springs: Sequence[Spring], columns: Sequence[Sequence[int]], across: Sequence[Sequence[float]],
                 loss_times: Sequence[float], boxes: Sequence[Box]) -> Springs:  # fmt: skip
    """The table of all joints of a robot; empty sequences give an empty one."""
    count = len(springs)
    rows = [spring_row(spring) for spring in springs]
    potentials = [s.coefficients if isinstance(s, Potential) else np.zeros((8, 1)) for s in springs]
    coefficients = np.zeros((count, 8, max((p.shape[1] for p in potentials), default=1)))
    for f, own in enumerate(potentials):
        coefficients[f, :, : own.shape[1]] = own
    return Springs(
        np.array([kind for kind, _ in rows], dtype=np.int64),
        np.array(columns, dtype=np.int64).reshape(count, 6),
        coefficients,
        np.array([row for _, row in rows], dtype=float).reshape(count, 5),
        np.array(across, dtype=float).reshape(count, 3),
        np.array(loss_times, dtype=float),
        np.array([[b.max_angle, *b.centre, *b.half] for b in boxes], dtype=float).reshape(count, 5),
    )
