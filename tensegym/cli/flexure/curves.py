"""`tensegym flexure curves`: figures and one CSV of what hinges and their models do."""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.errors import InputError
from tensegym.files import replace_file
from tensegym.flexure.fem.arm_sweep import arm_sweep
from tensegym.flexure.fem.sampling import held_out_states
from tensegym.flexure.hinge import PAPER_HINGES, Hinge, States
from tensegym.flexure.measured.measured_file import read_measured
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.plotting import require_matplotlib
from tensegym.report import Report, table

from . import figures
from .hinge_options import BoxOptions, HingeOptions


@dataclass(frozen=True)
class Curves:
    """Draw torque against angle by FEM, every model and measured points, the axis drift, and the stiffness diagrams."""

    out: Path
    """Folder for hinges.png, torque.png, drift.png, stiffness.png, errors.png and curves.csv; made if missing."""
    hinges: tuple[str, ...] = PAPER_HINGES
    """Presets or TOML files."""
    data: tuple[str, ...] = ()
    """Measured points, each as HINGE=FILE.csv, with the columns that `fit --data` reads."""
    options: HingeOptions = field(default_factory=HingeOptions)
    box: BoxOptions = field(default_factory=BoxOptions)

    def run(self) -> Report:
        if not self.out.parent.is_dir():
            raise FileNotFoundError(f"no folder {self.out.parent} to make {self.out.name} in")
        require_matplotlib()
        hinges = {name: self.options.apply(name) for name in self.hinges}
        measured = self._measured(hinges)
        joints = {name: fit_joint(h, **self.box.ranges()) for name, h in hinges.items()}
        tests = {name: held_out_states(joint.hinge, joint.box) for name, joint in joints.items() if joint.hinge}
        self.out.mkdir(exist_ok=True)
        figures.draw_hinges([joint.hinge for joint in joints.values() if joint.hinge], self.out / "hinges.png")
        figures.draw_torque(joints, self.out / "torque.png", measured)
        figures.draw_drift(joints, self.out / "drift.png")
        made = ["hinges.png", "torque.png", "drift.png", "errors.png", "curves.csv"]
        if any("paper" in joint.models for joint in joints.values()):
            figures.draw_stiffness(joints, self.out / "stiffness.png")
            made.append("stiffness.png")
        figures.draw_errors(joints, tests, self.out / "errors.png")
        count = write_curves(joints, self.out / "curves.csv")
        text = "\n".join(joint.source for joint in joints.values())
        text += "\n" + table(["file"], [[str(self.out / name)] for name in made])
        data: dict[str, Any] = {"files": [str(self.out / name) for name in made], "rows": count,
                                "sources": {name: joint.source for name, joint in joints.items()}}  # fmt: skip
        return Report(text, data)

    def _measured(self, hinges: dict[str, Hinge]) -> dict[str, States]:
        out = {}
        for item in self.data:
            name, _, file = item.partition("=")
            if not file or name not in self.hinges:
                raise InputError(f"data {item!r}; give HINGE=FILE.csv with a hinge among {', '.join(self.hinges)}")
            out[name] = read_measured(Path(file), hinges[name].arm)
        return out


def write_curves(joints: dict[str, Joint], path: Path) -> int:
    """The arm's sweep of every hinge, FEM and models, one row an angle; returns the rows."""
    rows = []
    for name, joint in joints.items():
        assert joint.hinge is not None
        sweep = arm_sweep(joint.hinge, joint.box.max_angle)
        sweep = sweep.pick(joint.box.holds(sweep.force))
        answers = {key: model.poses(sweep.theta, sweep.force) for key, model in joint.models.items()}
        for key, states in {"fem": sweep, **answers}.items():
            for i in range(len(states)):
                values = [np.degrees(states.theta[i]), *(1e3 * states.tip[i]), *states.force[i], 1e3 * states.moment[i]]
                rows.append([name, key, *(f"{v:.10g}" if np.isfinite(v) else "" for v in values)])
    with replace_file(path) as file:
        writer = csv.writer(file)
        writer.writerow(["hinge", "model", "theta_deg", "x_mm", "y_mm", "Fx_N", "Fy_N", "Mz_Nmm"])
        writer.writerows(rows)
    return len(rows)
