"""Where a potential's fit starts: three linear least-squares problems, each with one minimum."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray

from .potential_kernel import RHO, SA, SB, SIGMA, SK, SU, G, H
from .potential_residual import Data, powers, predict


def linear_start(data: Data, mask: NDArray[np.bool_]) -> FloatArray:
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


def _doubled(row: NDArray[np.bool_], extra: int = 0) -> NDArray[np.bool_]:
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
