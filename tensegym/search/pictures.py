"""Figures of a search's report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.robot.gait import GaitMeter
from tensegym.robot.robot import TensegrityRobot
from tensegym.train.gait_picture import GaitRecorder, draw_gait

from .confirm import TIME_STEP
from .controllers import controller
from .evaluate import Episode, start_of
from .measure import Objective
from .task import Task


def _axes(width: float = 7.0, height: float = 4.5) -> Any:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(width, height))
    axes.grid(alpha=0.3)
    return figure, axes


def _save(figure: Any, out: Path) -> None:
    import matplotlib.pyplot as plt

    figure.tight_layout()
    figure.savefig(out, dpi=110)
    plt.close(figure)


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
    _save(figure, out)


def draw_pareto(losses: FloatArray, front: Sequence[int], objectives: Sequence[Objective], out: Path) -> None:
    """The first two objectives of the trials that keep all constraints, the front marked; losses (t, m), least best."""
    figure, axes = _axes()
    x, y = (losses[:, i] * (-1 if objectives[i].maximise else 1) for i in range(2))
    axes.plot(x, y, ".", color="0.6", label="trials")
    order = sorted(front, key=lambda i: x[i])
    axes.plot(x[order], y[order], "o-", color="tab:red", label="Pareto front")
    axes.set(xlabel=str(objectives[0]), ylabel=str(objectives[1]))
    axes.legend()
    _save(figure, out)


def draw_importance(shares: Mapping[str, float], out: Path, most: int = 15) -> None:
    """Bars of the largest shares."""
    figure, axes = _axes()
    names = sorted(shares, key=lambda n: shares[n], reverse=True)[:most][::-1]
    axes.barh(names, [shares[n] for n in names])
    axes.set(xlabel="importance (PED-ANOVA), parts of 1")
    _save(figure, out)


def draw_best_gait(
    design: RobotDesign, control: dict[str, Any], task: Task, seed: int, rows: Sequence[Episode], out: Path
) -> None:
    """One episode of the found design, and the speeds of all."""
    with TensegrityRobot(design, dt=TIME_STEP, ground=task.ground) as robot:
        direction, _ = start_of(robot, task, seed)
        meter, driver = GaitMeter(robot, direction), controller(control)(robot, direction)
        seen: Any = SimpleNamespace(robot=robot, direction=direction, meter=meter)
        recorder = GaitRecorder(seen, frames=False)
        substeps = max(1, round(driver.period / TIME_STEP))
        for _ in range(int(task.seconds / (substeps * TIME_STEP))):
            robot.command(driver.angles())
            robot.step(substeps)
            meter.update()
            recorder(seen)
    draw_gait(recorder, list(rows), out)
