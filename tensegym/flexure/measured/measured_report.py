"""What a fit to measured data has to say: residuals, noise, what the data cover and what they cannot identify."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.errors import InputError
from tensegym.flexure.hinge import Hinge, symmetry_of
from tensegym.flexure.models.joint_file import joint_to_dict, save_joint
from tensegym.report import Report, table

from .measured_file import ARM_LENGTH
from .measured_fit import MeasuredFit, fit_file
from .plausibility import load_note


def fit_data(
    data: Path, out: Path, length: float, model: str = "potential", *, arm_length: float = ARM_LENGTH,
    hinge: Hinge | None = None,
) -> Report:  # fmt: skip
    """`tensegym flexure fit --data`: fit a model to a CSV, save the joint and report.

    Args:
        data: the CSV.
        out: the joint file to write.
        length: rest length L of the hinge [m].
        model: as ``fit_file``.
        arm_length: the arm beyond the tip [m].
        hinge: gives the symmetry, and the loads that are to be expected; without it both ends and sides are alike.

    Raises:
        InputError, FlexureError: as ``fit_file``, before anything is written.
    """
    if not (0.0 < length < np.inf and 0.0 <= arm_length < np.inf):
        raise InputError(f"length {length:g} m, arm {arm_length:g} m: give a length above 0 and an arm of 0 or more")
    fit = fit_file(data, length, model, arm_length=arm_length, symmetry=symmetry_of(hinge) if hinge else "both")
    note = load_note(fit.states, hinge) if hinge else ""
    if note:
        fit = replace(fit, joint=replace(fit.joint, notes=(*fit.joint.notes, note)))
    save_joint(fit.joint, out)
    return Report(_text(fit, out) + (f"\n\nnote: {note}" if note else ""), _facts(fit, out))


def _facts(fit: MeasuredFit, out: Path) -> dict[str, Any]:
    error, states = fit.joint.errors[fit.model], fit.states
    spans = {"theta_rad": states.theta, "Fx_N": states.force[:, 0], "Fy_N": states.force[:, 1], "Mz_Nm": states.moment}
    return {
        "out": str(out),
        "model": fit.model,
        "states": len(states),
        "covered": {name: [float(part.min()), float(part.max())] for name, part in spans.items()},
        "residual": {"tip_rms_m": _known(error.tip_rms), "tip_max_m": _known(error.tip_max),
                     "torque_rms_Nm": error.moment_rms * error.reference_moment,
                     "torque_max_Nm": error.moment_max * error.reference_moment},
        "noise": {"tip_coordinate_m": fit.noise[0], "torque_Nm": fit.noise[1]} if fit.noise else None,
        "coefficients": [{"name": c.name, "value": c.value, "error": c.error, "doubt": c.doubt}
                         for c in fit.coefficients],
        "joint": joint_to_dict(fit.joint),
    }  # fmt: skip


def _text(fit: MeasuredFit, out: Path) -> str:
    facts = _facts(fit, out)
    covered, residual, noise = facts["covered"], facts["residual"], facts["noise"]
    low, high = np.degrees(covered["theta_rad"])
    unknown = "too few states for a potential to tell it from a model's own error"
    if residual["tip_rms_m"] is None:
        unknown = "without the tip no potential can tell it from a model's own error"
    tip = "tip not measured"
    if residual["tip_rms_m"] is not None:
        tip = f"tip {1e3 * residual['tip_rms_m']:.3g} mm RMS, {1e3 * residual['tip_max_m']:.3g} mm at most"
    lines = [
        f"{fit.joint.source}, {facts['states']} states -> {fit.model} in {out}",
        f"covered   angle {low:.4g} to {high:.4g} deg, " + ", ".join(
            f"{name[:2]} {scale * a:.4g} to {scale * b:.4g} {unit}"
            for name, scale, unit in (("Fx_N", 1.0, "N"), ("Fy_N", 1.0, "N"), ("Mz_Nm", 1e3, "Nmm"))
            for a, b in [covered[name]]),
        f"residual  {tip}; torque {1e3 * residual['torque_rms_Nm']:.3g} Nmm RMS, "
        f"{1e3 * residual['torque_max_Nm']:.3g} Nmm at most",
        f"noise     {1e3 * noise['tip_coordinate_m']:.3g} mm a coordinate, {1e3 * noise['torque_Nm']:.3g} Nmm"
        if noise else f"noise     unknown: {unknown}",
        "",
        table(["coefficient", "value", "standard error", "identified"],
              [[c.name, c.value, c.error, "no" if c.doubt else "yes"] for c in fit.coefficients]),
    ]  # fmt: skip
    if fit.unidentified:
        lines += ["", "not identified by these data; do not trust the joint where they matter:"]
        lines += [f"  {c.name}: {c.doubt}" for c in fit.unidentified]
    return "\n".join(lines)


def _known(value: float) -> float | None:
    """The value, or None where nothing was measured."""
    return value if np.isfinite(value) else None
