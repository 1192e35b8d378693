"""Where a fit to noisy states starts, and how large each coefficient may be expected to be.

Angles and forces are taken as exact, tips and moments as noisy, so every step regresses the noisy on the exact: a stiff
hinge's deflection under the noise then gives an uncertain stiffness, not a soft one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.models.potential_kernel import RHO, SA, SB, SIGMA, SK, SU, G, H
from tensegym.flexure.models.potential_residual import Data, powers

# Expected size of a polynomial's further coefficients in units of its first. Converged fits of the paper's four hinges
# stay within .02 (su), 1.2 (sk), 2.7 (sa) and .1 (sb), within .05 for rho and within .07 K for g.
_FURTHER = {SU: 0.3, SK: 1.5, SA: 2.0, SB: 0.5}
_PATH = 0.1  # rho, sigma, h: parts of L
_BOW = 0.1  # g: parts of K
_SLENDER = 0.1  # leaves give along themselves less than this part of how they give across; .02 at most in those fits


@dataclass(frozen=True)
class Prior:
    """Expected coefficients: mean and standard deviation, both (8, degree + 1)."""

    mean: FloatArray
    size: FloatArray


def noisy_start(data: Data, mask: NDArray[np.bool_]) -> Prior:
    """The expected coefficients of the joint behind noisy data.

    Args:
        data: the states in the joint's units.
        mask: (8, degree + 1) which coefficients are fitted.

    Raises:
        FlexureError: if the moment turns against the angle.
    """
    u, f = data.u, powers(data.u, mask.shape[1] - 1)[0]
    energy_slope = data.m - 0.5 * (data.n * data.ey - data.q * data.ex)
    turning = data.theta0 * float(u @ energy_slope) / float(u @ u)
    if not turning > 0.0:
        raise FlexureError("the moment turns against the angle: the sign of the load or of the angle is wrong")
    leaf = 12.0 * turning / data.theta0**2  # K of one uniform leaf of this turning stiffness, in M0 / L^2
    load = data.q[:, None] * np.stack([np.ones_like(u), u**2, u**4, data.n], axis=1)
    (across,) = _softness(data.ey, [load, f[:, mask[SIGMA]], data.n[:, None] * f[:, mask[H]]], 1, 1.0 / leaf)
    load = data.n[:, None] * np.stack([np.ones_like(u), u**2], axis=1)
    along = _softness(data.ex - 1.0, [load, f[:, mask[RHO]], np.square(data.q)[:, None]], 2, 0.0)
    most = _SLENDER * max(float(across), 1.0 / leaf)
    along = np.clip(along, 0.01 * most, most)
    mean, size = np.zeros(mask.shape), np.zeros(mask.shape)
    mean[[SU, SK, SA, SB], 0] = np.sqrt([turning, 1.0 / across, *along])
    for row, share in _FURTHER.items():
        size[row] = share * mean[row, 0]
        size[row, 0] = mean[row, 0]
    size[[RHO, SIGMA, H]] = _PATH
    size[G] = _BOW / across
    return Prior(mean, size)


def _softness(target: FloatArray, blocks: list[FloatArray], count: int, unknown: float) -> FloatArray:
    """The first ``count`` coefficients of a regression, each at least its error; ``unknown`` where nothing acts."""
    matrix = np.concatenate(blocks, axis=1)
    size = np.linalg.norm(matrix, axis=0)
    acts = size > 1e-9 * max(float(size.max()), 1.0)
    columns = matrix[:, acts] / size[acts]
    solution = np.linalg.lstsq(columns, target, rcond=1e-6)[0]
    noise = float(np.linalg.norm(target - columns @ solution)) / np.sqrt(max(len(target) - columns.shape[1], 1))
    errors = noise * np.sqrt(np.diag(np.linalg.pinv(columns.T @ columns, rcond=1e-12)))
    out = np.full(len(size), unknown)
    out[acts] = np.maximum(np.maximum(solution, errors), 1e-9) / size[acts]
    return out[:count]
