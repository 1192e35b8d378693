"""MeasuredFit: any of the joint models fitted to an experiment, with residuals, noise and what the data cannot say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States
from tensegym.flexure.models.certificate import certify
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.model_error import model_errors
from tensegym.flexure.models.planar_spring import PlanarSpring, fit_planar
from tensegym.flexure.models.potential import Potential
from tensegym.flexure.models.potential_terms import mask_of
from tensegym.flexure.models.torsion_spring import TorsionSpring, fit_torsion

from .coefficient import Coefficient, judge
from .measured_file import ARM_LENGTH, read_measured
from .noisy_fit import box_of, fit_noisy, moment_scale_of

MODELS = ("potential", "planar", "torsion")

_Spring = PlanarSpring | TorsionSpring
_SPRINGS: dict[str, tuple[Callable[[States, float], _Spring], dict[str, str]]] = {
    # model: how it is fitted, and its coefficients: field -> name with the unit
    "planar": (fit_planar, {"b": "b", "kx": "kx_N_per_m", "ky": "ky_N_per_m", "kz": "kz_Nm_per_rad"}),
    "torsion": (fit_torsion, {"fraction": "lambda", "stiffness": "k_Nm_per_rad"}),
}


@dataclass(frozen=True)
class MeasuredFit:
    """A joint fitted to measured states."""

    model: str
    """Of MODELS."""
    joint: Joint
    states: States
    """The states with every component measured: those that were fitted."""
    coefficients: tuple[Coefficient, ...]
    """Dimensionless for the potential, else with the unit in the name."""
    noise: tuple[float, float] | None
    """Standard deviations of a coordinate of a tip [m] and of a moment [N m]: what the potential, the richest model,
    leaves over. None where the states are too few to fit one; a simpler model's residual holds its own error too."""

    @property
    def unidentified(self) -> tuple[Coefficient, ...]:
        return tuple(c for c in self.coefficients if c.doubt)


def fit_file(path: Path, length: float, model: str = "potential", *, arm_length: float = ARM_LENGTH,
             symmetry: str = "both") -> MeasuredFit:  # fmt: skip
    """Fit ``model`` to the CSV ``path`` (see measured.py) of a hinge of rest length L [m].

    Raises InputError for what the file lacks, FlexureError as ``fit_measured``, both naming the file.
    """
    states = read_measured(path, arm_length)
    try:
        return fit_measured(states, length, model, symmetry=symmetry, source=f"measured: {path.name}")
    except FlexureError as error:
        raise FlexureError(f"{path}: {error}") from None


def fit_measured(states: States, length: float, model: str = "potential", *, symmetry: str = "both",
                 source: str = "measured") -> MeasuredFit:  # fmt: skip
    """Fit ``model`` to measured states of a hinge of rest length L [m]; states not whole are passed over.

    symmetry: as ``fit_potential``. Raises FlexureError on an unknown model, fewer states than coefficients, states
    without rotation or load, a moment that turns against the angle, a potential that is not passive on the states' box.
    """
    if model not in MODELS:
        raise FlexureError(f"model = {model!r} cannot be fitted to data; one of {', '.join(MODELS)}")
    whole = states.whole()
    enough = len(whole) >= mask_of(symmetry).sum()
    rich = fit_noisy(whole, length, symmetry=symmetry) if enough or model == "potential" else None
    fitted: Potential | _Spring
    if rich is not None and model == "potential":
        certify(rich.potential)
        fitted, coefficients = rich.potential, rich.coefficients
    else:
        fitted, coefficients = _fit_spring(whole, length, model)
    errors = {model: model_errors(fitted, whole, moment_scale_of(whole, length))}
    notes = tuple(f"{c.name} is not identified: {c.doubt}" for c in coefficients if c.doubt)
    joint = Joint(
        source, length, box_of(whole, length), {model: fitted}, errors, "the fitted measured states", notes=notes
    )
    return MeasuredFit(model, joint, whole, coefficients, (rich.tip_noise, rich.moment_noise) if rich else None)


def _fit_spring(whole: States, length: float, model: str) -> tuple[_Spring, tuple[Coefficient, ...]]:
    fit, fields = _SPRINGS[model]
    if len(whole) < len(fields):
        raise FlexureError(
            f"{len(whole)} states with angle, tip and load for the {len(fields)} coefficients of {model}"
        )
    spring = fit(whole, length)
    values = np.array([getattr(spring, field) for field in fields])
    names = list(fields.values())
    return spring, judge(names, values, np.abs(values), _slopes(spring, list(fields), whole))


def _slopes(spring: _Spring, fields: list[str], whole: States) -> FloatArray:
    """(3n, p) derivative of tip and moment over every coefficient, in units of its value and of the residuals."""

    def answer(joint: _Spring) -> FloatArray:
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
