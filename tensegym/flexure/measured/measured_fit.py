"""MeasuredFit: any of the joint models fitted to an experiment, with residuals, noise and what the data cannot say."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States
from tensegym.flexure.models.certificate import certify
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.model_error import model_errors
from tensegym.flexure.models.potential import Potential
from tensegym.flexure.models.potential_terms import mask_of

from .coefficient import Coefficient
from .measured_file import ARM_LENGTH, read_measured
from .noisy_fit import box_of, fit_noisy, moment_scale_of
from .plausibility import check_measured
from .spring_fit import Spring, fit_spring, fit_turning

MODELS = ("potential", "planar", "torsion")


@dataclass(frozen=True)
class MeasuredFit:
    """A joint fitted to measured states."""

    model: str
    """Of MODELS."""
    joint: Joint
    states: States
    """Those that were fitted: with every component measured, or without any tip."""
    coefficients: tuple[Coefficient, ...]
    """Dimensionless for the potential, else with the unit in the name."""
    noise: tuple[float, float] | None
    """Standard deviations of a coordinate of a tip [m] and of a moment [N m]: what the potential, the richest model,
    leaves over. None where the states are too few to fit one; a simpler model's residual holds its own error too."""

    @property
    def unidentified(self) -> tuple[Coefficient, ...]:
        return tuple(c for c in self.coefficients if c.doubt)


def fit_file(
    path: Path, length: float, model: str = "potential", *, arm_length: float = ARM_LENGTH, symmetry: str = "both"
) -> MeasuredFit:
    """Fit a model to a CSV of measured states; see measured_file.py.

    Args:
        path: of the CSV.
        length: rest length L of the hinge [m].
        model: of MODELS.
        arm_length: of the stand, from the tip to where the force acts [m].
        symmetry: both, axis or none; see ``symmetry_of``.

    Raises:
        InputError: for what the file lacks.
        FlexureError: as ``fit_measured``, naming the file.
    """
    states = read_measured(path, arm_length)
    try:
        return fit_measured(states, length, model, symmetry=symmetry, source=f"measured: {path.name}")
    except FlexureError as error:
        raise FlexureError(f"{path}: {error}") from None


def fit_measured(
    states: States, length: float, model: str = "potential", *, symmetry: str = "both", source: str = "measured"
) -> MeasuredFit:
    """Fit a model to measured states; the torsion spring also where no tip was measured.

    Args:
        states: those that are not whole are passed over, but for a torsion spring without tips.
        length: rest length L of the hinge [m].
        model: of MODELS.
        symmetry: both, axis or none; see ``symmetry_of``.
        source: says in the joint what was fitted.

    Raises:
        FlexureError: on an unknown model, states that this hinge cannot have (plausibility.py), fewer states than
            coefficients, states without rotation or load, a potential that is not passive on the states' box.
    """
    if str(model) not in MODELS:
        raise FlexureError(f"model = {model!r} cannot be fitted to data; one of {', '.join(MODELS)}")
    check_measured(states, length)
    used, rich = states.whole(), None
    fitted: Potential | Spring
    if not np.isfinite(states.tip).any():
        if model != "torsion":
            raise FlexureError("no tip (x, y) was measured: angles and loads alone give the torsion model; fit torsion")
        used = states.pick(np.isfinite(states.force).all(1) & np.isfinite(states.moment))
        fitted, coefficients = fit_turning(used, length)
    else:
        if len(used) >= mask_of(symmetry).sum() or model == "potential":
            rich = fit_noisy(used, length, symmetry=symmetry)
        if rich is not None and model == "potential":
            certify(rich.potential)
            fitted, coefficients = rich.potential, rich.coefficients
        else:
            fitted, coefficients = fit_spring(used, length, model)
    errors = {model: model_errors(fitted, used, moment_scale_of(used, length))}
    notes = tuple(f"{c.name} is not identified: {c.doubt}" for c in coefficients if c.doubt)
    joint = Joint(
        source, length, box_of(used, length), {model: fitted}, errors, "the fitted measured states", notes=notes
    )
    return MeasuredFit(model, joint, used, coefficients, (rich.tip_noise, rich.moment_noise) if rich else None)
