"""The picture of `tensegym flexure guide`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tensegym.flexure.fem.travel import Travel
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.models.guide_comparison import Column
from tensegym.plotting import COLOURS, MARKERS, new_figure, save, thin_legend


def draw_guide(hinge: Hinge, reference: Travel, columns: list[Column], errors: dict[str, dict[str, float]],
               out: Path) -> None:  # fmt: skip
    """Both stiffnesses along the travel, and every model's error against its run time."""
    figure, (left, middle, right) = new_figure(1, 3, size=(13, 4))
    travel = 1e3 * reference.states.tip[:, 1]
    looks = list(zip(columns, COLOURS, MARKERS, strict=False))
    for axis, exact, own, title, what in (
        (left, reference.drive_stiffness, "across", "along the travel", "stiffness across the leaves [N/mm]"),
        (middle, reference.support_stiffness(0), "along", "the travel held", "stiffness along the leaves [N/mm]"),
    ):
        axis.plot(travel, exact / 1e3, color="0.7", lw=5, label="FEM")
        for column, colour, marker in looks:
            values = getattr(column, own)
            if values is not None and np.isfinite(values).all() and not column.name.startswith("FEM"):
                axis.plot(travel, values / 1e3, color=colour, marker=marker, markevery=10, ms=6, label=column.name)
        axis.set(title=title, xlabel="travel y [mm]", ylabel=what)
        thin_legend(axis)
    for column, colour, marker in looks:
        error = 100 * errors[column.name]["y"]
        if np.isfinite(error):
            right.plot(1e6 * column.seconds, error, marker, ms=8, color=colour, label=column.name)
    right.set(title=f"error against run time, {len(travel)} poses", xlabel="run time [µs]",
              ylabel="largest miss of y [% of the travel]", xscale="log", yscale="log")  # fmt: skip
    thin_legend(right)
    figure.suptitle(hinge.describe(), fontsize=9)
    save(figure, out)
