"""The picture of `tensegym flexure guide`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tensegym.flexure.fem.travel import Travel
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.models.guide_comparison import Column
from tensegym.plotting import COLOURS, new_figure, save


def draw_guide(hinge: Hinge, reference: Travel, columns: list[Column], errors: dict[str, dict[str, float]],
               out: Path) -> None:  # fmt: skip
    """Both stiffnesses along the travel, and every model's error against its run time."""
    figure, (left, middle, right) = new_figure(1, 3, size=(13, 4))
    travel = 1e3 * reference.states.tip[:, 1]
    for axis, exact, own, title in (
        (left, reference.drive_stiffness, "across", "stiffness across, along the travel"),
        (middle, reference.support_stiffness(0), "along", "stiffness along, the travel held"),
    ):
        axis.plot(travel, exact / 1e3, color="black", lw=3, alpha=0.4, label="FEM")
        for column, colour in zip(columns, COLOURS, strict=False):
            values = getattr(column, own)
            if values is not None and np.isfinite(values).all() and not column.name.startswith("FEM"):
                axis.plot(travel, values / 1e3, "--", color=colour, label=column.name)
        axis.set(title=title, xlabel="travel y [mm]", ylabel="[N/mm]")
        axis.legend(fontsize=8)
    for column, colour in zip(columns, COLOURS, strict=False):
        error = 100 * errors[column.name]["y"]
        if np.isfinite(error):
            right.plot(1e6 * column.seconds, error, "o", color=colour, label=column.name)
    right.set(title=f"error against run time, {len(travel)} poses", xlabel="run time [us]",
              ylabel="largest miss of y [% of the travel]", xscale="log", yscale="log")  # fmt: skip
    right.legend(fontsize=8)
    for axis in (left, middle, right):
        axis.grid(alpha=0.3)
    figure.suptitle(hinge.describe(), fontsize=9)
    save(figure, out)
