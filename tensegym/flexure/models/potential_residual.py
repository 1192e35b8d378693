"""What a potential predicts at given (theta, force), and its derivatives over every coefficient. All dimensionless."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray

from .potential_kernel import NAMES, RHO, SA, SB, SIGMA, SK, SU, G, H


@dataclass(frozen=True)
class Data:
    """States in the joint's units and half-angle axes; every array (n,)."""

    u: FloatArray
    n: FloatArray
    q: FloatArray
    ex: FloatArray
    ey: FloatArray
    m: FloatArray
    theta0: float


def scaled(theta: FloatArray, tip: FloatArray, force: FloatArray, moment: FloatArray, scales: FloatArray) -> Data:
    """``Data`` from SI arrays; scales (L, M0, theta0)."""
    length, moment0, theta0 = scales
    c, s = np.cos(theta / 2), np.sin(theta / 2)
    f, p = force * length / moment0, tip / length
    return Data(theta / theta0, c * f[:, 0] + s * f[:, 1], c * f[:, 1] - s * f[:, 0], c * p[:, 0] + s * p[:, 1],
                c * p[:, 1] - s * p[:, 0], moment / moment0, float(theta0))  # fmt: skip


def powers(u: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """(n, degree + 1) powers of u and their derivatives."""
    value = u[:, None] ** np.arange(degree + 1)
    slope = np.zeros_like(value)
    slope[:, 1:] = value[:, :-1] * np.arange(1, degree + 1)
    return value, slope


def predict(coefficients: FloatArray, data: Data) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Predicted ex, ey, m (n,) and their Jacobian (3, n, 8, degree + 1); the equations of potential_kernel.pose."""
    f, f1 = powers(data.u, coefficients.shape[1] - 1)
    value, slope = f @ coefficients.T, f1 @ coefficients.T
    (su, sk, sa, sb, rho, sigma, h, g), (su1, sk1, sa1, sb1, rho1, sigma1, h1, g1) = value.T, slope.T
    u, n, q, t = data.u, data.n, data.q, data.theta0
    k, k1 = sk * sk, 2 * sk * sk1
    soft, soft1 = sa * sa + u * u * sb * sb, 2 * (sa * sa1 + u * sb * sb + u * u * sb * sb1)
    guard = k - 2 * g * n
    y = (q + n * h) / guard
    ey = sigma + y
    ex = 1 + rho + soft * n + (h + g * y) * y
    m = (u * su * (su + u * su1) - n * (rho1 + (h1 + g1 * y) * y) - 0.5 * soft1 * n * n + 0.5 * k1 * y * y
         - sigma1 * q) / t + 0.5 * (n * ey - q * ex)  # fmt: skip

    def rows(*terms: tuple[FloatArray, FloatArray]) -> FloatArray:
        return sum(a[:, None] * b for a, b in terms)  # type: ignore[return-value]

    zero = np.zeros_like(f)
    jacobian = np.zeros((3, len(u), len(NAMES), f.shape[1]))
    d_y = {SK: rows((-2 * sk * y / guard, f)), G: rows((2 * n * y / guard, f)), H: rows((n / guard, f))}
    for row in range(len(NAMES)):
        dy = d_y.get(row, zero)
        d_ey = dy + (f if row == SIGMA else zero)
        d_ex = rows((h + 2 * g * y, dy))
        inner = rows((-n * (h1 + 2 * g1 * y) + k1 * y, dy))
        if row == RHO:
            d_ex = d_ex + f
            inner = rows((-n, f1))
        elif row == SIGMA:
            inner = rows((-q, f1))
        elif row == H:
            d_ex = d_ex + rows((y, f))
            inner = inner + rows((-n * y, f1))
        elif row == G:
            d_ex = d_ex + rows((y * y, f))
            inner = inner + rows((-n * y * y, f1))
        elif row == SK:
            inner = inner + rows((y * y * sk1, f), (y * y * sk, f1))
        elif row == SA:
            d_ex = d_ex + rows((2 * sa * n, f))
            inner = rows((-n * n * sa1, f), (-n * n * sa, f1))
        elif row == SB:
            d_ex = d_ex + rows((2 * u * u * sb * n, f))
            inner = rows((-n * n * (2 * u * sb + u * u * sb1), f), (-n * n * u * u * sb, f1))
        elif row == SU:
            inner = rows((2 * u * su + u * u * su1, f), (u * u * su, f1))
        jacobian[0, :, row], jacobian[1, :, row] = d_ex, d_ey
        jacobian[2, :, row] = inner / t + 0.5 * (n[:, None] * d_ey - q[:, None] * d_ex)
    return ex, ey, m, jacobian
