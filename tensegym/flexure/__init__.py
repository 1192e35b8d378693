"""Flexible joints: hinge geometry, a beam FEM, the paper's spring models and a passive potential.

    from tensegym.flexure import fit_joint, preset, save_joint

    joint = fit_joint(preset("leaf-spring", thickness=0.6e-3))
    joint.model("potential").wrench(0.0395, 0.005, 0.2)  # N, N, N m that hold the tip at x, y [m], theta [rad]
    save_joint(joint, "leaf.json")

SI units; millimetres only in files and tables, and said so in the column's name. Frames: base axes are fixed to the
hinge's ground at A, x along the hinge, the tip B at (L, 0) at rest; a tip position is of B in base axes, a force acts
at the tip in base axes (dead: it keeps its direction), a moment is about the tip, counterclockwise positive, theta is
the turn of the tip's body.

    hinge/      what a hinge is, its presets and its file; States: what someone saw it do
    fem/        the reference: equilibrium states by a planar beam FEM
    models/     joint models fitted to states, their certificate, their file
    measured/   data of an experiment, from pictures to a fitted joint

Each uses those above it. They need numpy, scipy and numba, and of tensegym only arrays, errors, files, tables, report.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .hinge import Box, Hinge, Leaf, Material, States, as_hinge, preset
    from .measured import fit_measured, read_measured
    from .models import Joint, choose_model, fit_joint, load_joint, save_joint

_HOMES = {  # imported when asked for: a design that only needs a hinge's sizes starts without SciPy
    "hinge": ("Box", "Hinge", "Leaf", "Material", "States", "as_hinge", "preset"),
    "models": ("Joint", "choose_model", "fit_joint", "load_joint", "save_joint"),
    "measured": ("fit_measured", "read_measured"),
}

__all__ = [
    "Box", "Hinge", "Joint", "Leaf", "Material", "States", "as_hinge", "choose_model", "fit_joint", "fit_measured",
    "load_joint", "preset", "read_measured", "save_joint",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f".{home}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
