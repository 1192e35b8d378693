"""Parts of an NTRT model: nodes and pairs of a file, the files that it is made of, and the bonds between them.

In the order of NTRT's own builder: a part's children are read, turned, then scaled and moved; its nodes and pairs are
added; then bonds join its children. A bond of nodes to edges also lays the second child against the first: plane on
plane, centre on centre, first point on first point.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.errors import InputError
from tensegym.tables import as_number, as_numbers, as_text, known, mapping, one_line, read_yaml, show

MOST_PARTS, MOST_NODES, MOST_PAIRS = 300, 3000, 20_000
DEEPEST = 12  # files within files
_KEYS = ("nodes", "pair_groups", "builders", "substructures", "bond_groups")
_CHILD = ("path", "rotation", "translation", "scale", "offset")


@dataclass
class Pair:
    """A member: two nodes, by their places in `Model.nodes`, and its tags."""

    a: int
    b: int
    tags: tuple[str, ...]


@dataclass
class Part:
    """A file's nodes by name, and its children."""

    nodes: dict[str, int] = field(default_factory=dict)
    children: dict[str, Part] = field(default_factory=dict)

    def every(self) -> Iterator[int]:
        """Nodes of it and of its children."""
        yield from self.nodes.values()
        for child in self.children.values():
            yield from child.every()

    def found(self, path: str, where: str) -> int:
        """A node by its name, or by those of children before it, with dots between; the first that is so named."""
        *parents, name = path.split(".")
        part = self
        for parent in parents:
            if parent not in part.children:
                raise InputError(one_line(f"{where}: no substructure {show(parent)} in {show(path)}"))
            part = part.children[parent]
        node = part._search(name)
        if node is None:
            raise InputError(one_line(f"{where}: no node {show(path)}; add it under nodes, or mend the name"))
        return node

    def _search(self, name: str) -> int | None:
        if name in self.nodes:
            return self.nodes[name]
        return next((node for child in self.children.values() if (node := child._search(name)) is not None), None)


