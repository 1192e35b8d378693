"""Joints in and out of a small readable JSON file; SI units, named in every key."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.files import check_file, replace_file
from tensegym.flexure.hinge import Box, hinge_from_dict, hinge_to_dict
from tensegym.flexure.hinge.ranges import check_count
from tensegym.tables import as_number, as_numbers, as_text, in_file, mapping, one_line, parse_json, read_text, show

from .certificate import certify
from .joint import MODELS, Joint, Model
from .model_error import ModelError
from .planar_spring import PlanarSpring
from .potential import Potential
from .potential_kernel import NAMES
from .stiffness_diagram import StiffnessDiagram
from .torsion_spring import TorsionSpring

FORMAT = "tensegym flexible joint, version 1"
HIGHEST_DEGREE = 30
_ENDS = ("force_x", "force_y")


def save_joint(joint: Joint, path: str | Path) -> None:
    """Write the joint; the file is whole or not there."""
    path = Path(path)
    check_file(path)
    with replace_file(path) as file:
        json.dump(joint_to_dict(joint), file, indent=1)
        file.write("\n")


def joint_to_dict(joint: Joint) -> dict[str, Any]:
    """The joint as plain types."""
    return {
        "format": FORMAT,
        "source": joint.source,
        "length_m": joint.length,
        "box": {"max_angle_rad": joint.box.max_angle, "max_force_N": joint.box.max_force,
                **{f"{name}_N": list(ends) for name in _ENDS if (ends := getattr(joint.box, name))}},
        "models": {name: _model_to_dict(model) for name, model in joint.models.items()},
        "errors_of": joint.errors_of,
        "errors": {name: _error_to_dict(error) for name, error in joint.errors.items()},
        "notes": list(joint.notes),
        "hinge": hinge_to_dict(joint.hinge) if joint.hinge else None,
    }  # fmt: skip


def load_joint(path: str | Path) -> Joint:
    """Read a joint and certify its potential again.

    Raises:
        FileNotFoundError: where there is no such file.
        FlexureError: naming the file and the field.
    """
    data = parse_json(read_text(path, "joint file", FlexureError), f"joint file {path}", FlexureError)
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FlexureError(f"{path} is no joint file (format {FORMAT!r}); write one with `tensegym flexure fit`")
    with in_file(str(path)):
        joint = joint_from_dict(data)
        if "potential" in joint.models:
            joint.certificate()
    return joint


def joint_from_dict(data: dict[str, Any]) -> Joint:
    """The inverse of joint_to_dict. Raises FlexureError that names the field."""
    length, of_box = _number(data, "length_m"), _table(data, "box")
    ends: dict[str, Any] = {name: as_numbers(of_box[f"{name}_N"], 2, f"{name}_N", FlexureError) for name in _ENDS
            if f"{name}_N" in of_box}  # fmt: skip
    box = Box(_number(of_box, "max_angle_rad"), _number(of_box, "max_force_N"), **ends)
    named = _table(data, "models")
    models = {name: _model_from_dict(name, _table(named, name), length, box) for name in named}
    of_models = _table(data, "errors")
    errors = {name: _error_from_dict(_table(of_models, name)) for name in of_models}
    hinge = hinge_from_dict(_table(data, "hinge")) if data.get("hinge") is not None else None
    notes = _list(data, "notes")
    return Joint(_text(data, "source"), length, box, models, errors, _text(data, "errors_of"), hinge,
                 tuple(as_text(note, "a note", FlexureError) for note in notes))  # fmt: skip


def _field(data: dict[str, Any], name: str) -> Any:
    if name not in data:
        raise FlexureError(f"the field {name!r} is missing")
    return data[name]


def _number(data: dict[str, Any], name: str) -> float:
    return as_number(_field(data, name), name, FlexureError)


def _text(data: dict[str, Any], name: str) -> str:
    return as_text(_field(data, name), name, FlexureError)


def _table(data: dict[str, Any], name: str) -> dict[str, Any]:
    return mapping(_field(data, name), name, FlexureError)


def _list(data: dict[str, Any], name: str) -> list[Any]:
    value = _field(data, name)
    if not isinstance(value, list):
        raise FlexureError(one_line(f"{name} = {show(value)} must be a list"))
    return value


def _column(data: dict[str, Any], name: str) -> FloatArray:
    return np.array(as_numbers(_list(data, name), None, name, FlexureError))


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
        degree = _field(data, "degree")
        check_count("degree", degree, 0, HIGHEST_DEGREE, "a fit has 6")
        rows, by_power = np.zeros((len(NAMES), degree + 1)), _table(data, "coefficients_by_power")
        for row, key in zip(rows, NAMES, strict=True):
            for power, value in _table(by_power, key).items():
                if not (power.isdecimal() and len(power) < 4 and int(power) < len(row)):
                    raise FlexureError(f"coefficient {key}[{power[:40]}]: the power is outside [0, {len(row) - 1}]")
                row[int(power)] = as_number(value, f"coefficient {key}[{power}]", FlexureError)
        return Potential(rows, length, _number(data, "moment_scale_Nm"), _number(data, "angle_scale_rad"), box)
    if name == "planar":
        return PlanarSpring(length, *(_number(data, key) for key in ("b", "kx_N_per_m", "ky_N_per_m", "kz_Nm_per_rad")))
    if name == "torsion":
        return TorsionSpring(length, _number(data, "lambda"), _number(data, "stiffness_Nm_per_rad"))
    if name == "paper":
        columns = [_column(data, key) for key in ("kx_N_per_m", "ky_N_per_m", "kz_Nm_per_rad")]
        if len({len(column) for column in columns}) > 1:
            raise FlexureError("kx_N_per_m, ky_N_per_m and kz_Nm_per_rad have different lengths")
        return StiffnessDiagram(length, _number(data, "b"), _column(data, "theta_rad"), np.column_stack(columns),
                                _column(data, "singular_theta_rad"))  # fmt: skip
    raise FlexureError(one_line(f"unknown model {show(name)} in a joint file; one of {', '.join(MODELS)}"))


_ERROR_KEYS = {"tip_rms": "tip_rms_m", "tip_max": "tip_max_m", "moment_rms": "moment_rms_share",
               "moment_max": "moment_max_share", "reference_moment": "reference_moment_Nm", "count": "states",
               "lost": "lost"}  # fmt: skip


def _error_to_dict(error: ModelError) -> dict[str, Any]:
    """Plain JSON: an infinite error (no state answered) is null."""
    return {key: value if np.isfinite(value := getattr(error, name)) else None for name, key in _ERROR_KEYS.items()}


def _error_from_dict(data: dict[str, Any]) -> ModelError:
    values: dict[str, Any] = {name: np.inf if _field(data, key) is None else _number(data, key)
                              for name, key in _ERROR_KEYS.items()}  # fmt: skip
    for name in ("count", "lost"):
        check_count(_ERROR_KEYS[name], data[_ERROR_KEYS[name]], 0, 10**9, "it counts states")
    return ModelError(**values | {"count": data["states"], "lost": data["lost"]})
