"""Learning curves as a picture."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

from tensegym.plotting import new_figure, save


def draw_curve(runs: Mapping[str, Path], out: Path) -> None:
    """One line a run: median speed of the training episodes against environment steps; slip share below it."""
    figure, (top, bottom) = new_figure(2, size=(7, 6), layout="tight", sharex=True)
    for name, path in runs.items():
        with path.open() as file:
            rows = list(csv.DictReader(file))
        steps = [float(r["steps"]) / 1000 for r in rows]
        top.plot(steps, [float(r["speed_lps"]) for r in rows], label=name)
        bottom.plot(steps, [float(r["slip_share"]) for r in rows], label=name)
    top.set_ylabel("speed along heading [rod lengths/s]")
    bottom.set_ylabel("slip share [-]")
    bottom.set_xlabel("environment steps [thousand]")
    top.set_title("Median over the episodes of each chunk, exploration noise on")
    for axis in (top, bottom):
        axis.grid(alpha=0.3)
        axis.legend()
    save(figure, out, dpi=120)
