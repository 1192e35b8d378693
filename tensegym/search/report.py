"""report.md of a search: what was asked, what was found, how it compares, and the files to build it from."""

from __future__ import annotations

import platform
import warnings
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import optuna
import tomli_w

from tensegym.arrays import FloatArray
from tensegym.bullet.c_interface import installed
from tensegym.design.design_file import design_from_dict, save_design
from tensegym.design.urdf_writer import urdf_files
from tensegym.files import VERSION, replace_path, write_text
from tensegym.robot.standing import standing_verdict

from .confirm import FIRST_SEED, TIME_STEP, Confirmed, gain, judge, summary
from .figures import draw_best_gait, draw_importance, draw_pareto, draw_progress
from .problem import Problem
from .store import Finished, Store
from .winner import losses_of, pareto

_ROWS = {
    "speed_lps_median": "speed, median [L/s]", "speed_lps_mean": "speed, mean [L/s]",
    "speed_lps_low": "speed, 10 % quantile", "speed_lps_high": "speed, 90 % quantile",
    "slip_share_median": "slip share, median", "tips_median": "tips, median",
    "cost_of_transport_median": "cost of transport, median",
    "drive_load_largest": "drive load (rms current over its limit), largest",
    "audit_failures": "audit failures", "disqualified": "disqualified",
}  # fmt: skip


def objective_values(problem: Problem, finished: Finished) -> FloatArray:
    """(t,) first objective of the trials in their order, NaN for those refused, stopped or out of the constraints."""
    metric = problem.settings.objectives[0].metric
    return np.array([
        np.nan if o.refused is not None or o.stopped or max(problem.losses(o.metrics)) > 0 else o.metrics[metric]
        for _, (_, o) in sorted(finished.items())
    ])  # fmt: skip


def importances(store: Store, problem: Problem) -> dict[str, float]:
    """Share of each dimension in what separates good trials from others; entries of a vector are added up.

    Empty where there are too few trials to tell.
    """
    objective = problem.settings.objectives[0]
    sign = -1 if objective.maximise else 1
    evaluator = optuna.importance.PedAnovaImportanceEvaluator()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            shares = optuna.importance.get_param_importances(
                store.study, evaluator=evaluator,
                target=lambda t: sign * t.user_attrs["outcome"]["metrics"][objective.metric],
            )  # fmt: skip
        except (ValueError, RuntimeError):
            return {}
    fields: dict[str, float] = {}
    for name, share in shares.items():
        fields[name.split("[")[0]] = fields.get(name.split("[")[0], 0.0) + share
    return fields


def write_report(
    folder: Path, problem: Problem, store: Store, confirmed: Confirmed, others: Mapping[str, tuple[Problem, Finished]]
) -> dict[str, Any]:
    """Write report.md, its figures and best/ into ``folder``; returns the figures of the table as plain types.

    others: searches to compare with, by name.
    """
    finished, objectives = store.finished(), problem.settings.objectives
    values = finished[confirmed.number][0]
    tables = problem.space.apply(values)
    design = design_from_dict(tables["design"])
    with replace_path(folder / "best") as best:
        (best / "urdf").mkdir(parents=True)
        save_design(design, best / "design.toml")
        write_text(best / "controller.toml", tomli_w.dumps({"version": VERSION, **tables["controller"]}))
        for name, text in urdf_files(design).items():
            write_text(best / "urdf" / name, text)

    curves = {"this search": objective_values(problem, finished)}
    curves |= {name: objective_values(p, done) for name, (p, done) in others.items()}
    draw_progress(curves, objectives[0], folder / "progress.png")
    pictures = ["![progress](progress.png)"]
    shares = importances(store, problem)
    if shares:
        draw_importance(shares, folder / "importance.png")
        pictures.append("![parameter importance](importance.png)")
    if len(objectives) > 1:
        kept, losses = losses_of(problem, finished)
        if kept:
            draw_pareto(losses, pareto(losses), objectives, folder / "pareto.png")
            pictures.append("![Pareto front](pareto.png)")
    found = confirmed.rows["found", TIME_STEP]
    draw_best_gait(design, tables["controller"], problem.task, FIRST_SEED, found, folder / "gait.png")
    pictures.append("![gait of the best design](gait.png)")

    goal = problem.task.goal.metric
    columns = {
        f"{who}, {1e3 * dt:g} ms": {"goal_metric_mean": judge(problem.task.goal, rows).mean} | summary(rows)
        for (who, dt), rows in confirmed.rows.items()
    }
    gains = [gain(confirmed.rows["start", TIME_STEP], found, metric)
             for metric in dict.fromkeys((objectives[0].metric, goal, "speed_lps"))]  # fmt: skip
    verdict = standing_verdict(design, problem.task.engine)
    reached = judge(problem.task.goal, found)
    constraints = [judge(each, found) for each in problem.settings.constraints]
    data = {"folder": str(folder), "goal": reached.bound, "goal_met": reached.kept, "goal_mean": reached.mean,
            "constraints": [each._asdict() | {"text": each.text} for each in constraints], "trial": confirmed.number,
            "trials": len(finished), "seconds": store.seconds(), "confirmed": columns, "importance": shares,
            "gains": [each._asdict() | {"text": each.text} for each in gains],
            "standing": verdict.as_dict(), "stands": verdict.text,
            "best_so_far": {name: _last_best(c, objectives[0].maximise) for name, c in curves.items()}}  # fmt: skip
    write_text(folder / "report.md", "\n".join(_lines(problem, store, values, data, pictures)) + "\n")
    return data


