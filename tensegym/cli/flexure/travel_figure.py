"""The picture of `tensegym flexure travel`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tensegym.flexure.fem.travel import TURN, Travel, Y
from tensegym.flexure.hinge import Hinge
from tensegym.plotting import COLOURS, MARKERS, new_figure, save, thin_legend


def draw_travel(path: Travel, hinge: Hinge, heading: str, out: Path) -> None:
    """Stiffness in plane and out of it as shares of those at rest, stress, and the share of the buckling load."""
    figure, axes = new_figure(2, 2, size=(10, 7))
    angle = path.driven == TURN
    way = np.degrees(path.states.theta) if angle else 1e3 * path.states.tip[:, 1]
    label = r"turn $\theta$ [deg]" if angle else "travel y [mm]"
    names = {0: ("x", 1e-3, "N/mm"), Y: ("y", 1e-3, "N/mm"), TURN: ("turn", 1.0, "N m/rad")}
    inside = {path.driven: path.drive_stiffness}
    inside |= {i: path.support_stiffness(i) for i in range(3) if i != path.driven}
    free = path.out_of_plane_free()
    outside = zip((("z", 1e-3, "N/mm"), ("about x", 1.0, "N m/rad"), ("about y", 1.0, "N m/rad")), free.T, strict=True)
    for axis, title, curves in (
        (axes[0, 0], "stiffness in plane", [(names[i], values) for i, values in inside.items()]),
        (axes[0, 1], "stiffness out of plane (approximation)", list(outside)),
    ):
        looks = zip(COLOURS, ("-", "--", ":"), MARKERS, (3.0, 2.0, 2.0), strict=False)  # curves may coincide
        for ((name, scale, unit), values), (colour, style, marker, width) in zip(curves, looks, strict=False):
            axis.plot(way, values / values[0], style, color=colour, lw=width, marker=marker, ms=5,
                      label=f"{name}: {scale * values[0]:.4g} {unit} at rest")  # fmt: skip
        shares = np.abs([values / values[0] for _, values in curves])
        scaling = "log" if np.max(shares) > 10 * np.min(shares) else "linear"
        axis.set(title=title, xlabel=label, ylabel="stiffness over that at rest", yscale=scaling)
        thin_legend(axis)
    axes[1, 0].plot(way, [stress.size / 1e6 for stress in path.stress], "o-", ms=5, color=COLOURS[0])
    axes[1, 0].set(title="extreme fibre", xlabel=label, ylabel="largest nominal stress [MPa]")
    axes[1, 1].plot(way, 100 / path.load_factor, "o-", ms=5, color=COLOURS[1])
    axes[1, 1].set(title="how near to buckling", xlabel=label, ylabel="load over that which buckles [%]")
    axes[1, 1].set_ylim(0, max(1.0, 110 / path.load_factor.min()))
    figure.suptitle(f"{hinge.name}: {heading}", fontsize=10)
    save(figure, out)
