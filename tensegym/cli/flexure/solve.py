"""`tensegym flexure solve`: loads in, poses out."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.cli.options import Within
from tensegym.errors import InputError
from tensegym.files import check_file, replace_file
from tensegym.flexure.fem.mesh_error import too_coarse_for
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.models.joint import MODELS, Joint
from tensegym.flexure.models.joint_file import load_joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.load_solver import Answer, solve_fem, solve_model
from tensegym.report import Report, table
from tensegym.tables import number_of, read_rows

from .hinge_options import BoxOptions, HingeOptions, refuse_unused

LOADS = ("Fx_N", "Fy_N", "Mz_Nmm")
POSES = ("theta_rad", "x_mm", "y_mm", "strain_energy_Nmm", "status")


@dataclass(frozen=True)
class Solve:
    """Where the tip goes under dead loads: one row out for each row in, a failed row marked with its reason."""

    loads: Path
    """CSV with the columns Fx_N, Fy_N, Mz_Nmm: dead force at the tip in base axes, moment about the tip."""
    out: Path
    """CSV to write: the loads, theta_rad, x_mm, y_mm of the tip, strain_energy_Nmm, status (ok or the reason)."""
    hinge: str | None = None
    """A preset or a TOML file; models other than fem are fitted on the spot."""
    joint: Path | None = None
    """A file of `tensegym flexure fit`, in place of --hinge."""
    model: str = "fem"
    """fem, potential, planar (constant k), paper (stiffness diagrams) or torsion (1-DoF)."""
    options: HingeOptions = field(default_factory=HingeOptions)
    box: BoxOptions = field(default_factory=BoxOptions)
    elements: Annotated[int, Within(1, 1000)] = 16
    """Beam elements a leaf of length L."""

    def run(self) -> Report:
        if self.model not in ("fem", *MODELS):
            raise InputError(f"model = {self.model!r}; one of fem, {', '.join(MODELS)}")
        if (self.hinge is None) == (self.joint is None):
            raise InputError("give one of --hinge and --joint")
        if self.joint is not None:
            refuse_unused([*self.options.given(), *self.box.given()], "with --joint, whose hinge and box are fitted")
        elif self.model == "fem":
            refuse_unused(self.box.given(), "with the model fem, which has no box")
        check_file(self.out)
        loads = read_loads(self.loads)
        answers, source = self._answers(loads)
        with replace_file(self.out) as file:
            writer = csv.writer(file)
            writer.writerow([*LOADS, *POSES])
            for load, answer in zip(loads, answers, strict=True):
                values = [*load[:2], 1e3 * load[2], answer.theta, 1e3 * answer.x, 1e3 * answer.y, 1e3 * answer.energy]
                writer.writerow([*(f"{v:.12g}" if math.isfinite(v) else "" for v in values), answer.reason or "ok"])
        failed = [(i, a.reason) for i, a in enumerate(answers, start=1) if a.reason]
        rows = [[str(self.out), self.model, len(answers), len(failed)]]
        text = source + "\n" + table(["out", "model", "rows", "failed"], rows)
        text += "".join(f"\nrow {i}: {reason}" for i, reason in failed[:10])
        data = {"out": str(self.out), "source": source, "model": self.model, "rows": len(answers),
                "failed": [{"row": i, "reason": reason} for i, reason in failed]}  # fmt: skip
        return Report(text, data, passed=not failed)

    def _answers(self, loads: FloatArray) -> tuple[list[Answer], str]:
        if self.joint is not None:
            joint = load_joint(self.joint)
            if self.model != "fem":
                return solve_model(joint.model(self.model), joint.box, loads), _told(joint)
            if joint.hinge is None:
                raise InputError(f"{self.joint} was fitted to data and holds no hinge: the model fem needs one")
            source = _meshed(joint.hinge, joint.source, loads, self.elements)
            return solve_fem(joint.hinge, loads, self.elements), source
        assert self.hinge is not None
        hinge: Hinge = self.options.apply(self.hinge)
        if self.model == "fem":
            return solve_fem(hinge, loads, self.elements), _meshed(hinge, hinge.describe(), loads, self.elements)
        joint = fit_joint(hinge, **self.box.ranges(), held_out=0, elements=self.elements)
        return solve_model(joint.model(self.model), joint.box, loads), _told(joint)


def _meshed(hinge: Hinge, source: str, loads: FloatArray, elements: int) -> str:
    """The source, and whether the mesh is too coarse for the largest loads."""
    note = too_coarse_for(hinge, loads[np.unique(np.abs(loads).argmax(axis=0))], elements)
    return f"{source}\nnote: {note}" if note else source


def _told(joint: Joint) -> str:
    """What was fitted, and what a user must know of it."""
    return "\n".join([joint.source, *(f"note: {note}" for note in joint.notes)])


def read_loads(path: Path) -> FloatArray:
    """(n, 3) force x, y [N] and moment [N m]. Raises FileNotFoundError, or InputError naming column and row."""
    header, rows, _ = read_rows(path)
    for name in LOADS:
        if name not in header:
            raise InputError(f"{path}: no column {name}; the header must name {', '.join(LOADS)}, units included")
    values = np.array([[number_of(row[header.index(name)], f"{path}: row {i}, {name}") for name in LOADS]
                       for i, row in enumerate(rows, 1)])  # fmt: skip
    if np.isnan(values).any():
        row, column = np.argwhere(np.isnan(values))[0]
        raise InputError(f"{path}: row {row + 1} has no {LOADS[column]}")
    return np.asarray(values * [1, 1, 1e-3])
