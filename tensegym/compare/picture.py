"""All parts of a comparison in one picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.plotting import COLOURS, new_figure, save, thin_legend

from .part import ENGINES, Part


def draw(parts: Sequence[Part], out: Path) -> None:
    """A panel each."""
    figure, axes = new_figure(1, len(parts), size=(5.5 * len(parts), 4.5), squeeze=False)
    for axis, part in zip(axes[0], parts, strict=True):
        _PANELS[part.title](axis, part)
    save(figure, out)


def _paths(axis: Any, part: Part) -> None:
    period = part.curves["period_s"]
    for name, path in part.curves.items():
        if name == "period_s":
            continue
        values = np.array(path)
        values = values if values.ndim == 1 else values.max(axis=1)
        label = {"engines_m": "farthest node"}.get(name, name.removesuffix("_m"))
        number = len(axis.lines)
        axis.semilogy(period * np.arange(len(values)), np.maximum(values, 1e-18), color=COLOURS[number % len(COLOURS)],
                      ls=("-", "--", ":")[number % 3], label=label)  # fmt: skip
    axis.set(xlabel="time [s]", ylabel="nodes apart [m]", title=f"{part.title}: PyBullet and MuJoCo")
    thin_legend(axis)


def _heights(axis: Any, part: Part) -> None:
    axis.barh(part.curves["faces"], 1e3 * np.array(part.curves["difference_m"]), color=COLOURS[0])
    axis.set(xlabel="height in MuJoCo less that in PyBullet [mm]", ylabel="face, by its nodes", title="at rest")
    axis.tick_params(axis="y", labelsize=7)


def _tips(axis: Any, part: Part) -> None:
    shares = {name: 100 * part.curves[name] for name in ("equal", "on an edge", "not explained")}
    bars = axis.bar(list(shares), list(shares.values()), color=COLOURS[0])
    axis.bar_label(bars, fmt="%.1f %%")
    axis.set(ylabel="of all pulls [%]", title="faces that tabulated pulls end on")


def _speeds(axis: Any, part: Part) -> None:
    for engine, colour, style in zip(ENGINES, COLOURS, ("-", "--"), strict=False):
        speeds = np.sort(part.curves[f"{engine}_lps"])
        axis.step(speeds, (np.arange(len(speeds)) + 1) / len(speeds), where="post",
                  color=colour, ls=style, lw=2, label=f"{engine}, median {np.median(speeds):.3f}")  # fmt: skip
    axis.set(xlabel="speed along the wanted direction [rod lengths/s]", ylabel="share of episodes",
             title=part.rows[0][0])  # fmt: skip
    thin_legend(axis)


_PANELS = {"free flight": _paths, "commands": _paths, "settling": _heights, "steps": _tips, "episodes": _speeds}
