"""Figures of hinges and of what the models say about them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tensegym import plotting
from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.fem.arm_sweep import arm_sweep
from tensegym.flexure.fem.sampling import default_box
from tensegym.flexure.hinge import GROUND, Hinge, States
from tensegym.flexure.models.joint import MODELS, Joint
from tensegym.flexure.models.model_error import tip_errors
from tensegym.flexure.models.planar_spring import PlanarSpring
from tensegym.flexure.models.pseudo_rigid import planar_placement, spring_track
from tensegym.flexure.models.stiffness_diagram import StiffnessDiagram, invert
from tensegym.plotting import new_figure, save

COLOURS = dict(zip(("potential", "planar", "paper", "torsion"), plotting.COLOURS[1:], strict=False))
BLUE, RED, GREEN = plotting.COLOURS[:3]
STYLES = {"potential": "-", "planar": "-.", "paper": ":", "torsion": "--"}
WIDTHS = {"potential": 3.0, "planar": 2.2, "paper": 1.8, "torsion": 1.3}  # lines that coincide show inside one another


def _panels(count: int, width: float = 5.0, height: float = 3.8) -> tuple[Any, list[Any]]:
    """A figure and ``count`` axes in two columns."""
    columns = min(count, 2)
    rows = -(-count // columns)
    figure, axes = new_figure(rows, columns, size=(width * columns, height * rows), squeeze=False)
    for spare in axes.flat[count:]:
        spare.axis("off")
    return figure, list(axes.flat[:count])


def _rows(count: int, height: float) -> tuple[Any, Any]:
    """A figure and (count, 2) axes, a row a hinge."""
    return new_figure(count, 2, size=(10, height * count), squeeze=False)


def _load_of(hinge: Hinge) -> str:
    """What a title adds where the sweep is not that of the paper's stand."""
    return "" if hinge.arm else ", pure moment"


def _draw_shape(axis: Any, hinge: Hinge, nodes: FloatArray, colour: str, alpha: float = 1.0) -> None:
    """One shape of the hinge from its nodes (k, 3), [mm] on the axes: leaves, bodies as the lines that join them."""
    first = 0
    points: dict[str, list[FloatArray]] = {body: [] for body in hinge.bodies}
    for leaf, (_, _, count, _) in zip(hinge.leaves, fem.mesh_of(hinge).ends, strict=True):
        line = 1e3 * nodes[first : first + count + 1, :2]
        first += count + 1
        axis.plot(line[:, 0], line[:, 1], color=colour, alpha=alpha, lw=1.5)
        points[leaf.start_body].append(line[0])
        points[leaf.end_body].append(line[-1])
    for body, ends in points.items():
        places = np.array(ends)
        shade = "black" if body == GROUND else colour
        axis.plot(places[:, 0], places[:, 1], color=shade, lw=5, alpha=0.45 * alpha, solid_capstyle="round")
        axis.plot(places[:, 0], places[:, 1], "s", ms=3.5, color=shade, alpha=alpha)


