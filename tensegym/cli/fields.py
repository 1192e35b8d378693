"""`tensegym fields FILE`: what each kind of file may hold, from the tables that its reader checks it by."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib import import_module
from typing import Any, NamedTuple

import tyro

from tensegym.control.table import KINDS
from tensegym.errors import InputError
from tensegym.report import Report, table
from tensegym.tables import FieldRow, describe, show
from tensegym.tasks.motions import MOTIONS
from tensegym.tasks.task import Task

HEADER = ("field", "default", "unit", "range", "meaning")


class Section(NamedTuple):
    """A table of a file: how it begins there, and what it may hold."""

    title: str
    kind: type[Any]


class FileKind(NamedTuple):
    """A kind of file. home: modules whose docstrings show one. sections: "name: module.Class" of its tables."""

    what: str
    home: str
    sections: tuple[str, ...] = ()


FILES = {
    "design": FileKind("a robot: --design FILE, gym.make(design=...)", "design.design_file design.groups", (
        ": design.design.RobotDesign", "structure, of the preset's kind: design.design_file.SixRods",
        "passive_rod, active_rod, rods.NAME: design.parameters.Rod",
        "elastic_cable, cables.NAME: design.parameters.ElasticCable",
        "stiff_cable, drives.NAME: design.parameters.StiffCable",
        "drive, drives.NAME: design.parameters.Drive", "payload: design.parameters.Payload",
        "flexure: design.parameters.RodFlexure",
    )),
    "task": FileKind("a search, or an evaluation: design run --task, evaluate --task", "search.problem", (
        "task: tasks.task.Task", "task.reward: tasks.reward.RewardWeights",
        "task.disturb: tasks.disturbance.Disturbance", "search: search.problem.Settings",
    )),
    "training": FileKind("a training: train --config FILE.yaml", "train.config", (": train.config.TrainConfig",)),
    "disturbance": FileKind("what goes otherwise than designed: evaluate --disturb", "tasks.disturbance",
                            (": tasks.disturbance.Disturbance",)),
    "controller": FileKind("what moves a robot: [controller] of a task file", "control.table"),
    "hinge": FileKind("a flexible hinge: flexure fit FILE.toml", "flexure.hinge.hinge_file"),
    "measured": FileKind("a measured hinge: flexure fit --data FILE.csv", "flexure.measured.measured_file"),
    "flexible": FileKind("a URDF with flexible joints: load_robot", "flexible.flexure_file",
                         ("[flexure]: flexible.flexure_file.Section",)),
    "commands": FileKind("drive angles against time: simulate --commands FILE.csv", "control.commands_file"),
}  # fmt: skip


def example(name: str) -> str:
    """What a file looks like, in words and by an example: the docstring of its reader."""
    docs = [import_module(f"tensegym.{home}").__doc__ or "" for home in FILES[name].home.split()]
    return "\n\n".join(doc.strip() for doc in docs)


def sections(name: str) -> Iterator[Section]:
    """The tables of a kind of file, in the order in which they are explained."""
    for each in FILES[name].sections:
        title, _, target = each.partition(": ")
        module, _, kind = target.rpartition(".")
        yield Section(title, getattr(import_module(f"tensegym.{module}"), kind))
    if name == "task":
        own = {motion.task: word for word, motion in reversed(MOTIONS.items()) if motion.task is not Task}
        yield from (Section(f"task, of the motion {word}", task) for task, word in reversed(own.items()))
    if name in ("task", "controller"):
        yield from (Section(f"controller, kind {word}", kind) for word, (kind, _) in KINDS.items())


def rows(section: Section) -> list[FieldRow]:
    """Its fields; of a motion those alone that other tasks have not."""
    shared = {row.field for row in describe(Task)} if issubclass(section.kind, Task) else set()
    return [row for row in describe(section.kind) if section.kind is Task or row.field not in shared]


@dataclass(frozen=True)
class Fields:
    """What a file may hold: every field with its default, unit, range and meaning, and an example."""

    file: tyro.conf.Positional[str] = ""
    """Kind of file: design, task, training, disturbance, controller, hinge, measured, flexible, commands; default: a
    list of them."""

    def run(self) -> Report:
        if not self.file:
            text = table(["file", "what it is for"], [[name, kind.what] for name, kind in FILES.items()])
            return Report(text, {name: kind.what for name, kind in FILES.items()})
        if self.file not in FILES:
            raise InputError(f"no kind of file {show(self.file)}; one of {', '.join(FILES)}")
        texts, data = [example(self.file)], dict[str, Any]()
        for section in sections(self.file):
            found = [asdict(row) for row in rows(section)]
            if found:
                data[section.title] = found
                title = [f"[{section.title}]"] if section.title else []
                texts.append("\n".join([*title, table(HEADER, [list(row.values()) for row in found])]))
        return Report("\n\n".join(texts), data)
