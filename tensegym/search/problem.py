"""A search as written in a TOML file: task, start design, controller, space, and how to search.

    task = "carry"                                          # a motion, or a [task] table
    [design]                                                # where the search begins, as a design file
    [controller]                                            # kind = "cpg", "walker", "policy", ...
    [space]
    "design.elastic_cable.stiffness" = {low = 200.0, high = 800.0, log = true}
    "controller.feedback" = {spread = 1.0}                  # every entry, this far about its start
    "design.payload.two_way" = {choices = [false, true]}
    [search]
    sampler = "cmaes"                                       # cmaes, tpe, nsga2, random
    objectives = ["max speed_lps"]                          # several with nsga2, tpe or random
    constraints = ["slip_share <= 0.3"]
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

import tomli_w

from tensegym.control.table import with_defaults
from tensegym.design.design_file import design_from_dict, every_value
from tensegym.errors import InputError, TensegymError
from tensegym.structures import parameters
from tensegym.tables import (
    Checked,
    bounded,
    choice,
    fill,
    known,
    mapping,
    noted,
    one_line,
    parse_toml,
    parsed,
    read_text,
    show,
)
from tensegym.tasks.bound import Bound
from tensegym.tasks.motions import as_task, refuse_code
from tensegym.tasks.task import Task

from .measure import Objective
from .space import Space, Tables, space_from, written_out

_TABLES = ("task", "design", "controller", "space", "search")
SAMPLERS = ("cmaes", "tpe", "nsga2", "random")


def _objectives(value: Any) -> tuple[Objective, ...]:
    return tuple(Objective.parse(text) for text in ([value] if isinstance(value, str) else _list(value)))


def _constraints(value: Any) -> tuple[Bound, ...]:
    return tuple(Bound.parse(text) for text in ([value] if isinstance(value, str) else _list(value)))


def _list(value: Any) -> list[Any]:
    if isinstance(value, list):
        return value
    raise InputError(f"{show(value)} must be a text or a list of them")


@dataclass(frozen=True)
class Settings(Checked, error=InputError):
    """How to search.

    fresh_starts: every batch is tried from other start faces and headings, so that no trial is fitted to a few.
    stop_above: a trial whose loss half way is above this quantile of those before it is stopped.
    """

    sampler: str = choice(*SAMPLERS, what="who proposes the next trials")
    objectives: tuple[Objective, ...] = parsed(_objectives, (Objective("speed_lps", True),), "made large or small")
    constraints: tuple[Bound, ...] = parsed(_constraints, (), "what must hold")
    seed: int = bounded(0, 2**31, 0, "", "of the sampler and the episodes")
    batch: int = bounded(1, 10_000, 16, "", "trials asked for at a time, a generation of cmaes and nsga2")
    episodes: int = bounded(1, 1000, 4, "", "episodes of a trial")
    fresh_starts: bool = noted(True, "other starts for every batch")
    stop_above: float = bounded(0, 1, 0.6, "", "quantile of the losses half way; 1 stops none")
    sigma: float = bounded(1e-4, 1, 1 / 6, "", "first step of cmaes, as a part of the ranges")

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.objectives or (self.sampler == "cmaes" and len(self.objectives) > 1):
            raise InputError(f"Settings.objectives: {len(self.objectives)} are given; cmaes takes one, others any")


@dataclass(frozen=True)
class Problem:
    """One search. text: the file it was read from, which is what identifies it."""

    task: Task
    space: Space
    settings: Settings
    text: str

    def with_settings(self, engine: str | None = None, **changes: Any) -> Problem:
        """The same search with the task's engine and some settings replaced; None leaves one as it is."""
        changes = {k: v for k, v in changes.items() if v is not None}
        if engine is None and not changes:
            return self
        data = parse_toml(self.text, "the task file", InputError)
        if engine is not None:
            task = data["task"]
            data["task"] = ({"motion": task} if isinstance(task, str) else task) | {"engine": engine}
        data["search"] = data.get("search", {}) | changes
        return problem_from(tomli_w.dumps(data), "the task file with the options given")

    def __post_init__(self) -> None:
        known = self.task.metrics()
        for metric in [o.metric for o in self.settings.objectives] + [c.metric for c in self.settings.constraints]:
            if metric not in known:
                raise InputError(f"no metric measures {metric!r}; one of {', '.join(known)}")

    def check(self, values: Mapping[str, Any], metrics: Mapping[str, float] | None) -> None:
        """Look whether a stored trial is one of this search: its values, and its metrics where it has a result.

        Raises InputError naming what is missing.
        """
        for dimension in self.space.dimensions:
            if dimension.name not in values:
                raise InputError(f"{dimension.name!r} has no value")
            dimension.check(values[dimension.name])
        if metrics is not None:
            for name in ("sound", *(o.metric for o in self.settings.objectives), self.task.goal.metric,
                         *(c.metric for c in self.settings.constraints)):  # fmt: skip
                if name not in metrics:
                    raise InputError(f"{name!r} was not measured")

    def losses(self, metrics: dict[str, float]) -> list[float]:
        """By how much each constraint is broken; 0 or less is kept. The first is that no episode is disqualified."""
        return [1.0 - metrics["sound"], *(bound.violation(metrics) for bound in self.settings.constraints)]