class Model:
    """An NTRT model, all files of it read. nodes: (3,) each, in the file's unit, y up.

    Raises InputError naming the file, for what it cannot hold or for more than MOST_* of anything.
    """

    def __init__(self, path: Path) -> None:
        self.nodes: list[FloatArray] = []
        self.pairs: list[Pair] = []
        self.builders: dict[str, dict[str, Any]] = {}
        self._parts = 0
        self.top = self._part(path, 0)

    def _part(self, path: Path, depth: int) -> Part:
        self._parts += 1
        if depth > DEEPEST or self._parts > MOST_PARTS:
            raise InputError(f"{path}: substructures within substructures beyond {DEEPEST} deep or {MOST_PARTS} in all")
        where = f"NTRT model {path}"
        data = known(read_yaml(path, "NTRT model", InputError), _KEYS, where, InputError)
        part = Part()
        self._add_children(part, path, _table(data, "substructures", where), where, depth)
        self.builders |= _table(data, "builders", where)  # of the outer file, over those of its substructures
        for name, xyz in _table(data, "nodes", where).items():
            if len(self.nodes) >= MOST_NODES:
                raise InputError(f"{where}: more than {MOST_NODES} nodes")
            part.nodes[str(name)] = len(self.nodes)
            self.nodes.append(_vector(xyz, f"{where}: node {show(name)}"))
        for tags, pairs in _table(data, "pair_groups", where).items():
            for a, b in _pairs(pairs, f"{where}: pair group {show(tags)}"):
                at = f"{where}: pair group {show(tags)}"
                self._add_pair(part.found(a, at), part.found(b, at), tags, at)
        for outer, content in _table(data, "bond_groups", where).items():
            for inner, pairs in mapping(content, f"{where}: bond group {show(outer)}", InputError).items():
                bond, tags = (outer, inner) if "/" in str(outer) else (inner, outer)
                self._bond(part, str(bond), tags, pairs, f"{where}: bond {show(bond)}")
        return part

    def _add_pair(self, a: int, b: int, tags: Any, where: str) -> None:
        if len(self.pairs) >= MOST_PAIRS:
            raise InputError(f"{where}: more than {MOST_PAIRS} pairs")
        self.pairs.append(Pair(a, b, tuple(str(tags).split())))

    # -- children -------------------------------------------------------------------------------------------------

    def _add_children(self, part: Part, path: Path, data: dict[str, Any], where: str, depth: int) -> None:
        given = [(name, place, known(table, _CHILD, f"{where}: substructure {show(names)}", InputError))
                 for names, table in data.items() for place, name in enumerate(str(names).split("/"))]  # fmt: skip
        for name, _, table in given:
            if "path" in table:
                at = as_text(table["path"], f"{where}: path of {show(name)}", InputError)
                if Path(at).is_absolute():
                    raise InputError(one_line(f"{where}: path of {show(name)} is absolute; give it from the file on"))
                part.children[name] = self._part(path.parent / at, depth + 1)
        for name, _, _ in given:
            if name not in part.children:
                raise InputError(one_line(f"{where}: substructure {show(name)} has no path to a file"))
        for name, _, table in given:
            if "rotation" in table:
                self._turn(part.children[name], table["rotation"], f"{where}: rotation of {show(name)}")
        for name, place, table in given:
            at = f"{where}: substructure {show(name)}"
            if "scale" in table:
                scale = as_number(table["scale"], f"{at}: scale", InputError)
                middle = self._centre(part.children[name])
                self._move(part.children[name], lambda x, s=scale, m=middle: m + s * (x - m))
            for key, times in (("offset", place), ("translation", 1)):
                if key in table:
                    by = times * _vector(table[key], f"{at}: {key}")
                    self._move(part.children[name], lambda x, by=by: x + by)

    def _centre(self, part: Part) -> FloatArray:
        return np.mean([self.nodes[node] for node in part.every()] or [np.zeros(3)], axis=0)

    def _move(self, part: Part, to: Any) -> None:
        for node in part.every():
            self.nodes[node] = to(self.nodes[node])

    def _turn(self, part: Part, data: Any, where: str) -> None:
        table = known(data, ("axis", "angle", "reference"), where, InputError)
        if not {"axis", "angle"} <= table.keys():
            raise InputError(f"{where} must give axis and angle [deg]")
        axis, angle = _vector(table["axis"], f"{where}: axis"), as_number(table["angle"], f"{where}: angle", InputError)
        length = np.linalg.norm(axis)
        if length == 0:
            raise InputError(f"{where}: axis 0, 0, 0 is no direction")
        about = _vector(table["reference"], f"{where}: reference") if "reference" in table else self._centre(part)
        turn = Rotation.from_rotvec(np.radians(angle) * axis / length)
        self._move(part, lambda x: about + turn.apply(x - about))

    # -- bonds ----------------------------------------------------------------------------------------------------

    def _bond(self, part: Part, bond: str, tags: Any, pairs: Any, where: str) -> None:
        *names, kind = bond.split("/")
        if len(names) < 2 or kind not in ("node_node", "node_edge"):
            raise InputError(one_line(f"{where} must name two substructures or more and node_node or node_edge, as in "
                                      "a/b/node_node"))  # fmt: skip
        for name in names:
            if name not in part.children:
                raise InputError(one_line(f"{where}: no substructure {show(name)}"))
        ends = list(_pairs(pairs, where))
        for first, second in pairwise(names):
            one, other = part.children[first], part.children[second]
            if kind == "node_node":
                for a, b in ends:
                    self._add_pair(one.found(a, where), other.found(b, where), tags, where)
            else:
                self._bond_to_edges(one, other, ends, tags, where)

    def _bond_to_edges(self, one: Part, other: Part, ends: list[tuple[str, str]], tags: Any, where: str) -> None:
        sides: tuple[list[list[int]], list[list[int]]] = ([], [])
        for pair in ends:
            if sum("/" in end for end in pair) != 1:
                raise InputError(one_line(f"{where}: {show(list(pair))} must be a node and an edge, as in [a, b/c]"))
            for part, end, side in zip((one, other), pair, sides, strict=True):
                side.append([part.found(name, where) for name in end.split("/")][:2])
        if len(ends) < 3:
            raise InputError(f"{where}: {len(ends)} pairs; three or more lay a substructure against another")
        goal, points = (np.array([np.mean([self.nodes[node] for node in point], axis=0) for point in side])
                        for side in sides)  # fmt: skip
        self._lay(other, goal, points, where)
        joined = [tuple(sorted(pair, key=len)) for pair in zip(*sides, strict=True)]
        nodes, edges = {node[0] for node, _ in joined}, {frozenset(edge) for _, edge in joined}
        # the edges give way to cables by way of the nodes, and so do those between the nodes
        self.pairs = [pair for pair in self.pairs if self.is_rod(pair)
                      or ({pair.a, pair.b} not in edges and not {pair.a, pair.b} <= nodes)]  # fmt: skip
        for (node,), (a, b) in joined:
            self._add_pair(a, node, tags, where)
            self._add_pair(node, b, tags, where)

    def _lay(self, part: Part, goal: FloatArray, points: FloatArray, where: str) -> None:
        frames = []
        for at in (goal, points):
            normal, out = np.cross(at[1] - at[0], at[2] - at[0]), at[0] - at.mean(axis=0)
            across = np.cross(normal, out)
            if not np.linalg.norm(across) > 1e-9 * np.ptp(at, axis=0).max() ** 3:
                raise InputError(f"{where}: the first three points lie on a line")
            axes = np.stack([normal, across, np.cross(across, normal)], axis=1)
            frames.append(axes / np.linalg.norm(axes, axis=0))
        turn, middle, target = frames[0] @ frames[1].T, points.mean(axis=0), goal.mean(axis=0)
        self._move(part, lambda x: target + turn @ (x - middle))

    # -- builders -------------------------------------------------------------------------------------------------

    def builder(self, pair: Pair) -> str | None:
        """The tag of the builder that makes a pair: all of whose words the pair has."""
        own = {"rod": {"class": "tgRodInfo"}, "string": {"class": "tgBasicActuatorInfo"}} | self.builders
        return next((str(tag) for tag in own if set(str(tag).split()) <= set(pair.tags)), None)

    def is_rod(self, pair: Pair) -> bool:
        tag = self.builder(pair)
        table = self.builders.get(tag, {"class": "tgRodInfo" if tag == "rod" else ""}) if tag else {}
        return isinstance(table, dict) and table.get("class") == "tgRodInfo"


def _table(data: dict[str, Any], name: str, where: str) -> dict[Any, Any]:
    """A table of the file, empty where it is not there."""
    value = data.get(name)
    return {} if value is None else mapping(value, f"{where}: {name}", InputError)


def _vector(value: Any, where: str) -> FloatArray:
    return np.array(as_numbers(value, 3, where, InputError), dtype=float)


def _pairs(value: Any, where: str) -> Iterator[tuple[str, str]]:
    if value is not None and not isinstance(value, list):
        raise InputError(one_line(f"{where} = {show(value)}; give a list of pairs, as in - [a, b]"))
    for row, pair in enumerate(value or [], 1):
        if not isinstance(pair, list) or len(pair) != 2:
            raise InputError(one_line(f"{where} row {row} = {show(pair)}; a row holds two names"))
        yield str(pair[0]), str(pair[1])
