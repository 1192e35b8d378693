"""Fit a potential to noisy states: weighed by the noise, held where the data say nothing, and every coefficient judged.

The noise of tip and moment is estimated from the residuals and decides their weights (maximum likelihood, repeated).
Each coefficient also has a size it may be expected to have, a weak normal prior: what noisy data leave open, such as
the axial softness of a stiff hinge, then stays near it instead of running off to where K - 2 g n vanishes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box, States
from tensegym.flexure.models.potential import Potential
from tensegym.flexure.models.potential_kernel import NAMES, SK, G
from tensegym.flexure.models.potential_residual import Data, powers, predict, scaled
from tensegym.flexure.models.potential_terms import mask_of

from .coefficient import Coefficient, judge
from .noisy_prior import Prior, noisy_start

_REFUSED = 1e12


@dataclass(frozen=True)
class NoisyFit:
    """A potential from noisy data and what the data know of it."""

    potential: Potential
    tip_noise: float
    """Standard deviation of one coordinate of a tip about the fit [m]."""
    moment_noise: float
    """Standard deviation of a moment about the fit [N m]."""
    coefficients: tuple[Coefficient, ...]


def fit_noisy(states: States, length: float, *, box: Box | None = None, symmetry: str = "both") -> NoisyFit:
    """Fit a potential to measured states of a hinge.

    Args:
        states: those that are not whole are passed over.
        length: rest length L [m].
        box: where it is to be valid; default: the states' own.
        symmetry: both, axis or none; see ``symmetry_of``.

    Raises:
        FlexureError: on fewer states than coefficients, on states that do not turn, or that resist turning the wrong
            way.
    """
    states, mask = states.whole(), mask_of(symmetry)
    if len(states) < mask.sum():
        raise FlexureError(f"{len(states)} states with angle, tip and load for a potential of {mask.sum()} "
                           "coefficients; give as many states, or fit planar or torsion")  # fmt: skip
    box, moment_scale = box or box_of(states, length), moment_scale_of(states, length)
    scales = np.array([length, moment_scale, box.max_angle])
    data = scaled(states.theta, states.tip, states.force, states.moment, scales)
    prior = noisy_start(data, mask)
    rows, tip_noise, moment_noise = prior.mean, *_noise(prior.mean, data, 0)
    for _ in range(4):
        rows, slopes = _descend(rows, prior, mask, data, tip_noise, moment_noise)
        tip_noise, moment_noise = _noise(rows, data, int(mask.sum()))
    potential = Potential(rows, length, moment_scale, box.max_angle, box)
    names = [f"{NAMES[row]}[{power}]" for row, power in np.argwhere(mask)]
    coefficients = judge(names, rows[mask], prior.size[mask], slopes)
    return NoisyFit(potential, tip_noise * length, moment_noise * moment_scale, coefficients)


def moment_scale_of(states: States, length: float) -> float:
    """Largest moment, or moment of a force over L, that acts in ``states`` [N m]."""
    return max(float(np.abs(states.moment).max()), float(np.abs(states.force).max()) * length)


def box_of(states: States, length: float) -> Box:
    """The box that ``states`` span; without forces, forces up to the largest moment over L.

    Raises FlexureError if nothing turns or nothing loads.
    """
    angle, scale = float(np.abs(states.theta).max()), moment_scale_of(states, length)
    if not (angle > 0.0 and scale > 0.0):
        raise FlexureError("the states have no rotation or no load: nothing to fit; load the hinge")
    return Box(angle, float(np.abs(states.force).max()) or scale / length)


def _descend(first: FloatArray, prior: Prior, mask: NDArray[np.bool_], data: Data, tip_noise: float,
             moment_noise: float) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Most likely coefficients (8, degree + 1), and the Jacobian (3n, p) in units of noise over expected size."""
    centre, size = prior.mean[mask], prior.size[mask]
    f, _ = powers(data.u, mask.shape[1] - 1)
    weights = 1.0 / np.array([tip_noise, tip_noise, moment_noise])

    def unpack(z: FloatArray) -> FloatArray:
        rows = np.zeros(mask.shape)
        rows[mask] = centre + size * z
        return rows

    def residual(z: FloatArray) -> FloatArray:
        rows = unpack(z)
        if not (np.square(f @ rows[SK]) > 2.0 * (f @ rows[G]) * data.n).all():  # past buckling: refuse the step
            return np.full(3 * len(data.u) + len(z), _REFUSED)
        ex, ey, m, _ = predict(rows, data)
        misses = weights[:, None] * np.array([ex - data.ex, ey - data.ey, m - data.m])
        return np.concatenate([misses.ravel(), z])

    def seen(z: FloatArray) -> FloatArray:
        parts = predict(unpack(z), data)[3][:, :, mask] * size * weights[:, None, None]
        return np.asarray(parts.reshape(-1, len(z)))

    result = least_squares(residual, (first[mask] - centre) / size, jac=lambda z: np.vstack([seen(z), np.eye(len(z))]),
                           method="lm", xtol=1e-10, ftol=1e-10, gtol=1e-10, max_nfev=200)  # fmt: skip
    return unpack(result.x), seen(result.x)


def _noise(rows: FloatArray, data: Data, used: int) -> tuple[float, float]:
    """Standard deviations of ex, ey together and of m about the prediction, ``used`` coefficients allowed for."""
    ex, ey, m, _ = predict(rows, data)
    n = len(data.u)
    share = 3 * n / max(3 * n - used, 1)
    tip = np.sqrt(share * np.mean(np.square([ex - data.ex, ey - data.ey])))
    moment = np.sqrt(share * np.mean(np.square(m - data.m)))
    return max(float(tip), 1e-9), max(float(moment), 1e-9)  # exact data: no weight may be infinite
