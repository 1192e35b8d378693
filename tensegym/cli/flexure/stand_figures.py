"""The paper's Fig. 5 from the stand in PyBullet, and the arm's free vibration."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from tensegym.flexible.stand import ARM, Pull, Vibration
from tensegym.flexure.hinge import States
from tensegym.flexure.models.joint import Joint
from tensegym.plotting import COLOURS, new_figure, save, thin_legend


def draw_figure_5(name: str, fem: States, stand: Pull, measured: States, fitted: Joint | None, path: Path) -> None:
    """Torque against angle by FEM, the joint in PyBullet and the virtual measurement, with what each misses of the FEM,
    and the tip's path."""
    figure, (left, middle, right) = new_figure(1, 3, size=(14, 4.2))
    theta = stand.poses[:, 2]
    pale = {"color": "black", "lw": 2.5, "alpha": 0.35, "label": "FEM"}
    left.plot(np.degrees(fem.theta), 1e3 * fem.moment, **pale)
    series = [("o", COLOURS[1], "joint in PyBullet", theta, stand.moment()),
              ("x", COLOURS[0], "virtual measurement", measured.theta, measured.moment)]  # fmt: skip
    if fitted is not None:
        model = next(iter(fitted.models.values()))
        again = model.poses(measured.theta, measured.force)
        series.append(("--", COLOURS[2], "fit to the measurement", measured.theta, again.moment))
    for style, colour, label, angle, moment in series:
        gap = moment - CubicSpline(fem.theta, fem.moment)(angle)
        left.plot(np.degrees(angle), 1e3 * moment, style, ms=5, mfc="none", color=colour, label=label)
        middle.plot(np.degrees(angle), 1e3 * gap, style, ms=5, mfc="none", color=colour, label=label)
    right.plot(1e3 * fem.tip[:, 0], 1e3 * fem.tip[:, 1], **pale)
    right.plot(*(1e3 * stand.poses[:, :2].T), "o", ms=5, mfc="none", color=COLOURS[1], label="joint in PyBullet")
    right.plot(*(1e3 * measured.tip.T), "x", ms=5, color=COLOURS[0], label="virtual measurement")
    left.set(title=f"{name}, arm {1e3 * ARM:g} mm", xlabel=r"angle $\theta$ [deg]", ylabel="moment about tip [N mm]")
    middle.set(title="less FEM at the same angle", xlabel=r"angle $\theta$ [deg]", ylabel="moment [N mm]")
    right.set(title="path of the tip", xlabel="x [mm]", ylabel="y [mm]")
    for axis in (left, middle, right):
        thin_legend(axis)
    save(figure, path)


def draw_vibration(name: str, run: Vibration, path: Path) -> None:
    """Angle and energy after the arm is let go."""
    figure, (left, right) = new_figure(1, 2, size=(10, 3.6))
    left.plot(run.time, np.degrees(run.theta), color=COLOURS[0])
    left.set(title=f"{name}: {run.frequency:.4g} Hz", xlabel="time [s]", ylabel=r"angle $\theta$ [deg]")
    right.plot(run.time, 1e3 * run.energy, color=COLOURS[0])
    right.set(title="kinetic and elastic", xlabel="time [s]", ylabel="energy [mJ]", ylim=(0, 1.2e3 * run.energy.max()))
    save(figure, path)
