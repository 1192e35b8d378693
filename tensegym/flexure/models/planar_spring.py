"""PlanarSpring: the paper's planar case of the spatial spring, with constant stiffnesses, placed by a and b.

With p = (x, y) of the moving origin in the fixed frame, c = cos(theta), s = sin(theta), in the moving frame's axes:

    f_x = kx x c + (kx + ky)/2 y s,   f_y = ky y c - (kx + ky)/2 x s
    m   = (kx - ky)/2 (x c + y s)(y c - x s) + kz s

Rakshin and Borisov 2023, eq. (2), with the factor 1/2 in m that its print lost and without which it has no potential

    V = 1/4 p^T K p + 1/4 p^T R K R^T p + kz (1 - cos(theta)).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States
from tensegym.flexure.hinge.ranges import check_positive, finite_array

from .potential_fit import MOMENT_UNIT, TIP_UNIT


def spring_wrench(x: FloatArray, y: FloatArray, theta: FloatArray, kx: FloatArray | float, ky: FloatArray | float,
                  kz: FloatArray | float) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Force in the moving axes and moment about the moving origin, by the equations above; arrays broadcast.

    Args:
        x, y: of the moving origin in the fixed frame [m].
        theta: [rad].
        kx, ky: [N/m].
        kz: [N m/rad].

    Returns:
        f_x, f_y [N] and m [N m].
    """
    c, s = np.cos(theta), np.sin(theta)
    mean = 0.5 * (kx + ky)
    f_x = kx * x * c + mean * y * s
    f_y = ky * y * c - mean * x * s
    m = 0.5 * (kx - ky) * (x * c + y * s) * (y * c - x * s) + kz * s
    return f_x, f_y, m


def spring_energy(x: FloatArray, y: FloatArray, theta: FloatArray, kx: float, ky: float, kz: float) -> FloatArray:
    """V [J] of the equations above."""
    c, s = np.cos(theta), np.sin(theta)
    turned = kx * (c * x + s * y) ** 2 + ky * (c * y - s * x) ** 2
    return 0.25 * (kx * x * x + ky * y * y) + 0.25 * turned + kz * (1 - c)


def spring_poses(theta: FloatArray, force: FloatArray, length: float, b: float, kx: FloatArray | float,
                 ky: FloatArray | float, kz: FloatArray | float) -> States:  # fmt: skip
    """States of a spring placed at a = 1 - b; its equations are linear in p.

    Args:
        theta: (n,) [rad].
        force: (n, 2) dead force at the tip in base axes [N].
        length: L [m].
        b: link from the spring to the tip, of L.
        kx, ky, kz: stiffnesses [N/m, N/m, N m/rad], numbers or (n,).

    Returns:
        The states, NaN where the spring has no stiffness.
    """
    c, s = np.cos(theta), np.sin(theta)
    f_x, f_y = c * force[:, 0] + s * force[:, 1], c * force[:, 1] - s * force[:, 0]
    mean = 0.5 * (kx + ky)
    det = kx * ky * c * c + mean * mean * s * s
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y = (ky * c * f_x - mean * s * f_y) / det, (kx * c * f_y + mean * s * f_x) / det
    _, _, m = spring_wrench(x, y, theta, kx, ky, kz)
    arm = b * length
    tip = np.column_stack([length - arm + x + arm * c, y + arm * s])
    moment = m - arm * (c * force[:, 1] - s * force[:, 0])
    lost = ~(np.isfinite(tip).all(1) & np.isfinite(moment))
    tip[lost], moment[lost] = np.nan, np.nan
    return States(theta, tip, np.broadcast_to(force, (len(theta), 2)), moment)


@dataclass(frozen=True)
class PlanarSpring:
    """A planar spring of constant stiffness at a = 1 - b; a gradient, so passive, but too simple for drift."""

    length: float
    """L [m]."""
    b: float
    """Link from the spring to the tip, of L; a = 1 - b."""
    kx: float
    """[N/m]."""
    ky: float
    """[N/m]."""
    kz: float
    """[N m/rad]."""

    def __post_init__(self) -> None:
        check_positive("length", self.length, "m")
        finite_array([self.b], "b", 1)
        for name, unit in (("kx", "N/m"), ("ky", "N/m"), ("kz", "N m/rad")):
            check_positive(name, getattr(self, name), unit)

    @property
    def a(self) -> float:
        return 1 - self.b

    def poses(self, theta: FloatArray, force: FloatArray) -> States:
        """States at theta (n,) [rad] under the dead force (n, 2) [N] at the tip."""
        return spring_poses(theta, force, self.length, self.b, self.kx, self.ky, self.kz)

    def energies(self, states: States) -> FloatArray:
        """(n,) strain energy [J]."""
        c, s = np.cos(states.theta), np.sin(states.theta)
        arm = self.b * self.length
        x, y = states.tip[:, 0] - self.length + arm - arm * c, states.tip[:, 1] - arm * s
        return spring_energy(x, y, states.theta, self.kx, self.ky, self.kz)


def fit_planar(states: States, length: float) -> PlanarSpring:
    """b, kx, ky, kz by least squares on tip and moment over the states, weighed as in the potential's fit.

    Args:
        states: those that are not whole are passed over.
        length: L [m].

    Raises:
        FlexureError: for too few states, or states without rotation or moment.
    """
    states = states.whole()
    if 3 * len(states) < 5:
        raise FlexureError(f"{len(states)} states; the planar spring's 4 coefficients need 2 or more")
    moment_scale = float(np.abs(states.moment).max())
    if not (moment_scale > 0 and np.abs(states.theta).max() > 0):
        raise FlexureError("no rotation or no moment in the states: nothing to fit; load the hinge")
    # start: kz from the moment, a soft ky and a stiff kx; logarithms keep stiffnesses positive
    stiff = moment_scale / float(np.abs(states.theta).max())
    first = np.array([0.5, np.log(1e3 * stiff / length**2), np.log(1e1 * stiff / length**2), np.log(stiff)])

    def residual(v: FloatArray) -> FloatArray:
        predicted = spring_poses(states.theta, states.force, length, v[0], *np.exp(v[1:]))
        return np.concatenate([((predicted.tip - states.tip) / (length * TIP_UNIT)).ravel(),
                               (predicted.moment - states.moment) / (moment_scale * MOMENT_UNIT)])  # fmt: skip

    ends = [
        least_squares(residual, first * [b, 1, 1, 1], bounds=([-1, -60, -60, -60], [2, 60, 60, 60]))
        for b in (0.6, 1.0, 1.4)
    ]
    best = min(ends, key=lambda end: end.cost)
    return PlanarSpring(length, float(best.x[0]), *(float(k) for k in np.exp(best.x[1:])))
