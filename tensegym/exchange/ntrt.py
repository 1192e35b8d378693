"""YAML models of the NASA Tensegrity Robotics Toolkit, as a design's table.

    nodes: {a: [0, 0, 0], b: [10, 5, 0]}            # y up, in any unit
    pair_groups: {rod: [[a, b]], muscle: [...]}     # names of tags, each made by the builder whose tag is among them
    builders: {muscle: {class: tgBasicActuatorInfo, parameters: {stiffness: 900, damping: 9, pretension: 400}}}
    substructures: {s1/s2: {path: other.yaml, offset: [0, 12, 0]}}     # also rotation, scale, translation
    bond_groups: {muscle: {s1/s2/node_node: [[a, b]]}}                 # or node_edge: [[a, b/c], ...]
"""

from __future__ import annotations

import re
from collections.abc import Collection
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import InputError
from tensegym.tables import one_line, show

from .ntrt_builders import Builders, RodKind, read_builders
from .ntrt_parts import Model, Pair
from .table import Imported, kept, length_of, merged

PLAIN_RODS = "rods"  # the tag of rods in no group, in what is written here; with a number where it is taken
UP = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])  # its y axis, which is up, onto z


def read_ntrt(path: str | Path, units: str | None = None, pretension: float | None = None) -> Imported:
    """A model's file, with those that it names, as a design's table.

    Rods keep mass and radius, solid and without ends of their own; cables keep stiffness, damping and pretension, a
    group a builder. Its cables are actuators; a design's are passive, and have drives where it says so.

    Args:
        path: of the YAML file.
        units: of its lengths, one of UNITS; NTRT's models are of any scale and do not say.
        pretension: of cables to which the file gives none [N].

    Raises:
        FileNotFoundError: it, or a substructure's file, is not there.
        InputError: what cannot be read, or has no place in a design: the file and the name in it.
    """
    path, unit = Path(path), length_of(units)
    model = Model(path)
    builders = read_builders(model.builders, unit)
    rods, cables = _members(model, builders, f"NTRT model {path}")
    if not rods or not cables:
        raise InputError(f"NTRT model {path} has {len(rods)} rods and {len(cables)} cables; a robot wants both")
    made = merged(np.array(model.nodes) @ UP.T * unit, [(pair.a, pair.b) for pair, _ in (*rods, *cables)])

    def place(pair: Pair) -> list[int]:
        return [int(made.place[pair.a]) + 1, int(made.place[pair.b]) + 1]

    table: dict[str, Any] = {
        "name": path.stem, "structure": {
            "nodes": made.nodes.tolist(), "rods": [place(pair) for pair, _ in rods],
            "cables": [place(pair) for pair, _ in cables], "stiff_cables": []},
    }  # fmt: skip
    groups: dict[str, str] = {}
    for tag in dict.fromkeys(tag for _, tag in cables):
        kind = builders.cables[tag]
        pull = kind.pretension or pretension
        if not pull:
            raise InputError(one_line(f"NTRT model {path}: cables {show(tag)} have no pretension; give one in N"))
        group = {"pairs": [place(pair) for pair, other in cables if other == tag], "stiffness": kind.stiffness,
                 "damping": kind.damping, "pretension": pull}  # fmt: skip
        groups[tag] = _group_name(tag, table.setdefault("cables", {}))
        table["cables"][groups[tag]] = group
    pulls = {tag: float(table["cables"][name]["pretension"]) for tag, name in groups.items()}
    table |= _rods(made.nodes, [place(pair) for pair, _ in rods], [tag for _, tag in rods], builders.rods)
    notes = list(made.notes)
    if builders.left_out:
        notes.append(f"left out, as a design has no place for it: {', '.join(builders.left_out)}")
    return kept(Imported(table, tuple(notes)), np.array([pulls[tag] for _, tag in cables]), f"NTRT model {path}")


def _members(model: Model, builders: Builders, where: str) -> tuple[list[tuple[Pair, str]], list[tuple[Pair, str]]]:
    """Rods and cables, each with the tag of its builder; of a pair that is given twice the first."""
    rods, cables, seen = list[tuple[Pair, str]](), list[tuple[Pair, str]](), set[frozenset[int]]()
    for pair in model.pairs:
        tag = model.builder(pair)
        if tag is None:
            raise InputError(one_line(f"{where}: no builder makes pairs tagged {show(' '.join(pair.tags))}; "
                                      f"there are {', '.join((*builders.rods, *builders.cables))}"))  # fmt: skip
        if frozenset((pair.a, pair.b)) in seen:
            continue
        seen.add(frozenset((pair.a, pair.b)))
        (rods if tag in builders.rods else cables).append((pair, tag))
    return rods, cables


def _group_name(tag: str, taken: Collection[str]) -> str:
    """A group's name of a tag: letters first, blanks as _; with a number behind it where that name is taken."""
    name = "_".join(tag.split())
    name = (name if name[:1].isalpha() else f"g_{name}")[:40]
    tried = (f"{name[:36]}-{number}" for number in count(2))
    return name if name not in taken else next(other for other in tried if other not in taken)


def _rods(nodes: FloatArray, pairs: list[list[int]], tags: list[str], kinds: dict[str, RodKind]) -> dict[str, Any]:
    """[passive_rod], which is what the first is, and [rods] where they differ, of rods between nodes and their tags.

    A group is named by its tag, or numbered where rods of one tag differ, as those of two lengths do.
    """
    tables = []
    for (a, b), kind in zip(pairs, (kinds[tag] for tag in tags), strict=True):
        length = float(np.linalg.norm(nodes[b - 1] - nodes[a - 1]))
        tables.append({
            "tube_mass": kind.density * np.pi * kind.radius**2 * length, "end_mass": 0.0,
            "tube_outer_radius": kind.radius, "tube_inner_radius": 0.0, "end_mass_radius": kind.radius,
            "foot_radius": kind.radius,
        })  # fmt: skip
    unlike = list[dict[str, float]]()
    for table in tables:
        if not any(_same(table, other) for other in unlike):
            unlike.append(table)
    found: dict[str, Any] = {"passive_rod": unlike[0], "friction": kinds[tags[0]].friction}
    members = [[row for row, table in enumerate(tables) if _same(table, own)] for own in unlike]
    first_tags = [tags[rows[0]] for rows in members]
    for number, (own, rows, tag) in enumerate(zip(unlike, members, first_tags, strict=True), 1):
        told_apart = first_tags.count(tag) == 1
        plain = re.fullmatch(rf"{PLAIN_RODS}(-\d+)?", tag) or not told_apart
        if len(unlike) == 1 or (number == 1 and plain):
            continue  # they are what [passive_rod] says
        groups = found.setdefault("rods", {})
        groups[_group_name(tag if told_apart else f"rod_{number}", groups)] = {"pairs": [pairs[r] for r in rows], **own}
    return found


def _same(one: dict[str, float], other: dict[str, float]) -> bool:
    return np.allclose(list(one.values()), list(other.values()), rtol=1e-6)
