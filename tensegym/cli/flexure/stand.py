"""`tensegym flexure stand`: the paper's test stand in PyBullet, measured as the paper measures its own."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro
from scipy.interpolate import CubicSpline

from tensegym.cli.options import Within
from tensegym.errors import FlexureError, InputError
from tensegym.files import replace_file
from tensegym.flexible.stand import ARM, LENGTH, Pull, Vibration, pull, release
from tensegym.flexure.fem.arm_sweep import arm_sweep
from tensegym.flexure.hinge import States, symmetry_of
from tensegym.flexure.measured.base_frame import frame_at_rest
from tensegym.flexure.measured.measured_file import read_measured
from tensegym.flexure.measured.measured_fit import fit_measured
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.plotting import require_matplotlib, save_pixels
from tensegym.report import Report, table

from .hinge_options import BoxOptions, HingeOptions, refuse_unused
from .stand_figures import draw_figure_5, draw_vibration
from .track import sight_file


@dataclass(frozen=True)
class Stand:
    """Pull the arm of the stand through the range, photograph it, track the pictures, fit, and draw the paper's Fig. 5;
    then let the arm go.

    The joint in PyBullet is the potential fitted to the hinge's FEM. The virtual measurement knows only the pictures
    and the dynamometer's readings.
    """

    hinge: tyro.conf.Positional[str]
    """A preset (x-hinge, leaf-spring, trls2, tfch, cross-spring) of 40 mm, or a TOML file."""
    out: Path
    """Folder for measured.csv, stand.csv, fig5.png, vibration.png, vibration.csv and pictures/; made if missing."""
    points: Annotated[int, Within(3, 10_000)] = 31
    """States pulled to, over +-98 % of the fitted range."""
    width: Annotated[int, Within(200, 2000, "px")] = 640
    """Pixels across a picture."""
    release_deg: Annotated[float, Within(0.0, 90.0, "deg")] = 20.0
    """Where the arm is let go."""
    seconds: Annotated[float, Within(0.001, 1000.0, "s")] = 3.0
    """How long the vibration is followed."""
    loss_time_ms: Annotated[float, Within(0.0, 1000.0, "ms")] = 0.0
    """Structural damping of the vibration: B = loss time x K."""
    dt_ms: Annotated[float, Within(0.001, 4.0, "ms")] = 1.0
    """Time step."""
    options: HingeOptions = field(default_factory=HingeOptions)
    box: BoxOptions = field(default_factory=BoxOptions)

    def run(self) -> Report:
        if not self.out.parent.is_dir():
            raise FileNotFoundError(f"no folder {self.out.parent} to make {self.out.name} in")
        require_matplotlib()
        refuse_unused([name for name in self.box.given() if name in ("force_x_N", "force_y_N")],
                      "on the stand, which pulls both ways")  # fmt: skip
        hinge = self.options.apply(self.hinge)
        if abs(hinge.arm - ARM) > 1e-9:
            raise InputError(f"arm = {1e3 * hinge.arm:g} mm: the arm of the stand in PyBullet is {1e3 * ARM:g} mm")
        joint = fit_joint(hinge, max_angle=self.box.max_angle, max_force=self.box.max_force_N, held_out=0)
        if not 0 < math.radians(self.release_deg) <= joint.box.max_angle:
            limit = math.degrees(joint.box.max_angle)
            raise InputError(f"release_deg = {self.release_deg:g} is outside (0, {limit:.4g}], the fitted range")
        dt = 1e-3 * self.dt_ms
        pulled = pull(joint, self.points, picture=(self.width, round(0.75 * self.width)), dt=dt)
        swing = release(joint, math.radians(self.release_deg), self.seconds, dt=dt, loss_time=1e-3 * self.loss_time_ms)
        (self.out / "pictures").mkdir(parents=True, exist_ok=True)
        measured = self._measure(pulled)
        fitted, note = self._fit(measured, hinge)
        fem = arm_sweep(hinge, joint.box.max_angle)
        draw_figure_5(hinge.name, fem, pulled, measured, fitted, self.out / "fig5.png")
        draw_vibration(hinge.name, swing, self.out / "vibration.png")
        self._write("stand.csv", ["theta_rad", "x_mm", "y_mm", "force_N"],
                    np.column_stack([pulled.poses[:, 2], 1e3 * pulled.poses[:, :2], pulled.force]))  # fmt: skip
        self._write("vibration.csv", ["t_s", "theta_rad", "energy_mJ"],
                    np.column_stack([swing.time, swing.theta, 1e3 * swing.energy]))  # fmt: skip
        return self._report(joint, pulled, measured, fem, swing, fitted, note)

    def _measure(self, pulled: Pull) -> States:
        """Write the pictures, track them, write measured.csv and read it back."""
        assert pulled.rest is not None
        folder = self.out / "pictures"
        save_pixels(pulled.rest, folder / "rest.png")
        frame = frame_at_rest(sight_file(folder / "rest.png"), ARM, LENGTH)
        rows = []
        for k, picture in enumerate(pulled.pictures):
            path = folder / f"{k:03d}.png"
            save_pixels(picture, path)
            theta, tip = frame.pose(sight_file(path), ARM)
            rows.append([path.name, math.degrees(theta), *(1e3 * tip), pulled.force[k]])
        self._write("measured.csv", ["image", "angle_deg", "x_mm", "y_mm", "force_N"], rows)
        return read_measured(self.out / "measured.csv", ARM)

    def _fit(self, measured: States, hinge: Any) -> tuple[Joint | None, str]:
        """The richest model the measurement carries, and why not a richer one."""
        notes = []
        for model in ("potential", "planar", "torsion"):
            try:
                fit = fit_measured(measured, hinge.length, model, symmetry=symmetry_of(hinge))
            except FlexureError as error:
                notes.append(f"no {model}: {error}")
                continue
            open_ = ", ".join(c.name for c in fit.unidentified)
            return fit.joint, "; ".join([*notes, f"fitted: {model}" + (f", not identified: {open_}" if open_ else "")])
        return None, "; ".join(notes)

    def _write(self, name: str, header: list[str], rows: Any) -> None:
        with replace_file(self.out / name) as file:
            writer = csv.writer(file)
            writer.writerow(header)
            writer.writerows([[v if isinstance(v, str) else f"{v:.9g}" for v in row] for row in rows])

    def _report(self, joint: Joint, pulled: Pull, measured: States, fem: States, swing: Vibration,
                fitted: Joint | None, note: str) -> Report:  # fmt: skip
        theta, scale = pulled.poses[:, 2], float(np.abs(fem.moment).max())
        rows = {
            "joint in PyBullet": _gaps(fem, theta, pulled.poses[:, :2], pulled.moment(), scale),
            "virtual measurement": _gaps(fem, measured.theta, measured.tip, measured.moment, scale),
        }
        if fitted is not None:
            again = next(iter(fitted.models.values())).poses(measured.theta, measured.force)
            rows["fit to the measurement"] = _gaps(fem, measured.theta, again.tip, again.moment, scale)
        camera = {"angle_deg": float(np.degrees(np.abs(measured.theta - theta).max())),
                  "tip_mm": float(1e3 * np.abs(measured.tip - pulled.poses[:, :2]).max())}  # fmt: skip
        growth = float(swing.energy.max() / swing.energy[0])
        tables = ("measured.csv", "stand.csv", "vibration.csv")
        text = [joint.source, f"{len(theta)} states, {np.degrees(theta[0]):.4g} to {np.degrees(theta[-1]):.4g} deg",
                table(["less FEM at the same angle", "tip max um", "torque max %"],
                      [[name, f"{1e6 * gap[0]:.3g}", f"{100 * gap[1]:.3g}"] for name, gap in rows.items()]),
                f"camera less joint: angle {camera['angle_deg']:.2g} deg, tip {camera['tip_mm']:.2g} mm at most",
                note,
                f"let go at {self.release_deg:g} deg: {swing.frequency:.5g} Hz, logarithmic decrement "
                f"{swing.decrement:.3g}, energy at most {growth:.6f} of the start's",
                f"in {self.out}: fig5.png, vibration.png, {', '.join(tables)}, pictures/"]  # fmt: skip
        data = {"out": str(self.out), "source": joint.source, "states": len(theta),
                "less_fem": {name: {"tip_m": gap[0], "torque_share": gap[1]} for name, gap in rows.items()},
                "camera": camera, "fit": note, "frequency_Hz": _number(swing.frequency),
                "decrement": _number(swing.decrement),
                "energy_max_share": growth}  # fmt: skip
        return Report("\n".join(text), data)


def _gaps(fem: States, theta: Any, tip: Any, moment: Any, scale: float) -> tuple[float, float]:
    """Largest miss of the tip [m] and of the torque [share of the sweep's largest] against the FEM at the angles."""
    exact = CubicSpline(fem.theta, np.column_stack([fem.tip, fem.moment]))(theta)
    miss = np.hypot(*(tip - exact[:, :2]).T)
    return float(miss.max()), float(np.abs(moment - exact[:, 2]).max() / scale)


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
