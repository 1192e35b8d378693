"""Figures of a search's report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.plotting import new_figure, save
from tensegym.replay.gait_figure import draw_gait
from tensegym.replay.retake import median_of, retake
from tensegym.tasks.task import Task
from tensegym.tasks.trials import Setup

from .confirm import TIME_STEP
from .evaluate import Episode
from .measure import Objective


def _axes(width: float = 7.0, height: float = 4.5) -> Any:
    figure, axes = new_figure(size=(width, height), layout="tight")
    axes.grid(alpha=0.3)
    return figure, axes


def draw_progress(searches: Mapping[str, FloatArray], objective: Objective, out: Path) -> None:
    """Every trial's objective and the best so far, against the number of trials; searches (t,) by name, NaN refused."""
    figure, axes = _axes()
    best_of = np.fmax if objective.maximise else np.fmin
    for name, values in searches.items():
        best = best_of.accumulate(values)
        (line,) = axes.step(np.arange(1, len(best) + 1), best, where="post", label=f"{name}: best so far")
        axes.plot(np.arange(1, len(values) + 1), values, ".", ms=3, alpha=0.5, color=line.get_color())
    axes.set(xlabel="trials", ylabel=objective.metric)
    axes.legend()
    save(figure, out)


def draw_pareto(losses: FloatArray, front: Sequence[int], objectives: Sequence[Objective], out: Path) -> None:
    """The first two objectives of the trials that keep all constraints, the front marked; losses (t, m), least best."""
    figure, axes = _axes()
    x, y = (losses[:, i] * (-1 if objectives[i].maximise else 1) for i in range(2))
    axes.plot(x, y, ".", color="0.6", label="trials")
    order = sorted(front, key=lambda i: x[i])
    axes.plot(x[order], y[order], "o-", color="tab:red", label="Pareto front")
    axes.set(xlabel=str(objectives[0]), ylabel=str(objectives[1]))
    axes.legend()
    save(figure, out)


def draw_importance(shares: Mapping[str, float], out: Path, most: int = 15) -> None:
    """Bars of the largest shares."""
    figure, axes = _axes()
    names = sorted(shares, key=lambda n: shares[n], reverse=True)[:most][::-1]
    axes.barh(names, [shares[n] for n in names])
    axes.set(xlabel="importance (PED-ANOVA), parts of 1")
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
