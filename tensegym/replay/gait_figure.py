"""gait.png: what one episode looked like, and how it stands among all."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.plotting import COLOURS, new_figure, save, thin_legend

from .recording import Recording

BLUE, ORANGE, GREEN = COLOURS[0], COLOURS[1], COLOURS[2]


def draw_gait(recording: Recording, speeds_lps: Sequence[float], out: Path) -> None:
    """Way of the centre of mass with its tips, speeds [L/s] of all episodes, tensions and currents against limits."""
    figure, axes = new_figure(2, 2, size=(12, 8.5), width_ratios=(1, 1))
    (way, speeds), (pull, load) = axes
    _draw_way(way, recording)
    _draw_speeds(speeds, speeds_lps)
    draw_tensions(pull, recording)
    draw_currents(load, recording)
    figure.suptitle(recording.title)
    save(figure, out)


def _draw_way(axis: Any, recording: Recording) -> None:
    length = recording.design.length
    start = recording.centres[0, :2]
    way = (recording.centres[:, :2] - start) / length
    if len(recording.path):
        axis.plot(*((recording.path - start) / length).T, color=GREEN, lw=4, alpha=0.4, label="path to follow")
    axis.plot(*way.T, color="0.25", lw=1.5, label="centre of mass")
    axis.plot(0, 0, "s", ms=7, color="0.25", label="start")
    planes = recording.planes[recording.faces]
    tips = np.flatnonzero(np.diff(planes)) + 1
    axis.plot(*way[tips].T, "o", ms=5, mfc="white", mec=ORANGE, mew=1.6, label=f"tips: {len(tips)}")
    reach = max(0.5, 0.2 * float(np.ptp(way, axis=0).max()))
    turned = np.flatnonzero(np.abs(np.diff(recording.directions, axis=0)).max(axis=1) > 0.5) + 1
    at = [0, *turned.tolist()] if len(turned) <= 12 else range(0, len(way), -(-len(way) // 12))
    arrows = [(way[row], recording.directions[row]) for row in at if np.isfinite(recording.directions[row]).all()]
    for place, direction in arrows:
        tip = place + reach * direction
        axis.annotate("", xytext=place, xy=tip, arrowprops={"arrowstyle": "-|>", "color": BLUE, "lw": 2.2})
        axis.plot(*tip, alpha=0)  # an arrow alone does not widen the axes
    if arrows:
        axis.plot([], [], color=BLUE, lw=2.2, marker=">", label="wanted direction")
    axis.set(xlabel="x [rod lengths]", ylabel="y [rod lengths]", title="Way on the ground, seen from above")
    axis.set_aspect("equal", adjustable="datalim")
    axis.margins(0.12)
    thin_legend(axis)


def _draw_speeds(axis: Any, speeds_lps: Sequence[float]) -> None:
    values = np.array(list(speeds_lps))
    median = float(np.median(values))
    if len(values) < 30:  # each of few
        axis.plot(np.sort(values), np.arange(1, len(values) + 1), "o-", color=BLUE, lw=0.8)
        axis.set(ylabel="episodes at most so fast", ylim=(0, len(values) + 1))
    else:
        axis.hist(values, bins=min(25, len(values) // 4), color=BLUE, edgecolor="white")
        axis.set(ylabel="episodes")
    axis.axvline(median, color="k", ls="--", label=f"median {median:.3f}")
    axis.set(xlabel="speed along the wanted direction [rod lengths/s]", title=f"All episodes: {len(values)}")
    thin_legend(axis)


def _look(drive: int) -> dict[str, Any]:
    """Colour of a drive, dashed where all colours are taken."""
    return {"color": COLOURS[drive % len(COLOURS)], "ls": ("-", "--", ":")[drive // len(COLOURS) % 3]}


def draw_tensions(axis: Any, recording: Recording) -> None:
    """Of the wound cables over time in their drives' colours, the elastic ones as a band, the drives' limit."""
    times, driven = recording.times, recording.model.driven
    elastic = np.delete(recording.tensions, np.arange(driven.start, driven.stop), axis=1)
    if elastic.size:
        low, high = elastic.min(axis=1), elastic.max(axis=1)
        axis.fill_between(times, low, high, color="0.85", lw=0, label="elastic cables, least to most")
    for d, values in enumerate(recording.tensions[:, driven].T):
        axis.plot(times, values, **_look(d), lw=1)
    limit = recording.limits.tension
    axis.axhline(limit, color="k", ls="--", lw=1, label="drive's limit")
    axis.set(xlabel="time [s]", ylabel="tension [N]", xlim=(times[0], times[-1]),
             title="Cables, in the colours of the drives that wind them")  # fmt: skip
    axis.set_ylim(min(0.0, float(recording.tensions.min())), 1.1 * max(limit, float(recording.tensions.max())))
    thin_legend(axis, columns=2)


def draw_currents(axis: Any, recording: Recording, names: bool = True) -> None:
    """Of the drives over time, and their limits; with the drives' names and colours."""
    times = recording.times
    for d, values in enumerate(recording.currents.T):
        axis.plot(times, values, **_look(d), lw=1, label=f"drive {d + 1}" if names else None)
    for sign, label in ((-1, None), (1, "limits")):
        axis.axhline(sign * recording.limits.current, color="k", ls="--", lw=1, label=label)
    axis.set(xlabel="time [s]", ylabel="current [A]", title="Drives", xlim=(times[0], times[-1]))
    axis.set_ylim(-1.15 * recording.limits.current, (1.75 if names else 1.4) * recording.limits.current)
    thin_legend(axis, columns=4, loc="upper center")
