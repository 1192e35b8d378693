"""`tensegym flexure fit`: a joint from a hinge's FEM, or from a measured experiment."""

from __future__ import annotations

import math
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from tensegym.cli.options import Seed, Within
from tensegym.errors import InputError
from tensegym.files import check_file
from tensegym.flexure.hinge.presets import MM
from tensegym.flexure.measured.measured_file import ARM_LENGTH, PAPER_LENGTH
from tensegym.flexure.measured.measured_report import fit_data
from tensegym.flexure.models.joint import MODELS, Joint
from tensegym.flexure.models.joint_file import joint_to_dict, save_joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.report import Report, table

from .hinge_options import BoxOptions, HingeOptions, refuse_unused


@dataclass(frozen=True)
class Fit:
    """Fit every joint model to a hinge's FEM states, certify the potential, and write them as one small JSON file.

    With --data one model is fitted to an experiment instead; HINGE then gives L, the arm, the symmetry and the loads to
    expect.
    """

    out: Path
    """JSON file to write."""
    hinge: tyro.conf.Positional[str] = ""
    """A preset (x-hinge, leaf-spring, trls2, tfch, cross-spring, parallel-guide, tapered-leaf, notch-hinge), or a TOML
    file."""
    data: Path | None = None
    """CSV of an experiment: angle_deg, x_mm, y_mm and force_N (at the arm's end, across the undeformed arm), or
    Fx_N and Fy_N there, or torque_Nmm. Without HINGE, --length-mm (40) and --arm-mm (120) tell the lengths."""
    model: Literal["potential", "planar", "torsion"] | None = None
    """What to fit to --data; the potential without. Angles and torques alone give torsion."""
    options: HingeOptions = field(default_factory=HingeOptions)
    box: BoxOptions = field(default_factory=BoxOptions)
    states: Annotated[int, Within(1, 100_000)] = 600
    """FEM states to fit."""
    held_out: Annotated[int, Within(0, 100_000)] = 300
    """Random wrenches to judge the models on."""
    seed: Seed = 0
    """Of the fitted states."""
    elements: Annotated[int, Within(1, 1000)] = 16
    """Beam elements a leaf of length L."""

    def run(self) -> Report:
        check_file(self.out)
        if self.data is not None:
            return self._fit_data(self.data)
        if not self.hinge:
            raise InputError("give a HINGE to fit to its FEM, or --data FILE.csv to fit to an experiment")
        refuse_unused(["model"] * (self.model is not None), "without --data: every model is fitted to a hinge's FEM")
        hinge = self.options.apply(self.hinge)
        began = time.perf_counter()
        joint = fit_joint(hinge, **self.box.ranges(), count=self.states, held_out=self.held_out, seed=self.seed,
                          elements=self.elements)  # fmt: skip
        seconds = time.perf_counter() - began
        save_joint(joint, self.out)
        text = f"{describe(joint)}\nfitted in {seconds:.2f} s; written to {self.out}"
        data = {
            "out": str(self.out),
            "seconds": seconds,
            "certificate": asdict(joint.certificate()),
            **joint_to_dict(joint),
        }
        return Report(text, data)

    def _fit_data(self, path: Path) -> Report:
        model = self.model or "potential"
        refuse_unused(self.box.given(), "with --data, whose own range is fitted")
        if self.hinge:
            hinge = self.options.apply(self.hinge)
            return fit_data(path, self.out, hinge.length, model, arm_length=hinge.arm, hinge=hinge)
        refuse_unused([name for name in self.options.given() if name not in ("length_mm", "arm_mm")],
                      "with --data and without HINGE")  # fmt: skip
        length = PAPER_LENGTH if self.options.length_mm is None else MM * self.options.length_mm
        arm = ARM_LENGTH if self.options.arm_mm is None else MM * self.options.arm_mm
        return fit_data(path, self.out, length, model, arm_length=arm)


def error_rows(joint: Joint) -> list[list[Any]]:
    """Rows of a table of the joint's errors."""
    return [[MODELS[name], f"{1e6 * e.tip_rms:.3g}", f"{1e6 * e.tip_max:.3g}", f"{100 * e.moment_rms:.3g}",
             f"{100 * e.moment_max:.3g}", e.lost] for name, e in joint.errors.items()]  # fmt: skip


ERROR_HEADER = ["model", "tip RMS um", "tip max um", "torque RMS %", "torque max %", "lost"]


def describe(joint: Joint) -> str:
    """The joint as text: source, box, certificate, errors, notes."""
    box = joint.box
    force = f"|Fx| and |Fy| at the tip <= {box.max_force:.4g} N" if box.symmetric else f"at the tip {box.told()}"
    lines = [joint.source, f"valid for |theta| <= {math.degrees(box.max_angle):.4g} deg, {force}"]
    if "potential" in joint.models:
        proof = joint.certificate()
        lines.append(f"potential certified there: of their values at rest, K >= {proof.transverse:.3g}, C >= "
                     f"{proof.axial:.3g}, su >= {proof.rotational:.3g}, K - 2 g n >= {proof.buckling:.3g}")  # fmt: skip
    if joint.errors:
        lines += [f"errors: {joint.errors_of}", table(ERROR_HEADER, error_rows(joint))]
    return "\n".join([*lines, *(f"note: {note}" for note in joint.notes)])
