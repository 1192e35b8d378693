"""The picture of `tensegym flexure travel`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tensegym.flexure.fem.travel import TURN, Travel, Y
from tensegym.flexure.hinge import Hinge
from tensegym.plotting import COLOURS, new_figure, save


def draw_travel(path: Travel, hinge: Hinge, heading: str, out: Path) -> None:
    """Stiffness in plane and out of it as shares of those at rest, stress, and the share of the buckling load."""
    figure, axes = new_figure(2, 2, size=(10, 7))
    angle = path.driven == TURN
    way = np.degrees(path.states.theta) if angle else 1e3 * path.states.tip[:, 1]
    label = r"turn $\theta$ [deg]" if angle else "travel y [mm]"
    names = {0: ("x", "N/m"), Y: ("y", "N/m"), TURN: ("turn", "N m/rad")}
    inside = {path.driven: path.drive_stiffness}
    inside |= {i: path.support_stiffness(i) for i in range(3) if i != path.driven}
    free = path.out_of_plane_free()
    outside = zip((("z", "N/m"), ("about x", "N m/rad"), ("about y", "N m/rad")), free.T, strict=True)
    for axis, title, curves in (
        (axes[0, 0], "stiffness in plane, of that at rest", [(names[i], values) for i, values in inside.items()]),
        (axes[0, 1], "out of plane (approximation), of that at rest", list(outside)),
    ):
        for ((name, unit), values), colour, style in zip(curves, COLOURS, ("-", "--", ":"), strict=False):
            axis.plot(way, values / values[0], style, color=colour, label=f"{name}: {values[0]:.4g} {unit} at rest")
        shares = np.abs([values / values[0] for _, values in curves])
        axis.set(title=title, xlabel=label, yscale="log" if np.max(shares) > 10 * np.min(shares) else "linear")
        axis.legend(fontsize=8)
    axes[1, 0].plot(way, [stress.size / 1e6 for stress in path.stress], color=COLOURS[0])
    axes[1, 0].set(title="largest stress of the extreme fibre (nominal)", xlabel=label, ylabel="[MPa]")
    axes[1, 1].plot(way, 100 / path.load_factor, color=COLOURS[1])
    axes[1, 1].set(title="load, of that which buckles the state", xlabel=label, ylabel="[%]")
    axes[1, 1].set_ylim(0, max(1.0, 110 / path.load_factor.min()))
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.suptitle(f"{hinge.name}: {heading}", fontsize=10)
    save(figure, out)