def draw_hinges(hinges: Sequence[Hinge], path: Path, share: float = 0.8) -> None:
    """Every hinge at rest and at +-``share`` of its range: a force across its arm, or at the tip when it has no arm."""
    figure, axes = _panels(len(hinges))
    for axis, hinge in zip(axes, hinges, strict=True):
        rest = fem.apply_wrench(hinge, np.zeros(3), keep_nodes=True)
        _draw_shape(axis, hinge, rest.nodes[0], "0.35")
        for sign, colour in ((1, BLUE), (-1, RED)):
            if hinge.arm:
                steps = sign * share * hinge.max_angle * np.arange(1, 11) / 10
                solution = fem.rotate(hinge, steps, direction=fem.arm_direction(steps, hinge.arm), keep_nodes=True)
                what = f"$\\pm${np.degrees(share * hinge.max_angle):.3g} deg"
            else:
                force = share * default_box(hinge).max_force
                solution = fem.apply_wrench(hinge, [0.0, sign * force, 0.0], keep_nodes=True)
                what = f"$\\pm${force:.3g} N along y"
            if solution.status[-1] != fem.CONVERGED:
                raise FlexureError(f"{hinge.name}: {solution.reason(-1)}; lower max_angle")
            _draw_shape(axis, hinge, solution.nodes[-1], colour)
            tip, turn = solution.tip[-1], solution.theta[-1]
            end = tip + min(hinge.arm, 0.5 * hinge.length) * np.array([np.cos(turn), np.sin(turn)])
            axis.plot(*(1e3 * np.array([tip, end])).T, color=colour, lw=3, alpha=0.3)
        axis.set(title=f"{hinge.name}: at rest and at {what}", xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    figure.suptitle("Black: ground; grey: at rest; pale bars: rigid bodies and the arm's beginning", fontsize=9)
    save(figure, path)


def draw_torque(joints: dict[str, Joint], path: Path, measured: dict[str, States] | None = None) -> None:
    """Torque about the tip against angle under a force across the arm, every hinge (the paper's Fig. 5), and what each
    model misses of the FEM's."""
    figure, axes = _rows(len(joints), 3.3)
    for (left, right), (name, joint) in zip(axes, joints.items(), strict=True):
        assert joint.hinge is not None
        sweep = arm_sweep(joint.hinge, joint.box.max_angle)
        sweep = sweep.pick(joint.box.holds(sweep.force))
        angle = np.degrees(sweep.theta)
        left.plot(angle, 1e3 * sweep.moment, color="0.75", lw=7, label="FEM")
        for key, model in joint.models.items():
            moment = model.poses(sweep.theta, sweep.force).moment
            look = {"ls": STYLES[key], "color": COLOURS[key], "lw": WIDTHS[key], "label": MODELS[key]}
            left.plot(angle, 1e3 * moment, **look)
            right.plot(angle, 1e3 * (moment - sweep.moment), **look)
        if measured and name in measured:
            points = measured[name]
            left.plot(np.degrees(points.theta), 1e3 * points.moment, "o", ms=4, mfc="none", color=BLUE,
                      label="measured")  # fmt: skip
        title = f"{name} ({joint.hinge.material.modulus_name}){_load_of(joint.hinge)}"
        left.set(title=title, xlabel=r"angle $\theta$ [deg]", ylabel="moment about the tip [N mm]")
        right.set(title="model less FEM", xlabel=r"angle $\theta$ [deg]", ylabel="moment [N mm]")
        left.legend(fontsize=7)
    save(figure, path)


def draw_drift(joints: dict[str, Joint], path: Path) -> None:
    """Drift of the axis: the planar spring's displacement on the arm's sweep, placed by either reading of F2."""
    figure, axes = _panels(len(joints))
    for axis, (name, joint) in zip(axes, joints.items(), strict=True):
        assert joint.hinge is not None
        sweep = arm_sweep(joint.hinge, joint.box.max_angle)
        for reading, label, colour in (("dx", "dx alone (Table 1)", BLUE), ("F2", "F2 as printed", RED)):
            place = planar_placement(sweep, joint.length, reading)
            x, y = 1e3 * spring_track(sweep, joint.length, place.b).T
            for values, style, part in ((x, "-", "x"), (y, "--", "y")):
                name_ = f"{part}, {label}: b = {place.b:.3f}"
                axis.plot(np.degrees(sweep.theta), values, style, color=colour, label=name_)
        axis.set(title=name + _load_of(joint.hinge), xlabel=r"angle $\theta$ [deg]", ylabel="drift of the axis [mm]")
        axis.legend(fontsize=7)
    save(figure, path)


def draw_stiffness(joints: dict[str, Joint], path: Path) -> None:
    """The paper's stiffness diagrams on the arm's sweep, gaps where singular, beside the constant-k spring."""
    joints = {name: joint for name, joint in joints.items() if "paper" in joint.models}
    if not joints:
        raise FlexureError("no joint here has stiffness diagrams; the inversion is singular on their paths")
    figure, axes = _rows(len(joints), 3.1)
    for (left, right), (name, joint) in zip(axes, joints.items(), strict=True):
        diagram, planar = joint.models["paper"], joint.models.get("planar")
        assert isinstance(diagram, StiffnessDiagram) and joint.hinge is not None
        sweep = arm_sweep(joint.hinge, joint.box.max_angle)
        k, _ = invert(sweep, joint.length, diagram.b)
        angle = np.degrees(sweep.theta)
        left.plot(angle, 1e-3 * k[:, 0], color=BLUE, label="kx")
        left.plot(angle, 1e-3 * k[:, 1], "--", color=RED, label="ky")
        right.plot(angle, k[:, 2], color=GREEN, label="kz, inverted")
        title = f"{name}{_load_of(joint.hinge)}, b = {diagram.b:.3f}"
        if isinstance(planar, PlanarSpring):
            title += f"; constant k over the box: kx {1e-3 * planar.kx:.3g}, ky {1e-3 * planar.ky:.3g} N/mm"
            right.axhline(planar.kz, color="black", lw=1, ls=":", label="kz, constant k")
        left.set(title=title, xlabel=r"angle $\theta$ [deg]", ylabel="kx, ky [N/mm]")
        left.title.set_fontsize(9)
        right.set(xlabel=r"angle $\theta$ [deg]", ylabel="kz [N m/rad]")
        for axis in (left, right):
            axis.legend(fontsize=8)
    save(figure, path)


def draw_errors(joints: dict[str, Joint], tests: dict[str, States], path: Path) -> None:
    """Histogram of the tip error of every model over states held out, on a logarithmic axis."""
    figure, axes = _panels(len(joints))
    for axis, (name, joint) in zip(axes, joints.items(), strict=True):
        for key, model in joint.models.items():
            error = 1e3 * tip_errors(model, tests[name])[0]
            error = error[np.isfinite(error) & (error > 0)]
            bins = np.logspace(-6, 2, 65)
            axis.hist(error, bins=bins, color=COLOURS[key], alpha=0.5, label=MODELS[key])
        axis.set(title=f"{name}: {len(tests[name])} states held out", xlabel="tip error [mm]", ylabel="states")
        axis.set_xscale("log")
    axes[0].legend(fontsize=8)
    save(figure, path)
