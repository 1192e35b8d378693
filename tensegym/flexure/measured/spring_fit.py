"""The paper's springs fitted to measured states, every coefficient judged; the torsion spring also without a tip."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States
from tensegym.flexure.models.planar_spring import PlanarSpring, fit_planar
from tensegym.flexure.models.torsion_spring import TorsionSpring, fit_torsion

from .coefficient import Coefficient, judge

Spring = PlanarSpring | TorsionSpring
SPRINGS: dict[str, tuple[Callable[[States, float], Spring], dict[str, str]]] = {
    # model: how it is fitted, and its coefficients: field -> name with the unit
    "planar": (fit_planar, {"b": "b", "kx": "kx_N_per_m", "ky": "ky_N_per_m", "kz": "kz_Nm_per_rad"}),
    "torsion": (fit_torsion, {"fraction": "lambda", "stiffness": "k_Nm_per_rad"}),
}
MIDDLE = 0.5
"""lambda where no tip was measured: a moment turns a hinge that is symmetric end to end about its middle."""


def fit_spring(whole: States, length: float, model: str) -> tuple[Spring, tuple[Coefficient, ...]]:
    """Fit a spring to whole states.

    Args:
        whole: states with angle, tip and load.
        length: L [m].
        model: of SPRINGS.

    Raises:
        FlexureError: for fewer states than coefficients, and as the model's own fit.
    """
    fit, fields = SPRINGS[model]
    if len(whole) < len(fields):
        raise FlexureError(
            f"{len(whole)} states with angle, tip and load for the {len(fields)} coefficients of {model}"
        )
    spring = fit(whole, length)
    values = np.array([getattr(spring, field) for field in fields])
    return spring, judge(list(fields.values()), values, np.abs(values), _slopes(spring, list(fields), whole))


def fit_turning(states: States, length: float) -> tuple[TorsionSpring, tuple[Coefficient, ...]]:
    """Fit the torsion spring to angles and moments alone; where the pin stands remains unknown.

    Args:
        states: with angle, force and moment; tips are not looked at.
        length: L [m].

    Raises:
        FlexureError: for fewer than 2 states, no rotation, or a moment that turns against the angle.
    """
    if len(states) < 2 or not np.ptp(states.theta) > 0:
        raise FlexureError(f"{len(states)} states with angle and moment; the torsion spring needs 2 that differ")
    theta = states.theta
    across = np.cos(theta) * states.force[:, 1] - np.sin(theta) * states.force[:, 0]
    about_pin = states.moment + MIDDLE * length * across
    size = float(theta @ theta)
    stiffness = float(theta @ about_pin) / size
    spring = TorsionSpring(length, MIDDLE, stiffness)
    scatter = about_pin - stiffness * theta
    error = float(np.sqrt(scatter @ scatter / (len(theta) - 1) / size))
    lever = MIDDLE * length * abs(float(theta @ across)) / size  # the pin anywhere between base and tip
    doubt = "it depends on where the pin stands: measure the tip, or turn by a pure moment" if lever > error else ""
    return spring, (
        Coefficient("lambda", MIDDLE, MIDDLE, "no tip (x, y) was measured: the hinge's middle is taken"),
        Coefficient("k_Nm_per_rad", stiffness, max(error, lever), doubt),
    )


def _slopes(spring: Spring, fields: list[str], whole: States) -> FloatArray:
    """(3n, p) derivative of tip and moment over every coefficient, in units of its value and of the residuals."""

    def answer(joint: Spring) -> FloatArray:
        got = joint.poses(whole.theta, whole.force)
        return np.column_stack([got.tip, got.moment])

    miss = answer(spring) - np.column_stack([whole.tip, whole.moment])
    used = 1.0 - len(fields) / (3.0 * len(whole))
    tip, moment = np.sqrt(np.mean(miss[:, :2] ** 2) / used), np.sqrt(np.mean(miss[:, 2] ** 2) / used)
    spread = np.maximum([tip, tip, moment], 1e-12)
    columns = []
    for field in fields:
        value, step = getattr(spring, field), 1e-4
        more, less = (answer(replace(spring, **{field: value * (1.0 + sign * step)})) for sign in (1.0, -1.0))
        columns.append(((more - less) / (2.0 * step * spread)).ravel())
    return np.stack(columns, axis=1)
