"""Hinges in and out of TOML and plain dicts. Lengths in mm, said in every name.

    name = "mine"
    length_mm = 40.0                # the tip B is at (length, 0) at rest
    arm_mm = 120.0                  # optional, as are max_angle_deg, bodies beyond those the leaves name, and material
    [material]
    youngs_modulus_GPa = 2.95
    poisson_ratio = 0.38
    modulus = "beam"                # beam, plate or factor (with factor = 1.1)
    [[leaf]]
    from = "ground"
    from_mm = [0.0, 0.0]
    to = "tip"
    to_mm = [40.0, 0.0]
    width_mm = 40.0
    thickness_mm = 0.8

or a preset with other dimensions: preset = "x-hinge", thickness_mm = 1.0.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

from tensegym.errors import FlexureError

from .hinge import GROUND, TIP, Hinge, Leaf, Material
from .presets import MM, preset

_MATERIAL = {"youngs_modulus_GPa", "poisson_ratio", "modulus", "factor"}
_LEAF = {"from", "from_mm", "to", "to_mm", "width_mm", "thickness_mm"}
_HINGE = {"name", "length_mm", "arm_mm", "max_angle_deg", "bodies", "material", "leaf"}


def as_hinge(value: str | Path | dict[str, Any] | Hinge) -> Hinge:
    """A hinge from itself, a preset's name, a path that ends in .toml, or a dict as a TOML file gives.

    Raises FlexureError, naming the field and its value, or FileNotFoundError.
    """
    if isinstance(value, Hinge):
        return value
    if isinstance(value, dict):
        return hinge_from_dict(value)
    if not str(value).endswith(".toml"):
        return preset(str(value))
    path = Path(value)
    if not path.is_file():
        raise FileNotFoundError(f"no hinge file {path}")
    try:
        data = tomllib.loads(path.read_text())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FlexureError(f"{path} is not TOML: {error}") from error
    return hinge_from_dict(data)


def hinge_from_dict(data: dict[str, Any]) -> Hinge:
    """Build a hinge from nested plain types. Raises FlexureError."""
    data = dict(data)
    material = _material(data.pop("material", {}))
    if "preset" in data:
        name = _text(data.pop("preset"), "preset")
        dimensions = {}
        for key, value in data.items():  # lengths carry _mm, the crossing fraction has no unit
            scale = MM if key.endswith("_mm") else 1.0
            dimensions[key.removesuffix("_mm")] = scale * _number(value, key)
            if scale == 1.0 and key != "crossing":
                raise FlexureError(f"{key!r} beside a preset has no unit; give lengths such as thickness_mm")
        return preset(name, **dimensions).with_material(material)
    _known("the hinge", data, _HINGE)
    if not isinstance(data.get("leaf"), list) or not data["leaf"]:
        raise FlexureError('the hinge has no leaf; add a [[leaf]] section, or start from preset = "x-hinge"')
    leaves = tuple(_leaf(item) for item in data["leaf"])
    named = [GROUND, *(b for leaf in leaves for b in (leaf.start_body, leaf.end_body)), TIP]
    bodies = data.get("bodies", list(dict.fromkeys(named)))
    if not (isinstance(bodies, list) and all(isinstance(b, str) for b in bodies)):
        raise FlexureError(f"bodies = {bodies!r}; give a list of names")
    extra = {}
    if "arm_mm" in data:
        extra["arm"] = MM * _number(data["arm_mm"], "arm_mm")
    if "max_angle_deg" in data:
        extra["max_angle"] = math.radians(_number(data["max_angle_deg"], "max_angle_deg"))
    return Hinge(_text(data.get("name", "hinge"), "name"), leaves, MM * _number(data.get("length_mm"), "length_mm"),
                 tuple(bodies), material, **extra)  # fmt: skip


def hinge_to_dict(hinge: Hinge) -> dict[str, Any]:
    """Plain types that hinge_from_dict takes back."""
    material = hinge.material
    return {
        "name": hinge.name,
        "length_mm": _mm(hinge.length),
        "arm_mm": _mm(hinge.arm),
        "max_angle_deg": float(f"{math.degrees(hinge.max_angle):.12g}"),
        "bodies": list(hinge.bodies),
        "material": {
            "youngs_modulus_GPa": float(f"{material.youngs_modulus / 1e9:.12g}"),
            "poisson_ratio": material.poisson_ratio,
            "modulus": material.modulus,
            "factor": material.factor,
        },
        "leaf": [
            {"from": leaf.start_body, "from_mm": [_mm(v) for v in leaf.start], "to": leaf.end_body,
             "to_mm": [_mm(v) for v in leaf.end], "width_mm": _mm(leaf.width), "thickness_mm": _mm(leaf.thickness)}
            for leaf in hinge.leaves
        ],
    }  # fmt: skip


def hinge_to_toml(hinge: Hinge) -> str:
    """TOML text that as_hinge reads back."""
    data = hinge_to_dict(hinge)
    material, leaves = data.pop("material"), data.pop("leaf")
    sections = [("", data), ("[material]", material), *(("[[leaf]]", leaf) for leaf in leaves)]
    return "\n".join("\n".join([head, *(f"{k} = {_toml(v)}" for k, v in body.items())]).lstrip() + "\n"
                     for head, body in sections)  # fmt: skip


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return repr(float(value))


def _material(data: Any) -> Material:
    if not isinstance(data, dict):
        raise FlexureError(f"material = {data!r}; give a [material] section")
    _known("material", data, _MATERIAL)
    fields: dict[str, Any] = {}
    if "youngs_modulus_GPa" in data:
        fields["youngs_modulus"] = 1e9 * _number(data["youngs_modulus_GPa"], "youngs_modulus_GPa")
    for key in ("poisson_ratio", "factor"):
        if key in data:
            fields[key] = _number(data[key], key)
    if "modulus" in data:
        fields["modulus"] = _text(data["modulus"], "modulus")
    return Material(**fields)


def _leaf(data: Any) -> Leaf:
    if not isinstance(data, dict):
        raise FlexureError(f"leaf = {data!r}; give a [[leaf]] section")
    _known("a leaf", data, _LEAF)
    missing = _LEAF - data.keys()
    if missing:
        raise FlexureError(f"a leaf has no {sorted(missing)[0]!r}; it needs {', '.join(sorted(_LEAF))}")
    points = []
    for key in ("from_mm", "to_mm"):
        if not (isinstance(data[key], list) and len(data[key]) == 2):
            raise FlexureError(f"leaf {key} = {data[key]!r}; give [x, y] in mm")
        points.append((MM * _number(data[key][0], key), MM * _number(data[key][1], key)))
    return Leaf(_text(data["from"], "from"), points[0], _text(data["to"], "to"), points[1],
                MM * _number(data["width_mm"], "width_mm"),
                MM * _number(data["thickness_mm"], "thickness_mm"))  # fmt: skip


def _known(what: str, data: dict[str, Any], allowed: set[str]) -> None:
    for key in data:
        if key not in allowed:
            raise FlexureError(f"{what} has no field {key!r}; its fields are {', '.join(sorted(allowed))}")


def _number(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise FlexureError(f"{name} = {value!r} is no finite number")
    return float(value)


def _text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise FlexureError(f"{name} = {value!r}; give a text")
    return value


def _mm(value: float) -> float:
    return float(f"{value / MM:.12g}")
