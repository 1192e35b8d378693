"""Fit a potential to states by least squares: a linear start, then Gauss and Newton with the analytic Jacobian.

Given (theta, force) the model's tip and moment are explicit, so no state is solved for. The start is linear in three
steps (transverse, axial, rotational), each a plain least-squares problem with one minimum, so no luck is involved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box, States

from .potential import Potential
from .potential_kernel import NAMES, SA, SK, SU, G
from .potential_residual import Data, powers, predict, scaled
from .potential_start import linear_start
from .potential_terms import mask_of

# A tip error of 1e-3 L costs as much as 1e-2 of the moment scale: 40 um beside 1 % at L = 40 mm, the ratio of the
# accuracies asked of the fit (5 um, 0.05 %) and of a stand (0.05 mm, 0.5 %).
TIP_UNIT, MOMENT_UNIT = 1e-3, 8e-3
_REFUSED = 1e12


@dataclass(frozen=True)
class Fit:
    """A fitted potential and how well it is known."""

    potential: Potential
    tip_rms: float
    """[m], over the fitted states."""
    moment_rms: float
    """[N m]."""
    unidentified: tuple[str, ...]
    """Coefficients the data cannot tell, such as "sb[2]"; they keep their smallest value."""
    symmetry: str
    count: int
    """States fitted."""


def fit_potential(
    states: States, length: float, *, box: Box | None = None, symmetry: str = "both",
    start: FloatArray | None = None, start_noise: float = 0.0, seed: int = 0,
) -> Fit:  # fmt: skip
    """Fit a potential to states of a hinge.

    Args:
        states: those that are not whole are passed over.
        length: rest length L [m].
        box: where it is to be valid; default: the states' own.
        symmetry: both (about the axis and end to end), axis, none; see ``symmetry_of``.
        start: (8, DEGREE + 1) coefficients to start from besides the linear start; the better end counts.
        start_noise: relative noise drawn on the start with ``seed``, to show that the end does not hang on it.

    Raises:
        FlexureError: on too few states, a box of no extent, or states past buckling.
    """
    states = states.whole()
    mask = mask_of(symmetry)
    if 3 * len(states) <= mask.sum():
        raise FlexureError(f"{len(states)} states give {3 * len(states)} numbers for {mask.sum()} coefficients; "
                           f"give {mask.sum() // 3 + 1} states or more")  # fmt: skip
    if box is None:
        if not np.abs(states.theta).max() > 0 or not np.abs(states.force).max() > 0:
            raise FlexureError("the states have no rotation or no force at the tip: nothing to fit; load the hinge")
        box = Box(float(np.abs(states.theta).max()), float(np.abs(states.force).max()))
    moment_scale = float(np.abs(states.moment).max())
    if not moment_scale > 0:
        raise FlexureError("every moment is zero: nothing to fit; load the hinge")
    scales = np.array([length, moment_scale, box.max_angle])
    data = scaled(states.theta, states.tip, states.force, states.moment, scales)
    linear = linear_start(data, mask)
    first = linear if start is None else np.where(mask, start, 0.0)
    if start_noise:
        first = first * (1 + start_noise * np.random.default_rng(seed).uniform(-1, 1, first.shape))
    ends = [_descend(begin, mask, data) for begin in ([linear] if first is linear else [first, linear])]
    cost, coefficients, slopes = min(ends, key=lambda end: end[0])
    if not cost < _REFUSED:
        raise FlexureError("the states hold no stable joint (K - 2 g n <= 0 at some): drop those past buckling")
    ex, ey, m, _ = predict(coefficients, data)
    tip_rms = length * float(np.sqrt(np.mean((ex - data.ex) ** 2 + (ey - data.ey) ** 2)))
    moment_rms = moment_scale * float(np.sqrt(np.mean((m - data.m) ** 2)))
    potential = Potential(coefficients, length, moment_scale, box.max_angle, box)
    return Fit(potential, tip_rms, moment_rms, _unidentified(slopes, mask), symmetry, len(states))


def _descend(first: FloatArray, mask: NDArray[np.bool_], data: Data) -> tuple[float, FloatArray, FloatArray]:
    """Levenberg and Marquardt from ``first``: cost, coefficients (8, degree + 1), Jacobian (3n, fitted)."""

    def unpack(vector: FloatArray) -> FloatArray:
        coefficients = np.zeros(mask.shape)
        coefficients[mask] = vector
        return coefficients

    f, _ = powers(data.u, mask.shape[1] - 1)

    def residual(vector: FloatArray) -> FloatArray:
        rows = unpack(vector)
        if not (np.square(f @ rows[SK]) > 2 * (f @ rows[G]) * data.n).all():  # past buckling: refuse the step
            return np.full(3 * len(data.u), _REFUSED)
        ex, ey, m, _ = predict(rows, data)
        return np.concatenate([(ex - data.ex) / TIP_UNIT, (ey - data.ey) / TIP_UNIT, (m - data.m) / MOMENT_UNIT])

    def jacobian(vector: FloatArray) -> FloatArray:
        parts = predict(unpack(vector), data)[3][:, :, mask]
        return np.concatenate([parts[0] / TIP_UNIT, parts[1] / TIP_UNIT, parts[2] / MOMENT_UNIT])

    result = least_squares(residual, first[mask], jac=jacobian, method="lm", x_scale="jac", xtol=1e-12, ftol=1e-12,
                           gtol=1e-12, max_nfev=100)  # fmt: skip
    coefficients = unpack(result.x)
    for row in (SU, SK, SA):  # only the squares count: choose the positive root
        if coefficients[row, 0] < 0:
            coefficients[row] *= -1
    return float(result.cost), coefficients, jacobian(coefficients[mask])


def _unidentified(jacobian: FloatArray, mask: NDArray[np.bool_]) -> tuple[str, ...]:
    """Coefficients that stand out in directions of coefficient space the data do not see."""
    size = np.linalg.norm(jacobian, axis=0)
    dead = size < 1e-9 * size.max()
    size[dead] = 1.0
    _, singular, directions = np.linalg.svd(jacobian / size, full_matrices=False)
    weak = directions[singular < 1e-7 * singular[0]]
    blind = dead | (np.abs(weak) > 0.3).any(0)
    rows, exponents = np.nonzero(mask)
    return tuple(f"{NAMES[r]}[{e}]" for r, e, b in zip(rows, exponents, blind, strict=True) if b)
