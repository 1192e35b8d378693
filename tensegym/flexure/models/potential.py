"""Potential: a hinge as one passive planar joint, its wrench the gradient of an energy that is never negative."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box, States
from tensegym.flexure.hinge.ranges import check_positive

from . import potential_kernel
from .potential_kernel import NAMES, RHO, SIGMA


@dataclass(frozen=True)
class Potential:
    """V(theta, p) of potential_kernel.py with its units and its box; the reference's section 3, odd terms added.

    Passive by construction: V >= 0, zero at rest only, and the wrench is its gradient, so no closed loop makes energy.
    Inside the box it is certified (certificate.py); a load outside is refused.
    """

    coefficients: FloatArray
    """(8, degree + 1) rows named in potential_kernel.NAMES, powers of theta / angle_scale, dimensionless."""
    length: float
    """L [m]."""
    moment_scale: float
    """M0 [N m]: unit of energy; M0 / L is the unit of force."""
    angle_scale: float
    """theta0 [rad]."""
    box: Box
    """Where the fit holds."""
    scales: FloatArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        rows = np.ascontiguousarray(self.coefficients, dtype=float)
        if rows.ndim != 2 or rows.shape[0] != len(NAMES) or not np.isfinite(rows).all():
            raise FlexureError(f"coefficients have shape {rows.shape}; give 8 finite rows: {', '.join(NAMES)}")
        for name in ("length", "moment_scale", "angle_scale"):
            check_positive(name, getattr(self, name))
        if rows[RHO, 0] != 0 or rows[SIGMA, 0] != 0:
            raise FlexureError("rho and sigma must have no constant term: the joint rests at (L, 0)")
        object.__setattr__(self, "coefficients", rows)
        object.__setattr__(self, "scales", np.array([self.length, self.moment_scale, self.angle_scale]))

    def wrench(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        """The wrench that holds the tip at a pose. Not refused outside the box: a simulation may pass through.

        Args:
            x, y: of the tip in base axes [m].
            theta: [rad].

        Returns:
            Force x, y in base axes [N] and moment about the tip [N m].
        """
        fx, fy, moment, _ = potential_kernel.wrench(self.coefficients, self.scales, x, y, theta)
        return fx, fy, moment

    def energy(self, x: float, y: float, theta: float) -> float:
        """V [J]."""
        return float(potential_kernel.wrench(self.coefficients, self.scales, x, y, theta)[3])

    def stiffness(self, x: float, y: float, theta: float) -> FloatArray:
        """(3, 3) symmetric Jacobian of the wrench over (x, y, theta)."""
        out = np.empty((3, 3))
        potential_kernel.stiffness(self.coefficients, self.scales, x, y, theta, out)
        return out

    def wrenches(self, poses: ArrayLike) -> FloatArray:
        """(n, 3) wrenches of (n, 3) poses x, y, theta."""
        return np.asarray(potential_kernel.wrench_batch(self.coefficients, self.scales, _table(poses, 3, "poses"))[0])

    def stiffnesses(self, poses: ArrayLike) -> FloatArray:
        """(n, 3, 3) Jacobians of the wrench at (n, 3) poses x, y, theta."""
        return np.asarray(potential_kernel.stiffness_batch(self.coefficients, self.scales, _table(poses, 3, "poses")))

    def poses(self, theta: ArrayLike, force: ArrayLike) -> States:
        """The states under given rotations and dead forces; explicit, nothing is solved for.

        Args:
            theta: (n,) [rad].
            force: (2,) or (n, 2) at the tip in base axes [N].

        Raises:
            FlexureError: for a row outside the box.
        """
        angle = np.ascontiguousarray(np.atleast_1d(np.asarray(theta, dtype=float)))
        forces = np.ascontiguousarray(np.broadcast_to(np.asarray(force, dtype=float), (len(angle), 2)))
        out = potential_kernel.pose_batch(self.coefficients, self.scales, angle, forces)
        self._refuse(angle, forces, out[:, 4])
        return States(angle, out[:, :2], forces, out[:, 2])

    def energies(self, states: States) -> FloatArray:
        """(n,) V [J] at the poses of ``states``."""
        poses = np.column_stack([states.tip, states.theta])
        return np.asarray(potential_kernel.wrench_batch(self.coefficients, self.scales, poses)[1])

    def _refuse(self, angle: FloatArray, force: FloatArray, guard: FloatArray) -> None:
        slack = 1 + 1e-9
        if (np.abs(angle) > slack * self.box.max_angle).any():
            raise FlexureError(f"theta = {np.degrees(np.abs(angle).max()):.4g} deg is outside the fitted "
                               f"+-{np.degrees(self.box.max_angle):.4g} deg; fit a larger box")  # fmt: skip
        outside = ~self.box.holds(force)
        if outside.any():
            x, y = force[int(np.flatnonzero(outside)[0])]
            raise FlexureError(
                f"the force ({x:.4g}, {y:.4g}) N is outside the fitted {self.box.told()}; fit a larger box"
            )
        if not (guard > 0).all():
            raise FlexureError("K - 2 g n <= 0: the joint buckles under this load")


def _table(value: ArrayLike, columns: int, name: str) -> FloatArray:
    array = np.ascontiguousarray(value, dtype=float)
    if array.ndim != 2 or array.shape[1] != columns:
        raise FlexureError(f"{name} has shape {array.shape}; give (n, {columns})")
    return array
