"""Figures of a search's report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.plotting import COLOURS, MARKERS, new_figure, save, thin_legend
from tensegym.replay.gait_figure import draw_gait
from tensegym.replay.retake import median_of, retake
from tensegym.tasks.task import Task
from tensegym.tasks.trials import Setup

from .confirm import TIME_STEP
from .evaluate import Episode
from .labels import metric_label, parameter_label
from .measure import Objective

_SIZE = (7.0, 4.5)


def draw_progress(searches: Mapping[str, FloatArray], objective: Objective, out: Path) -> None:
    """Every trial's objective and the best so far, against the number of trials; searches (t,) by name, NaN refused."""
    figure, axes = new_figure(size=_SIZE)
    best_of = np.fmax if objective.maximise else np.fmin
    for n, (name, values) in enumerate(searches.items()):
        numbers, colour = np.arange(1, len(values) + 1), COLOURS[n % len(COLOURS)]
        axes.step(numbers, best_of.accumulate(values), where="post", color=colour, lw=2, label=f"{name}: best so far")
        axes.plot(numbers, values, MARKERS[n % len(MARKERS)], ms=4, alpha=0.5, color=colour, label=f"{name}: trials")
    what = "more is better" if objective.maximise else "less is better"
    axes.set(xlabel="number of trials", ylabel=f"{metric_label(objective.metric)}, {what}")
    thin_legend(axes)
    save(figure, out)


def draw_pareto(losses: FloatArray, front: Sequence[int], objectives: Sequence[Objective], out: Path) -> None:
    """The first two objectives of the trials that keep all constraints, the front marked; losses (t, m), least best."""
    figure, axes = new_figure(size=_SIZE)
    x, y = (losses[:, i] * (-1 if objectives[i].maximise else 1) for i in range(2))
    axes.plot(x, y, ".", color="0.6", label="trials")
    order = sorted(front, key=lambda i: x[i])
    axes.plot(x[order], y[order], "o-", color=COLOURS[1], label="Pareto front")
    labels = [f"{metric_label(o.metric)}, {'more' if o.maximise else 'less'} is better" for o in objectives]
    axes.set(xlabel=labels[0], ylabel=labels[1])
    thin_legend(axes)
    save(figure, out)


def draw_importance(shares: Mapping[str, float], out: Path, most: int = 15) -> None:
    """Bars of the largest shares."""
    names = sorted(shares, key=lambda n: shares[n], reverse=True)[:most][::-1]
    figure, axes = new_figure(size=(7.0, 1.2 + 0.35 * len(names)))
    bars = axes.barh([parameter_label(name) for name in names], [100 * shares[name] for name in names],
                     color=COLOURS[0])  # fmt: skip
    axes.bar_label(bars, fmt="%.0f", padding=3)
    axes.set(xlabel="share in what separates good trials from others (PED-ANOVA) [%]")
    axes.margins(x=0.1)
    save(figure, out)


def draw_best_gait(
    design: RobotDesign, control: dict[str, Any], task: Task, seed: int, rows: Sequence[Episode], out: Path
) -> None:
    """The median episode of the found design, and the speeds of all: ``rows`` of the seeds from ``seed`` on."""
    task = task.changed(dt=TIME_STEP, patience=task.seconds)
    speeds = [row["speed_lps"] for row in rows]
    seed += median_of(speeds)
    title = f"{design.name}: the median of {len(speeds)} episodes, seed {seed}"
    draw_gait(retake(Setup("best", task, control, design), seed, title), speeds, out)
