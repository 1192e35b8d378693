"""Certificate: proof that a potential is positive definite and free of buckling on its whole box.

Each condition is a polynomial of u = theta / max_angle that must be positive on [-1, 1]. A polynomial lies above the
smallest of its Bernstein coefficients, and halving the interval draws that bound up to the true minimum, so the bounds
below are proofs, not samples (Farouki, The Bernstein polynomial basis: a centennial retrospective, 2012).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial as poly
from scipy.special import comb

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

from .potential import Potential
from .potential_kernel import SA, SB, SK, SU, G

DEPTH = 12  # halvings of the interval


@dataclass(frozen=True)
class Certificate:
    """Lower bounds over the box, dimensionless; all are positive, or the certificate is not given."""

    transverse: float
    """Of K over its value at rest."""
    axial: float
    """Of the axial compliance C over its value at rest."""
    rotational: float
    """Of su over its value at rest: U = u^2 su^2 / 2 is zero at rest only."""
    buckling: float
    """Of (K - 2 g n) / K at rest, over every axial force n of the box."""


def lower_bound(coefficients: FloatArray, depth: int = DEPTH) -> float:
    """A proven lower bound of a polynomial on [-1, 1], sharp within about 1e-3 of its size.

    Args:
        coefficients: (degree + 1,) lowest power first.
        depth: times the interval is halved at most.
    """
    degree = len(coefficients) - 1
    shifted = np.zeros(degree + 1)  # over t in [0, 1], u = 2 t - 1
    for i, value in enumerate(coefficients):
        shifted[: i + 1] += value * poly.polypow([-1.0, 2.0], i)
    row, column = np.indices((degree + 1, degree + 1))
    bernstein = (comb(row, column) / comb(degree, column)) @ shifted  # comb is zero above the diagonal
    pieces = bernstein[None]
    for _ in range(depth):
        if pieces.min() >= min(pieces[:, 0].min(), pieces[:, -1].min()):
            break  # the bound is taken at an end of a piece: it is the minimum itself
        pieces = _halved(pieces)
    return float(pieces.min())


def _halved(pieces: FloatArray) -> FloatArray:
    """De Casteljau's split of every row at its middle."""
    left, right, level = [pieces[:, 0]], [pieces[:, -1]], pieces
    while level.shape[1] > 1:
        level = 0.5 * (level[:, 1:] + level[:, :-1])
        left.append(level[:, 0])
        right.append(level[:, -1])
    return np.concatenate([np.column_stack(left), np.column_stack(right[::-1])])


def certify(potential: Potential) -> Certificate:
    """Prove the potential on its box. Raises FlexureError that names the condition that fails."""
    rows = potential.coefficients
    stretch = potential.box.max_angle / potential.angle_scale
    rows = rows * stretch ** np.arange(rows.shape[1])  # powers of theta / max_angle
    axial = [force * potential.length / potential.moment_scale for force in potential.box.axial]
    k = poly.polymul(rows[SK], rows[SK])
    soft = poly.polyadd(poly.polymul(rows[SA], rows[SA]),
                        poly.polymul([0, 0, stretch**2], poly.polymul(rows[SB], rows[SB])))  # fmt: skip
    bounds = {
        "su": lower_bound(rows[SU] / rows[SU, 0]),
        "K": lower_bound(k / k[0]),
        "C": lower_bound(soft / soft[0]) if soft[0] > 0 else 0.0,
        "K - 2 g n": min(lower_bound(poly.polysub(k, 2 * force * rows[G]) / k[0]) for force in axial),
    }
    for name, bound in bounds.items():
        if not bound > 0:
            raise FlexureError(
                f"{name} is not positive on all of +-{np.degrees(potential.box.max_angle):.4g} deg, "
                f"{potential.box.told()} (bound {bound:.3g} of its value at rest): "
                "fit a smaller box or give more states"
            )
    return Certificate(bounds["K"], bounds["C"], bounds["su"], bounds["K - 2 g n"])


def rotation_stiffness(potential: Potential, theta: FloatArray, force: FloatArray) -> FloatArray:
    """dM/dtheta at constant force; a state with a negative one is unstable under its dead load.

    Args:
        potential: the joint.
        theta: (n,) [rad].
        force: (n, 2) at the tip in base axes [N].

    Returns:
        (n,) [N m/rad].
    """
    states = potential.poses(theta, force)
    k = potential.stiffnesses(np.column_stack([states.tip, states.theta]))
    given = np.einsum("ni,ni->n", k[:, 2, :2], np.linalg.solve(k[:, :2, :2], k[:, :2, 2:])[:, :, 0])
    return np.asarray(k[:, 2, 2] - given)