def load_problem(name: str) -> Problem:
    """A shipped task file by name (carry, ...) or one by path. Raises InputError or FileNotFoundError."""
    shipped = resources.files("tensegym.search") / "tasks"
    names = sorted(p.name.removesuffix(".toml") for p in shipped.iterdir() if p.name.endswith(".toml"))
    if name in names:
        return problem_from((shipped / f"{name}.toml").read_text(encoding="utf-8"), name)
    if not Path(name).is_file():
        raise FileNotFoundError(one_line(f"no task file {name}; give a path, or one of {', '.join(names)}"))
    return problem_from(read_text(name, "task file", InputError), name)


def problem_from(text: str, name: str, *, kept: bool = False) -> Problem:
    """Parse a task file, or the copy that a search has ``kept`` of its own. Raises InputError naming it."""
    data = parse_toml(text, name, InputError)
    try:
        if kept:
            refuse_code(data.get("task"), "the search")
        known(data, _TABLES, "the task file", InputError)
        task = as_task(data.get("task"))
        tables = _start(task, data)
        limits = written_out(data.get("space"))
        if limits != data["space"]:  # in full, so that a search's copy of its file stands alone
            text = tomli_w.dumps({**data, "space": limits})
        space = space_from(limits, tables, _whole(tables))
        _check_ends(space)
        settings = fill(Settings, data.get("search", {}), "search", InputError)
        return Problem(task, space, settings, text)
    except TensegymError as error:
        raise InputError(one_line(f"{name}: {error}")) from error


def _start(task: Task, data: dict[str, Any]) -> Tables:
    tables: Tables = {name: dict(mapping(data.get(name, {}), name, InputError)) for name in ("design", "controller")}
    if task.payload:
        payload = mapping(tables["design"].get("payload", {}), "design.payload", InputError)
        tables["design"]["payload"] = {**payload, "mass": task.payload}
    return tables


def _whole(tables: Tables) -> Tables:
    """Start values of every field there is."""
    design = design_from_dict(tables["design"])
    fields_of = every_value(design)
    given = tables["design"].get("structure", {})
    size = parameters(given) if "builder" in given else {"rod_length": design.length}
    fields_of["structure"] = {**size, "stiff_cables": fields_of["structure"]["stiff_cables"]}
    return {"design": fields_of, "controller": with_defaults(tables["controller"])}


def _check_ends(space: Space) -> None:
    """Refuse a range that leaves what its field may be. What only some of the space's designs break is found later."""
    design = design_from_dict(space.tables["design"])
    for dimension in space.dimensions:
        ends = range(len(dimension.choices)) if dimension.choices else (dimension.range.low, dimension.range.high)
        for value in ends:
            tables = space.apply(space.start | {dimension.name: value})
            group = getattr(design, dimension.path[1], None) if dimension.path[0] == "design" else None
            try:
                if dimension.path[0] == "controller":
                    with_defaults(tables["controller"])
                elif isinstance(group, Checked) and len(dimension.path) == 3 and not dimension.choices:
                    replace(group, **{dimension.path[2]: value})  # type: ignore[type-var]
                else:
                    design_from_dict(tables["design"])
            except TensegymError as error:
                shown = dimension.choices[int(value)] if dimension.choices else f"{value:g}"
                raise InputError(f"[space] {dimension.name!r} at {shown}: {error}") from error
