"""Coefficient: a fitted number, how well the data know it, and why not if they do not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray

NARROWED = 0.5
"""A coefficient is identified when the data leave less than this share of its expected size open."""


@dataclass(frozen=True)
class Coefficient:
    """One coefficient of a model fitted to data."""

    name: str
    value: float
    error: float
    """Standard error, in the unit of ``value``; at most the size it was expected to have."""
    doubt: str
    """Why the data cannot identify it; empty if they can."""


def judge(names: Sequence[str], values: FloatArray, sizes: FloatArray, slopes: FloatArray) -> tuple[Coefficient, ...]:
    """Every coefficient with its standard error and, if the data cannot identify it, the reason.

    The covariance is that of least squares with the expected sizes as a weak normal prior, so directions the data do
    not see stay finite.

    Args:
        names: (p) of the coefficients.
        values: (p,) what was fitted.
        sizes: (p,) how large each may be expected to be.
        slopes: (m, p) derivative of every residual, in units of its noise, over every coefficient, in units of its
            size.
    """
    covariance = np.linalg.inv(slopes.T @ slopes + np.eye(len(values)))
    error = np.sqrt(np.diag(covariance))
    tied = np.abs(covariance) / np.outer(error, error)
    np.fill_diagonal(tied, 0.0)
    alone = 1.0 / np.sqrt(1.0 + np.square(slopes).sum(axis=0))  # its error, were the others known
    out = []
    for k, name in enumerate(names):
        doubt = ""
        if alone[k] > NARROWED:
            doubt = "the states hardly depend on it, less than their noise"
        elif error[k] > NARROWED:
            doubt = f"the states cannot tell it from {names[int(tied[k].argmax())]}"
        out.append(Coefficient(name, float(values[k]), float(error[k] * sizes[k]), doubt))
    return tuple(out)
