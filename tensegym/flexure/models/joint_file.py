"""Joints in and out of a small readable JSON file; SI units, named in every key."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.errors import FlexureError
from tensegym.files import replace_file
from tensegym.flexure.hinge import Box, hinge_from_dict, hinge_to_dict

from .certificate import certify
from .joint import Joint, Model
from .model_error import ModelError
from .planar_spring import PlanarSpring
from .potential import Potential
from .potential_kernel import NAMES
from .stiffness_diagram import StiffnessDiagram
from .torsion_spring import TorsionSpring

FORMAT = "tensegym flexible joint, version 1"


def save_joint(joint: Joint, path: str | Path) -> None:
    """Write the joint; the file is whole or not there."""
    path = Path(path)
    if not path.parent.is_dir():
        raise FileNotFoundError(f"no folder {path.parent} to write {path.name} in")
    with replace_file(path) as file:
        json.dump(joint_to_dict(joint), file, indent=1)
        file.write("\n")


def joint_to_dict(joint: Joint) -> dict[str, Any]:
    """The joint as plain types."""
    return {
        "format": FORMAT,
        "source": joint.source,
        "length_m": joint.length,
        "box": {"max_angle_rad": joint.box.max_angle, "max_force_N": joint.box.max_force},
        "models": {name: _model_to_dict(model) for name, model in joint.models.items()},
        "errors_of": joint.errors_of,
        "errors": {name: _error_to_dict(error) for name, error in joint.errors.items()},
        "notes": list(joint.notes),
        "hinge": hinge_to_dict(joint.hinge) if joint.hinge else None,
    }


def load_joint(path: str | Path) -> Joint:
    """Read a joint and certify its potential again. Raises FlexureError or FileNotFoundError."""
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"no joint file {path}")
    try:
        data = json.loads(path.read_text())
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise FlexureError(f"{path} is not JSON: {error}") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FlexureError(f"{path} is no joint file (format {FORMAT!r}); write one with `tensegym flexure fit`")
    try:
        joint = joint_from_dict(data)
    except (KeyError, TypeError, AttributeError) as error:
        raise FlexureError(f"{path}: the field {error} is missing or has the wrong type") from error
    if "potential" in joint.models:
        joint.certificate()
    return joint


def joint_from_dict(data: dict[str, Any]) -> Joint:
    """The inverse of joint_to_dict."""
    box = Box(data["box"]["max_angle_rad"], data["box"]["max_force_N"])
    models = {name: _model_from_dict(name, model, data["length_m"], box) for name, model in data["models"].items()}
    errors = {name: _error_from_dict(error) for name, error in data["errors"].items()}
    hinge = hinge_from_dict(data["hinge"]) if data.get("hinge") else None
    return Joint(data["source"], data["length_m"], box, models, errors, data["errors_of"], hinge, tuple(data["notes"]))


def _model_to_dict(model: Model) -> dict[str, Any]:
    if isinstance(model, Potential):
        named = zip(NAMES, model.coefficients, strict=True)
        rows = {name: {str(i): float(c) for i, c in enumerate(row) if c} for name, row in named}
        bounds = {f"{k}_lower_bound": v for k, v in asdict(certify(model)).items()}
        return {"moment_scale_Nm": model.moment_scale, "angle_scale_rad": model.angle_scale,
                "degree": model.coefficients.shape[1] - 1, "coefficients_by_power": rows,
                "certificate": bounds}  # fmt: skip
    if isinstance(model, PlanarSpring):
        return {"a": model.a, "b": model.b, "kx_N_per_m": model.kx, "ky_N_per_m": model.ky, "kz_Nm_per_rad": model.kz}
    if isinstance(model, TorsionSpring):
        return {"lambda": model.fraction, "stiffness_Nm_per_rad": model.stiffness}
    return {"a": 1 - model.b, "b": model.b, "theta_rad": model.theta.tolist(),
            "kx_N_per_m": model.stiffness[:, 0].tolist(), "ky_N_per_m": model.stiffness[:, 1].tolist(),
            "kz_Nm_per_rad": model.stiffness[:, 2].tolist(), "singular_theta_rad": model.singular.tolist()}  # fmt: skip


def _model_from_dict(name: str, data: dict[str, Any], length: float, box: Box) -> Model:
    if name == "potential":
        rows = np.zeros((len(NAMES), int(data["degree"]) + 1))
        for row, key in zip(rows, NAMES, strict=True):
            for power, value in data["coefficients_by_power"][key].items():
                if not (power.isdigit() and int(power) < len(row)):
                    raise FlexureError(f"coefficient {key}[{power}]: the power is outside [0, {len(row) - 1}]")
                row[int(power)] = value
        return Potential(rows, length, data["moment_scale_Nm"], data["angle_scale_rad"], box)
    if name == "planar":
        return PlanarSpring(length, data["b"], data["kx_N_per_m"], data["ky_N_per_m"], data["kz_Nm_per_rad"])
    if name == "torsion":
        return TorsionSpring(length, data["lambda"], data["stiffness_Nm_per_rad"])
    if name == "paper":
        stiffness = np.column_stack([data["kx_N_per_m"], data["ky_N_per_m"], data["kz_Nm_per_rad"]])
        theta, singular = np.array(data["theta_rad"]), np.array(data["singular_theta_rad"])
        return StiffnessDiagram(length, data["b"], theta, stiffness, singular)
    raise FlexureError(f"unknown model {name!r} in a joint file; one of potential, planar, paper, torsion")


_ERROR_KEYS = {"tip_rms": "tip_rms_m", "tip_max": "tip_max_m", "moment_rms": "moment_rms_share",
               "moment_max": "moment_max_share", "reference_moment": "reference_moment_Nm", "count": "states",
               "lost": "lost"}  # fmt: skip


def _error_to_dict(error: ModelError) -> dict[str, Any]:
    """Plain JSON: an infinite error (no state answered) is null."""
    return {key: value if np.isfinite(value := getattr(error, name)) else None for name, key in _ERROR_KEYS.items()}


def _error_from_dict(data: dict[str, Any]) -> ModelError:
    values: dict[str, Any] = {name: np.inf if data[key] is None else data[key] for name, key in _ERROR_KEYS.items()}
    return ModelError(**values)
