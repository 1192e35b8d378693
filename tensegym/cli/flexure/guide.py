"""`tensegym flexure guide`: a parallelogram by the FEM, the beam constraint model and pseudo-rigid bodies."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro

from tensegym.cli.options import Within
from tensegym.errors import InputError
from tensegym.files import check_file
from tensegym.flexure.hinge.presets import MM
from tensegym.flexure.models.guide_comparison import REFERENCE, Column, axial_range, compare_guide
from tensegym.flexure.models.guide_models import BeamConstraint, guide_of
from tensegym.plotting import require_matplotlib
from tensegym.report import Report, table

from .guide_figure import draw_guide
from .hinge_options import HingeOptions

OUTSIDE = "-: beyond the box of loads that the fitted models hold"


@dataclass(frozen=True)
class Guide:
    """A parallelogram flexure by the FEM, the beam constraint model, the pseudo-rigid body and fitted springs: errors
    along the travel against run time."""

    hinge: tyro.conf.Positional[str] = "parallel-guide"
    """A preset or a TOML file of two equal leaves side by side."""
    out: Path | None = None
    """Picture to write (PNG)."""
    options: HingeOptions = field(default_factory=HingeOptions)
    travel_mm: Annotated[float, Within(0.0, 1e5, "mm")] | None = None
    """Largest travel; default: L/10, the range of the beam constraint model."""
    axial_N: Annotated[float, Within(-1e6, 1e6, "N")] = 0.0
    """Dead force along the leaves; negative pushes them together."""

    def run(self) -> Report:
        if self.out is not None:
            check_file(self.out)
            require_matplotlib()
        if self.travel_mm == 0:
            raise InputError("travel_mm = 0; give a travel above 0")
        hinge = self.options.apply(self.hinge)
        reach = hinge.length / 10 if self.travel_mm is None else MM * self.travel_mm
        reference, columns, missing = compare_guide(hinge, reach, self.axial_N)
        errors = {column.name: column.errors(reference) for column in columns}
        header = ["model", "y %", "x %", "turn %", "k y %", "k x %", "us"]
        ranges = axial_range(hinge, BeamConstraint(guide_of(hinge)), reach)
        unit = guide_of(hinge).bending * 2 / hinge.length**2
        text = [
            f"{hinge.describe()}; {len(reference.states)} forces to {1e3 * reach:.4g} mm of travel, "
            f"{self.axial_N:g} N along x",
            f"largest misses of the FEM with {REFERENCE} elements, and time of all poses, warm, one thread:",
            table(header, [_row(column, errors[column.name]) for column in columns]),
            *([OUTSIDE] if any(np.isnan(column.poses).any() for column in columns) else []),
            *([missing] if missing else []),
            f"the beam constraint model is within 5 % at {1e3 * reach:.4g} mm under axial forces",
            table(["of", "from N", "to N", "p of a leaf"],
                  [[name, f"{low + 0:.4g}", f"{high:.4g}", f"{low / unit + 0:.3g} to {high / unit:.3g}"] if low < high
                   else [name, "none", "none", "-"] for name, (low, high) in ranges.items()]),
        ]  # fmt: skip
        if self.out is not None:
            draw_guide(hinge, reference, columns, errors, self.out)
            text.append(f"drawn: {self.out}")
        data: dict[str, Any] = {
            "source": hinge.describe(), "travel_m": reach, "axial_N": self.axial_N,
            "force_N": reference.states.force[:, 1], "tip_m": reference.states.tip, "turn_rad": reference.states.theta,
            "k_y_N_per_m": reference.drive_stiffness, "k_x_N_per_m": reference.support_stiffness(0),
            "models": {column.name: {"errors": errors[column.name], "seconds": column.seconds} for column in columns},
            "beam_constraint_within_5_percent_N": {name: list(ends) for name, ends in ranges.items()},
        }  # fmt: skip
        return Report("\n".join(text), data)


def _row(column: Column, errors: dict[str, float]) -> list[str]:
    cells = [f"{100 * errors[name]:.3g}" if np.isfinite(errors[name]) else "-"
             for name in ("y", "x", "turn", "k y", "k x")]  # fmt: skip
    return [column.name, *cells, f"{1e6 * column.seconds:.3g}"]
