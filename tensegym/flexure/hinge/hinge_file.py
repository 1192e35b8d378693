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
    # end_thickness_mm = 0.4        # the leaf tapers; thickness_mm is then that at from_mm
    # notch_mm = [5.0, 5.0]         # or: elliptic fillets at both ends of a web, semi-axes along and across the leaf

or a preset with other dimensions: preset = "x-hinge", thickness_mm = 1.0.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import tomli_w

from tensegym.errors import FlexureError
from tensegym.tables import as_number, as_numbers, as_text, in_file, known, mapping, one_line, read_toml, show

from .hinge import GROUND, TIP, Hinge, Leaf, Material
from .presets import MM, preset
from .profile import Notch, Profile, Taper

_MATERIAL = ("youngs_modulus_GPa", "poisson_ratio", "modulus", "factor")
_LEAF = ("from", "from_mm", "to", "to_mm", "width_mm", "thickness_mm")
_PROFILE = ("end_thickness_mm", "notch_mm")
_HINGE = ("name", "length_mm", "arm_mm", "max_angle_deg", "bodies", "material", "leaf")


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
    data = read_toml(value, "hinge file", FlexureError)
    with in_file(f"hinge file {value}"):
        return hinge_from_dict(data)


def hinge_from_dict(data: dict[str, Any]) -> Hinge:
    """Build a hinge from nested plain types. Raises FlexureError."""
    data = dict(mapping(data, "hinge", FlexureError))
    material = _material(data.pop("material", {}))
    if "preset" in data:
        name = as_text(data.pop("preset"), "preset", FlexureError)
        dimensions = {}
        for key, value in data.items():  # lengths carry _mm, the crossing fraction has no unit
            scale = MM if str(key).endswith("_mm") else 1.0
            dimensions[str(key).removesuffix("_mm")] = scale * as_number(value, show(key), FlexureError)
            if scale == 1.0 and key != "crossing":
                raise FlexureError(f"{show(key)} beside a preset has no unit; give lengths such as thickness_mm")
        return preset(name, **dimensions).with_material(material)
    known(data, _HINGE, "the hinge", FlexureError)
    if not isinstance(data.get("leaf"), list) or not data["leaf"]:
        raise FlexureError('the hinge has no leaf; add a [[leaf]] section, or start from preset = "x-hinge"')
    leaves = tuple(_leaf(item, i + 1) for i, item in enumerate(data["leaf"]))
    named = [GROUND, *(b for leaf in leaves for b in (leaf.start_body, leaf.end_body)), TIP]
    bodies = data.get("bodies", list(dict.fromkeys(named)))
    if not (isinstance(bodies, list) and all(isinstance(b, str) for b in bodies)):
        raise FlexureError(one_line(f"bodies = {show(bodies)}; give a list of names"))
    extra = {}
    if "arm_mm" in data:
        extra["arm"] = MM * as_number(data["arm_mm"], "arm_mm", FlexureError)
    if "max_angle_deg" in data:
        extra["max_angle"] = math.radians(as_number(data["max_angle_deg"], "max_angle_deg", FlexureError))
    length = MM * as_number(data.get("length_mm"), "length_mm", FlexureError)
    return Hinge(as_text(data.get("name", "hinge"), "name", FlexureError), leaves, length, tuple(bodies), material,
                 **extra)  # fmt: skip


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
             "to_mm": [_mm(v) for v in leaf.end], "width_mm": _mm(leaf.width), "thickness_mm": _mm(leaf.thickness),
             **_profile_to_dict(leaf.profile)}
            for leaf in hinge.leaves
        ],
    }  # fmt: skip


def hinge_to_toml(hinge: Hinge) -> str:
    """TOML text that as_hinge reads back."""
    return tomli_w.dumps(hinge_to_dict(hinge))


def _material(data: Any) -> Material:
    known(data, _MATERIAL, "material", FlexureError)
    fields: dict[str, Any] = {}
    if "youngs_modulus_GPa" in data:
        fields["youngs_modulus"] = 1e9 * as_number(data["youngs_modulus_GPa"], "youngs_modulus_GPa", FlexureError)
    for key in ("poisson_ratio", "factor"):
        if key in data:
            fields[key] = as_number(data[key], key, FlexureError)
    if "modulus" in data:
        fields["modulus"] = as_text(data["modulus"], "modulus", FlexureError)
    return Material(**fields)


def _leaf(data: Any, number: int) -> Leaf:
    where = f"leaf {number}"
    missing = set(_LEAF) - known(data, (*_LEAF, *_PROFILE), where, FlexureError).keys()
    if missing:
        raise FlexureError(one_line(f"{where} has no {min(missing)!r}; it needs {', '.join(sorted(_LEAF))}"))
    bodies = [as_text(data[key], f"{where}: {key}", FlexureError) for key in ("from", "to")]
    points = []
    for key in ("from_mm", "to_mm"):
        x, y = as_numbers(data[key], 2, f"{where}: {key}", FlexureError)
        points.append((MM * x, MM * y))
    width, thickness = (MM * as_number(data[key], f"{where}: {key}", FlexureError)
                        for key in ("width_mm", "thickness_mm"))  # fmt: skip
    return Leaf(bodies[0], points[0], bodies[1], points[1], width, thickness, _profile(data, where))


def _profile(data: dict[str, Any], where: str) -> Profile | None:
    if all(key in data for key in _PROFILE):
        raise FlexureError(f"{where} has both {' and '.join(_PROFILE)}; a leaf tapers or is notched, give one")
    if "end_thickness_mm" in data:
        return Taper(MM * as_number(data["end_thickness_mm"], f"{where}: end_thickness_mm", FlexureError))
    if "notch_mm" in data:
        along, across = as_numbers(data["notch_mm"], 2, f"{where}: notch_mm", FlexureError)
        return Notch(MM * along, MM * across)
    return None


def _profile_to_dict(profile: Profile | None) -> dict[str, Any]:
    if isinstance(profile, Taper):
        return {"end_thickness_mm": _mm(profile.end_thickness)}
    return {} if profile is None else {"notch_mm": [_mm(profile.along), _mm(profile.across)]}


def _mm(value: float) -> float:
    return float(f"{value / MM:.12g}")
