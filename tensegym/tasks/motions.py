"""The tasks by name, and a task from what a file or an argument gives."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Mapping
from typing import Any, NamedTuple

from tensegym.errors import InputError
from tensegym.tables import fill, in_file, one_line, read_toml, show

from .bound import Bound
from .course import Course
from .follow import Follow
from .navigate import Navigate
from .roll import Roll
from .step_onto import StepOnto
from .task import Task


class Motion(NamedTuple):
    """A task's class, and the defaults of its fields that are the motion's own."""

    task: type[Task]
    fields: Mapping[str, Any] = {}


MOTIONS: dict[str, Motion] = {
    "roll": Motion(Roll),
    "step": Motion(StepOnto, {"seconds": 4.0}),
    "stand": Motion(StepOnto, {"seconds": 60.0, "rest": 1.0, "patience": 60.0}),
    "climb": Motion(Roll, {"goal": Bound("speed_lps", True, 0.05), "slope": 10.0}),
    "cross": Motion(Roll, {"roughness": 0.02}),
    "carry": Motion(Roll, {"payload": 0.5}),
    "drop": Motion(Roll, {"drop": 1.0, "settle": 5.0, "seconds": 20.0}),
    "steer": Motion(Navigate, {"goal": Bound("leg_speed", True, 0.28), "headings": 1.0, "seconds": 60.0}),
    "places": Motion(Navigate, {"goal": Bound("places", True, 6.0), "seconds": 60.0}),
    "path": Motion(Follow),
    "course": Motion(Course),
}


def load_task(name: str) -> Task:
    """A task from a motion's name, or from a TOML file's [task] table.

    Raises:
        FileNotFoundError: there is no such file.
        InputError: as `as_task`, naming the file.
    """
    if not name.endswith(".toml"):
        return as_task(name)
    table = read_toml(name, "task file", InputError)
    if "task" not in table:
        raise InputError(one_line(f"task file {name} has no [task] table; write one with motion = and its fields"))
    with in_file(name):
        return as_task(table["task"])


def as_task(value: Any) -> Task:
    """A task from itself, a motion's name, or a table that names one and changes its fields.

    Args:
        value: the task, its name, or its table: a name is one of MOTIONS, or ``package.module:Class`` for a task of
            your own; a table holds it as ``motion``, with the fields of the task beside it.

    Raises:
        InputError: there is no such motion or field, or a field is outside its range.
    """
    if isinstance(value, Task):
        return value
    table = {"motion": value} if isinstance(value, str) else value
    if not isinstance(table, Mapping) or not isinstance(table.get("motion"), str):
        given = table.get("motion") if isinstance(table, Mapping) else table
        raise InputError(f"task motion {str(given)[:100]!r} is not one of {', '.join(MOTIONS)}, or module:Class")
    return _task_from(table)


def refuse_code(task: Any, where: str) -> None:
    """Look at a task that a folder's file names: reading a run or a search imports no code on its word alone.

    Raises InputError, naming the file by ``where``, for a ``module:Class`` whose module this program has not imported.
    """
    motion = task.get("motion") if isinstance(task, Mapping) else task
    module = motion.partition(":")[0] if isinstance(motion, str) and ":" in motion else ""
    if module and module not in sys.modules:
        raise InputError(one_line(f"{where} names the task {show(motion)}, which is code; if you know it, import it: "
                                  f"--import {module[:60]}"))  # fmt: skip


def _task_from(table: Mapping[str, Any]) -> Task:
    motion = _motion(table["motion"])
    base = motion.task(motion=table["motion"], **motion.fields)
    return fill(motion.task, dict(table), "[task]", InputError, base)


def _motion(name: str) -> Motion:
    if name in MOTIONS:
        return MOTIONS[name]
    module, _, attribute = name.partition(":")
    if not attribute:
        raise InputError(f"task motion {name[:100]!r} is not one of {', '.join(MOTIONS)}, or module:Class")
    try:
        found = getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError, ValueError) as error:
        raise InputError(f"task motion {name[:100]!r} cannot be imported: {error}") from error
    if not (isinstance(found, type) and issubclass(found, Task)):
        raise InputError(f"task motion {name[:100]!r} is no subclass of tensegym.Task")
    return Motion(found)
