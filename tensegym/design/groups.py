"""Groups: cables, rods and drives that differ from the others of a robot.

    [elastic_cable]                   # of all cables
    stiffness = 300.0
    [cables.vertical]                 # but these: what is not given here is as above
    pairs = [[1, 8], [2, 5]]          # as in structure.cables, in any order
    stiffness = 500.0
    [rods.heavy]                      # likewise over [passive_rod] and [active_rod]
    pairs = [[1, 5]]
    end_mass = 0.2
    [drives.strong]                   # over [drive] and [stiff_cable], by the pairs of the stiff cables
    pairs = [[3, 7]]
    current_limit = 3.4
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import DesignError
from tensegym.structure.structure import WHAT_A_ROW_HOLDS
from tensegym.tables import as_whole_rows, mapping, one_line, read_fields, show

from .parameters import Drive, ElasticCable, Rod, StiffCable

T = TypeVar("T")
MEMBERS = {"cables": "cables", "rods": "rods", "drives": "stiff_cables"}  # what the groups of a design are groups of
KINDS: dict[str, tuple[type[Any], ...]] = {"cables": (ElasticCable,), "rods": (Rod,), "drives": (Drive, StiffCable)}
_REST = ("pretension", "force_density", "natural_length")  # a group that gives one has none of the others of all cables
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")


@dataclass(frozen=True)
class Group:
    """Members that differ from the others of their kind. Raises DesignError for what is no name and no pairs."""

    name: str
    pairs: tuple[tuple[int, int], ...]
    """Of nodes, from 0; the ends of a member in either order."""
    own: Mapping[str, Any] = field(default_factory=dict)
    """Values of the members' fields by name, where they differ."""

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not _NAME.fullmatch(self.name):
            raise DesignError(one_line(f"{show(self.name)} names no group; begin with a letter and go on with letters, "
                                       "digits, _ or -, 40 at most"))  # fmt: skip
        pairs = as_whole_rows(self.pairs, 2, f"group {self.name!r}: pairs", DesignError, WHAT_A_ROW_HOLDS)
        if not len(pairs):
            raise DesignError(f"group {self.name!r} has no pairs; name the nodes of one member or more")
        object.__setattr__(self, "pairs", tuple((a, b) for a, b in pairs.tolist()))

    def over(self, common: T) -> T:
        """``common`` with the group's own values, of those that it has."""
        names = {f.name for f in fields(common)}  # type: ignore[arg-type]
        own = {name: value for name, value in self.own.items() if name in names}
        if any(name in own for name in _REST):
            own = dict.fromkeys(name for name in _REST[1:] if name in names) | own
        return replace(common, **own) if own else common  # type: ignore[type-var]

    def scaled(self, factors: Mapping[str, float]) -> Group:
        """With its own values times factors, by name."""
        own = {name: value * factors.get(name, 1.0) if value is not None and name in factors else value
               for name, value in self.own.items()}  # fmt: skip
        return replace(self, own=own)


def scaled(groups: Sequence[Group], factors: Mapping[str, float]) -> tuple[Group, ...]:
    """Groups with their own values times factors, by name."""
    return tuple(group.scaled(factors) for group in groups)


def groups_from(kind: str, data: Any) -> tuple[Group, ...]:
    """Groups of cables, rods or drives from a table of a design file. Raises DesignError naming group and field."""
    found = []
    for name, table in mapping(data, kind, DesignError).items():
        where = f"{kind}.{name}"
        own = dict(mapping(table, where, DesignError))
        if "pairs" not in own:
            raise DesignError(one_line(f"{where} has no 'pairs'; name the nodes of its members, as in structure."
                                       f"{MEMBERS[kind]}"))  # fmt: skip
        pairs = as_whole_rows(own.pop("pairs"), 2, f"{where}.pairs", DesignError, WHAT_A_ROW_HOLDS) - 1
        found.append(Group(name, tuple(map(tuple, pairs.tolist())), own))
    return tuple(found)


def table_of(group: Group) -> dict[str, Any]:
    """As a design file has it."""
    return {"pairs": [[a + 1, b + 1] for a, b in group.pairs], **{k: v for k, v in group.own.items() if v is not None}}


def check_groups(kind: str, groups: Sequence[Group], pairs: IntArray) -> None:
    """Raise DesignError for two groups of one name, a field that such members do not have or a value that it cannot
    take, a pair that is no member, and a member of two groups."""
    if len({group.name for group in groups}) < len(groups):
        raise DesignError(one_line(f"{kind}: two groups are named {show([group.name for group in groups])}"))
    known, owner = {frozenset(pair) for pair in pairs.tolist()}, dict[frozenset[int], str]()
    for group in groups:
        where = f"{kind}.{group.name}"
        check_own(kind, group)
        for a, b in group.pairs:
            pair = frozenset((a, b))
            if pair not in known:
                raise DesignError(f"{where}: {a + 1}-{b + 1} is none of structure.{MEMBERS[kind]}")
            if pair in owner:
                other = "twice in it" if owner[pair] == group.name else f"in {kind}.{owner[pair]} too"
                raise DesignError(f"{where}: {a + 1}-{b + 1} is {other}; a member has one group at most")
            owner[pair] = group.name


def check_own(kind: str, group: Group) -> None:
    """Raise DesignError for a value that a group's members do not have or cannot take."""
    names = {f.name: of for of in KINDS[kind] for f in fields(of)}
    for name, value in group.own.items():
        if value is not None:
            read_fields(names.get(name, KINDS[kind][0]), {name: value}, f"{kind}.{group.name}", DesignError)


def of_members(groups: Sequence[Group], pairs: IntArray, common: Sequence[T]) -> tuple[T, ...]:
    """What each member (m,) is: ``common`` (m,), with its group's own values."""
    by_pair = {frozenset(pair): group for group in groups for pair in group.pairs}
    found = list(common)
    for row, pair in enumerate(pairs.tolist()):
        group = by_pair.get(frozenset(pair))
        if group is not None:
            found[row] = group.over(found[row])
    return tuple(found)


def group_names(groups: Sequence[Group], pairs: IntArray) -> list[str]:
    """(m,) of the members, "" of those in none."""
    by_pair = {frozenset(pair): group.name for group in groups for pair in group.pairs}
    return [by_pair.get(frozenset(pair), "") for pair in pairs.tolist()]


def column(members: Sequence[Any], name: str) -> FloatArray:
    """(m,) of one field."""
    return np.array([getattr(member, name) for member in members], dtype=float)