def goal_row(problem: Problem) -> dict[str, str]:
    """Name of the goal's metric in a table; none where it is the speed, whose mean stands there anyway."""
    metric = problem.task.goal.metric
    return {} if metric == "speed_lps" else {"goal_metric_mean": f"{metric}, mean"}


def _last_best(values: FloatArray, maximise: bool) -> float | None:
    if np.isnan(values).all():
        return None
    return float(np.nanmax(values) if maximise else np.nanmin(values))


def _lines(problem: Problem, store: Store, values: dict[str, Any], data: dict[str, Any], pictures: list[str]) -> Any:
    settings, columns = problem.settings, data["confirmed"]
    yield f"# Search for a design: {problem.task.motion}"
    yield ""
    yield (f"The goal, {data['goal']}, is **{'reached' if data['goal_met'] else 'not reached'}**: "
           f"{data['goal_mean']:.4g} in the mean of {next(iter(columns.values()))['episodes']} new starts, by trial "
           f"{data['trial']} of {data['trials']}; {settings.sampler}, seed {settings.seed}, "
           f"{data['seconds'] / 60:.0f} minutes.")  # fmt: skip
    if data["constraints"]:
        yield ""
        yield f"On the same starts: {'; '.join(each['text'] for each in data['constraints'])}."
    yield ""
    shown_rows = goal_row(problem) | _ROWS
    yield from _table(["", *columns], [[what, *(c[key] for c in columns.values())] for key, what in shown_rows.items()])
    yield ""
    yield (f"Beside the start, at {1e3 * TIME_STEP:g} ms from the same starts, mean of the differences [95 %]: "
           f"{'; '.join(each['text'] for each in data['gains'])}.")  # fmt: skip
    yield ""
    if len(data["best_so_far"]) > 1:
        yield from _table(["search", f"best {settings.objectives[0]}, as searched"], list(data["best_so_far"].items()))
        yield ""
    yield f"The robot found {data['stands']}.".replace("\n", "; ")
    yield ""
    yield "## Where it began and what was found"
    yield ""
    scalars = [d for d in problem.space.dimensions if d.entry is None]
    shown = {d.name: (lambda v, d=d: d.choices[int(v)] if d.choices else v) for d in scalars}
    yield from _table(["field", "start", "found", "range"], [
        [d.name, shown[d.name](problem.space.start[d.name]), shown[d.name](values[d.name]),
         "choices" if d.choices else f"{d.range.low:.4g} to {d.range.high:.4g}"] for d in scalars
    ])  # fmt: skip
    vectors = sorted({".".join(d.path) for d in problem.space.dimensions if d.entry is not None})
    if vectors:
        yield ""
        yield f"Searched entry by entry, in best/controller.toml: {', '.join(vectors)}."
    yield ""
    yield from pictures
    yield ""
    yield "## To repeat it"
    yield ""
    yield "best/design.toml, best/controller.toml and best/urdf/ are the robot that was found. The task file:"
    yield ""
    yield from ("    " + line for line in store.problem_text.splitlines())
    yield ""
    names = ("tensegym", *installed(), "optuna", "numpy", "numba")
    yield f"Python {platform.python_version()}, " + ", ".join(f"{name} {version(name)}" for name in names) + "."


def _table(header: list[str], rows: list[Any]) -> Any:
    cells = [[f"{c:.4g}" if isinstance(c, float) else str(c) for c in row] for row in rows]
    yield "| " + " | ".join(header) + " |"
    yield "|" + "---|" * len(header)
    yield from ("| " + " | ".join(row) + " |" for row in cells)
