"""Fit a potential to states by least squares: a linear start, then Gauss and Newton with the analytic Jacobian.

Given (theta, force) the model's tip and moment are explicit, so no state is solved for. The start is linear in three
steps (transverse, axial, rotational), each a plain least-squares problem with one minimum, so no luck is involved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from tensegym.errors import FlexureError
from tensegym.flexure.fem.sampling import Box
from tensegym.flexure.hinge.states import FloatArray, States

from .potential import Potential
from .potential_kernel import NAMES, RHO, SA, SB, SIGMA, SK, SU, G, H
from .potential_residual import Data, powers, predict, scaled

# powers of u of every row; a hinge symmetric about its axis and end to end needs the even ones only
EVEN = {SU: (0, 2, 4), SK: (0, 2, 4), SA: (0, 2), SB: (0, 2, 4), RHO: (2, 4, 6), SIGMA: (), H: (), G: (0, 2, 4)}
# symmetric about its axis only: theta and e_y change sign together
MIRROR = EVEN | {SIGMA: (1, 3, 5), H: (1, 3)}
# no symmetry
FREE = {SU: tuple(range(5)), SK: tuple(range(5)), SA: tuple(range(3)), SB: tuple(range(5)), RHO: tuple(range(1, 7)),
        SIGMA: tuple(range(1, 6)), H: tuple(range(4)), G: tuple(range(5))}  # fmt: skip
SYMMETRIES = {"both": EVEN, "axis": MIRROR, "none": FREE}
DEGREE = 6
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


def mask_of(symmetry: str) -> np.ndarray:
    """(8, DEGREE + 1) which coefficients are fitted. Raises FlexureError."""
    if symmetry not in SYMMETRIES:
        raise FlexureError(f"symmetry = {symmetry!r}; one of {', '.join(SYMMETRIES)}")
    mask = np.zeros((len(NAMES), DEGREE + 1), dtype=bool)
    for row, exponents in SYMMETRIES[symmetry].items():
        mask[row, list(exponents)] = True
    return mask


def fit_potential(states: States, length: float, *, box: Box | None = None, symmetry: str = "both",
                  start: FloatArray | None = None, start_noise: float = 0.0, seed: int = 0) -> Fit:  # fmt: skip
    """Fit a potential to ``states`` of a hinge of rest length L [m].

    box: where it is to be valid; default: the states' own. symmetry: both (about the axis and end to end), axis, none.
    start: coefficients to start from besides the linear start, the better end counts; start_noise: relative noise
    drawn on the start with ``seed``, to show that the end does not hang on it. Raises FlexureError on too few states or
    a box of no extent.
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


def _descend(first: FloatArray, mask: np.ndarray, data: Data) -> tuple[float, FloatArray, FloatArray]:
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


def linear_start(data: Data, mask: np.ndarray) -> FloatArray:
    """Coefficients (8, DEGREE + 1) from linear least squares alone."""
    f, f1 = powers(data.u, mask.shape[1] - 1)
    # transverse: (Y - sigma)(K - 2 g n) = q + n h is linear in K, K sigma, g and h - 2 g sigma
    squared = _doubled(mask[SK])
    tau = mask[SIGMA]
    crossed = mask[H] | (mask[SIGMA] & mask[H].any())
    n_, ey_ = data.n[:, None], data.ey[:, None]
    blocks = [ey_ * f[:, squared], -f[:, tau], -2 * n_ * ey_ * f[:, mask[G]], -n_ * f[:, crossed]]
    k, t, g, hh = _linear(data.q, blocks)
    k_u, g_u = np.maximum(f[:, squared] @ k, 1e-9), f[:, mask[G]] @ g
    sigma_u = f[:, tau] @ t / k_u
    h_u = f[:, crossed] @ hh + 2 * g_u * sigma_u
    out = np.zeros(mask.shape)
    out[G, mask[G]] = g
    for row, values in ((SK, np.sqrt(k_u)), (SIGMA, sigma_u), (H, h_u)):
        if mask[row].any():
            (out[row, mask[row]],) = _linear(values, [f[:, mask[row]]])
    for _ in range(60):  # data that bend the wrong way near buckling: start from a joint that is stable on them
        h_u, g_u = f @ out[H], f @ out[G]
        if (np.square(f @ out[SK]) > 2.2 * g_u * data.n).all():
            break
        out[G] *= 0.7
    # axial: e_x - 1 - h Y - g Y^2 = rho + C n
    y = (data.q + data.n * h_u) / (np.square(f @ out[SK]) - 2 * g_u * data.n)
    squared = _doubled(mask[SA]) | _doubled(mask[SB], 2)
    rho, soft = _linear(data.ex - 1 - (h_u + g_u * y) * y, [f[:, mask[RHO]], data.n[:, None] * f[:, squared]])
    out[RHO, mask[RHO]] = rho
    soft_u = f[:, squared] @ soft
    at_rest = max(float(soft[0]), 1e-3 * float(np.abs(soft_u).max()), 1e-12)
    out[SA, 0] = np.sqrt(at_rest)
    away = np.abs(data.u) > 0.05
    rise = np.sqrt(np.maximum(soft_u[away] - at_rest, 0.0) / data.u[away] ** 2)
    (out[SB, mask[SB]],) = _linear(rise, [f[away][:, mask[SB]]])
    # rotational: what is left of the moment is U' / theta0, linear in the coefficients of U = u^2 P(u) / 2
    out[SU] = 0.0
    _, _, m, _ = predict(out, data)
    squared = _doubled(mask[SU])
    lever = data.u[:, None] * f[:, squared] + 0.5 * data.u[:, None] ** 2 * f1[:, squared]
    (p,) = _linear((data.m - m) * data.theta0, [lever])
    (out[SU, mask[SU]],) = _linear(np.sqrt(np.maximum(f[:, squared] @ p, 1e-9)), [f[:, mask[SU]]])
    return out


def _doubled(row: np.ndarray, extra: int = 0) -> np.ndarray:
    """Exponents of the square of a polynomial with these exponents, times u^extra, cut to the degree at hand."""
    out = np.zeros_like(row)
    exponents = np.flatnonzero(row)
    for a in exponents:
        for b in exponents:
            if a + b + extra < len(row):
                out[a + b + extra] = True
    return out


def _linear(target: FloatArray, blocks: list[FloatArray]) -> list[FloatArray]:
    """Least squares over column blocks; coefficients block by block. Columns are scaled, blind directions stay 0."""
    matrix = np.concatenate(blocks, axis=1)
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0] = 1.0
    solution = np.linalg.lstsq(matrix / size, target, rcond=1e-9)[0] / size
    return np.split(solution, np.cumsum([b.shape[1] for b in blocks])[:-1])


def _unidentified(jacobian: FloatArray, mask: np.ndarray) -> tuple[str, ...]:
    """Coefficients that stand out in directions of coefficient space the data do not see."""
    size = np.linalg.norm(jacobian, axis=0)
    dead = size < 1e-9 * size.max()
    size[dead] = 1.0
    _, singular, directions = np.linalg.svd(jacobian / size, full_matrices=False)
    weak = directions[singular < 1e-7 * singular[0]]
    blind = dead | (np.abs(weak) > 0.3).any(0)
    rows, exponents = np.nonzero(mask)
    return tuple(f"{NAMES[r]}[{e}]" for r, e, b in zip(rows, exponents, blind, strict=True) if b)
