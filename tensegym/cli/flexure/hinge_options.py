"""The options that say which hinge: shared by the commands."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Annotated, Any

from tensegym.cli.options import Within
from tensegym.errors import InputError
from tensegym.flexure.hinge import PRESETS, Hinge, as_hinge, preset
from tensegym.flexure.hinge.presets import MM

Force = Annotated[float, Within(-1e6, 1e6, "N")]
_LENGTHS = ("length", "height", "width", "thickness", "end_thickness", "radius", "depth", "rib", "arm")


@dataclass(frozen=True)
class HingeOptions:
    """Dimensions and material in place of a preset's or a file's own."""

    length_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """Presets: distance of the tip from the base at rest, L."""
    height_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """Presets: height H of the leaves' span."""
    width_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """Presets: width W out of plane."""
    thickness_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """Presets: thickness t of every leaf; of a taper at the ground, of a notch at its web."""
    end_thickness_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """tapered-leaf: thickness at the tip."""
    radius_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """notch-hinge: extent of a fillet along the web, at most L/2 (the default: no straight web)."""
    depth_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """notch-hinge: extent of a fillet across the web; the default, the radius, makes circles."""
    rib_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """trls2: extent of a rib along the leaf."""
    crossing: Annotated[float, Within(0.0, 1.0)] | None = None
    """cross-spring: fraction of the leaves' length at which they cross."""
    arm_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """Presets: lever of the stand beyond the tip; 0: a pure moment turns the hinge."""
    youngs_modulus_GPa: Annotated[float, Within(0.0, 1e5, "GPa")] | None = None
    """E of the material."""
    poisson_ratio: Annotated[float, Within(-1.0, 0.5)] | None = None
    """nu of the material; only the plate modulus uses it."""
    modulus: str | None = None
    """beam: E; plate: E/(1-nu^2); factor: --factor times E."""
    factor: Annotated[float, Within(0.0, 1e6)] | None = None
    """The user's factor on E, with --modulus factor."""

    def given(self) -> list[str]:
        """Names of the options that were given."""
        return [field.name for field in fields(self) if getattr(self, field.name) is not None]

    def apply(self, name: str) -> Hinge:
        """The hinge ``name`` (a preset or a TOML file) with these options. Raises FlexureError or InputError."""
        given = {k: getattr(self, f"{k}_mm") for k in _LENGTHS if getattr(self, f"{k}_mm") is not None}
        dimensions = {k: MM * v for k, v in given.items()}
        if self.crossing is not None:
            dimensions["crossing"] = self.crossing
        if dimensions and name not in PRESETS and name.endswith(".toml"):
            raise InputError(f"{', '.join(dimensions)}: dimensions are for presets; change them in {name}")
        hinge = preset(name, **dimensions) if dimensions else as_hinge(name)
        changes: dict[str, float | str] = {}
        if self.youngs_modulus_GPa is not None:
            changes["youngs_modulus"] = 1e9 * self.youngs_modulus_GPa
        for key in ("poisson_ratio", "modulus", "factor"):
            if getattr(self, key) is not None:
                changes[key] = getattr(self, key)
        return hinge.with_material(replace(hinge.material, **changes))  # type: ignore[arg-type]


@dataclass(frozen=True)
class BoxOptions:
    """Where the models are fitted."""

    max_angle_deg: Annotated[float, Within(0.0, 90.0, "deg")] | None = None
    """Largest rotation; default: the hinge's own (30)."""
    max_force_N: Annotated[float, Within(0.0, 1e6, "N")] | None = None
    """Largest force at the tip on each base axis; default: the pure moment at the largest rotation over L."""
    force_x_N: tuple[Force, Force] | None = None
    """Least and largest force along x instead, as 0 40 for a pivot that is only pulled."""
    force_y_N: tuple[Force, Force] | None = None
    """Least and largest force along y instead."""

    def given(self) -> list[str]:
        """Names of the options that were given."""
        return [field.name for field in fields(self) if getattr(self, field.name) is not None]

    def ranges(self) -> dict[str, Any]:
        """The arguments that ``fit_joint`` takes of them."""
        return {"max_angle": self.max_angle, "max_force": self.max_force_N, "force_x": self.force_x_N,
                "force_y": self.force_y_N}  # fmt: skip

    @property
    def max_angle(self) -> float | None:
        """[rad], or None."""
        return None if self.max_angle_deg is None else math.radians(self.max_angle_deg)


def refuse_unused(options: list[str], reason: str) -> None:
    """Raise InputError for options that would have no effect."""
    if options:
        raise InputError(f"--{options[0].replace('_', '-')} has no effect {reason}; leave it out")
