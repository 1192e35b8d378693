"""StiffnessDiagram: the paper's kx, ky, kz against theta, inverted point by point from one load path, guarded.

    [A1 A2; A3 A4][kx; ky] = [Qx; Qy],  A1 = x c + y s/2, A2 = y s/2, A3 = -x s/2, A4 = y c - x s/2
    kz = (Qz - kx A5 - ky A6)/s,  A5 = +1/2 (x c + y s)(y c - x s),  A6 = -A5

with Q in the moving axes at the moving origin. det = c xi1 xi2, xi = R(theta/2)^T p: singular at rest, at 90 deg and
whenever the displacement lies on an axis of the half-angle frame; kz also at theta = 0. The diagrams belong to their
load path; they are no property of the hinge, can be negative, and k(theta) in the wrench makes energy on closed loops.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States
from tensegym.flexure.hinge.ranges import check_positive, finite_array, number_array

from .planar_spring import spring_poses, spring_wrench
from .pseudo_rigid import Placement, planar_placement, spring_track

GUARD = 1e-2  # smallest |xi1 xi2| / |xi|^2 and |sin theta| that are inverted


@dataclass(frozen=True)
class StiffnessDiagram:
    """kx, ky, kz at the angles where the inversion is not singular; in between linear, beyond them constant."""

    length: float
    b: float
    theta: FloatArray
    """(k,) increasing [rad]."""
    stiffness: FloatArray
    """(k, 3) kx, ky [N/m], kz [N m/rad]."""
    singular: FloatArray
    """Angles of the path left out [rad]."""

    def __post_init__(self) -> None:
        check_positive("length", self.length, "m")
        finite_array([self.b], "b", 1)
        count = len(np.atleast_1d(number_array(self.theta, "theta")))
        if count < 2 or not (np.diff(finite_array(self.theta, "theta", count)) > 0).all():
            raise FlexureError(f"theta has {count} angles; give 2 or more that rise")
        if number_array(self.stiffness, "stiffness").shape != (count, 3) or not np.isfinite(self.stiffness).all():
            raise FlexureError(f"stiffness does not hold kx, ky, kz at each of the {count} angles")

    def at(self, theta: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """kx, ky, kz (n,) at theta (n,)."""
        kx, ky, kz = (np.interp(theta, self.theta, k) for k in self.stiffness.T)
        return kx, ky, kz

    def poses(self, theta: FloatArray, force: FloatArray) -> States:
        """States at theta (n,) under the dead force (n, 2) at the tip; NaN where the spring has no stiffness."""
        return spring_poses(theta, force, self.length, self.b, *self.at(theta))

    def wrenches(self, poses: FloatArray) -> FloatArray:
        """(n, 3) force in base axes and moment about the tip that hold poses (n, 3) x, y, theta of the tip."""
        theta = poses[:, 2]
        c, s = np.cos(theta), np.sin(theta)
        arm = self.b * self.length
        x, y = poses[:, 0] - self.length + arm - arm * c, poses[:, 1] - arm * s
        f_x, f_y, m = spring_wrench(x, y, theta, *self.at(theta))
        force_x, force_y = c * f_x - s * f_y, s * f_x + c * f_y
        return np.column_stack([force_x, force_y, m - arm * (c * force_y - s * force_x)])


def invert(states: States, length: float, b: float) -> tuple[FloatArray, FloatArray]:
    """The stiffnesses along the states.

    Args:
        states: n of one load path.
        length: L [m].
        b: link from the spring to the tip, of L.

    Returns:
        (n, 3) kx, ky [N/m], kz [N m/rad], NaN where singular, and the (n,) guarded determinant |xi1 xi2| / |xi|^2.
    """
    theta = states.theta
    x, y = spring_track(states, length, b).T
    c, s = np.cos(theta), np.sin(theta)
    ch, sh = np.cos(theta / 2), np.sin(theta / 2)
    q_x = c * states.force[:, 0] + s * states.force[:, 1]
    q_y = c * states.force[:, 1] - s * states.force[:, 0]
    q_z = states.moment + b * length * q_y  # about the moving origin
    xi1, xi2 = ch * x + sh * y, ch * y - sh * x
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.abs(xi1 * xi2) / (xi1**2 + xi2**2)
        det = c * xi1 * xi2
        a1, a2, a3, a4 = x * c + y * s / 2, y * s / 2, -x * s / 2, y * c - x * s / 2
        kx, ky = (a4 * q_x - a2 * q_y) / det, (a1 * q_y - a3 * q_x) / det
        a5 = 0.5 * (x * c + y * s) * (y * c - x * s)
        kz = (q_z - (kx - ky) * a5) / s
    out = np.column_stack([kx, ky, kz])
    good = (share > GUARD) & (np.abs(s) > GUARD) & (c > GUARD) & np.isfinite(out).all(1)
    out[~good] = np.nan
    return out, np.where(np.isfinite(share), share, 0.0)


def fit_diagram(states: States, length: float, placement: Placement | None = None) -> StiffnessDiagram:
    """The diagrams of one load path.

    Args:
        states: of the path; those that are not whole are passed over.
        length: L [m].
        placement: of the spring; default: as the paper's Table 1 has it (reading "dx").

    Raises:
        FlexureError: where the inversion is singular along the whole path.
    """
    states = states.whole()
    b = (placement or planar_placement(states, length)).b
    stiffness, _ = invert(states, length, b)
    order = np.argsort(states.theta)
    good = order[np.isfinite(stiffness[order]).all(1)]
    if len(good) < 2:
        raise FlexureError("the inversion is singular along the whole path (a symmetric hinge under a pure moment with "
                           "a = b, or no force): apply a force at the arm's end")  # fmt: skip
    rest = order[~np.isfinite(stiffness[order]).all(1)]
    return StiffnessDiagram(length, b, states.theta[good], stiffness[good], states.theta[rest])
