"""What a file of another tool becomes: the table of a design, and what it could not hold."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import InputError
from tensegym.structure.equilibrium import BALANCE_TOLERANCE, out_of_balance
from tensegym.structure.structure import Structure
from tensegym.tables import in_file, one_line

UNITS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254}
"""Lengths [m] of what a file may be in."""
SHORTEST, LONGEST = 1e-9, 1e6
SAME = 1e-6  # of the whole: nodes no farther apart are one


class Imported(NamedTuple):
    """A file of another tool, read."""

    table: dict[str, Any]
    """For `tensegym.design.design_file.design_from_dict`."""
    notes: tuple[str, ...]
    """What was merged, or left out since a design has no place for it."""


def length_of(unit: str | None) -> float:
    """Of a unit by its name, or of a number of metres as a text [m]. Raises InputError for none and for another."""
    names = ", ".join(UNITS)
    if not unit:
        raise InputError(f"the file does not say its unit of length; give units, one of {names}, or its length in m")
    try:
        length = UNITS[unit] if unit in UNITS else float(unit)
    except ValueError:
        length = 0.0
    if not SHORTEST <= length <= LONGEST:
        raise InputError(one_line(
            f"units = {unit!r} is not one of {names}, nor a length of {SHORTEST:g} to {LONGEST:g} m"
        ))
    return length


class Merged(NamedTuple):
    """Nodes without those that are not used or lie where another does."""

    nodes: FloatArray
    """(n, 3)."""
    place: IntArray
    """(given,) where each given node went; -1 for one left out."""
    notes: tuple[str, ...]


def merged(nodes: FloatArray, used: Sequence[tuple[int, int]]) -> Merged:
    """Nodes (given, 3) that the pairs ``used`` name, those at one place as one, in their order."""
    given = np.asarray(nodes, dtype=float).reshape(-1, 3)
    first = np.arange(len(given))
    size = float(np.ptp(given, axis=0).max(initial=0.0))
    for a, b in sorted(cKDTree(given).query_pairs(SAME * size)) if len(given) else ():
        first[b] = min(first[b], first[a])
    named = {int(first[node]) for pair in used for node in pair}
    kept = [node for node in range(len(given)) if node in named]
    place = np.full(len(given), -1)
    place[kept] = np.arange(len(kept))
    notes = []
    joined = int((first != np.arange(len(given))).sum())
    if joined:
        notes.append(f"{joined} nodes that lie where another does were joined to it")
    if unused := len(given) - joined - len(kept):
        notes.append(f"{unused} nodes without a member were left out")
    return Merged(given[kept], place[first], tuple(notes))


def kept(found: Imported, tensions: FloatArray, where: str) -> Imported:
    """The same, with [keep] shape where rods share nodes and tensions (c,) of the cables, of any unit, do not balance
    them: form finding moves none of those. ``where`` names the file in what a structure is refused for."""
    parts = found.table["structure"]
    rods = np.array(parts["rods"], dtype=np.int64).reshape(-1, 2) - 1
    if np.bincount(rods.ravel(), minlength=1).max() < 2:
        return found
    with in_file(where):
        structure = Structure(np.array(parts["nodes"]), rods, np.array(parts["cables"]) - 1, rods[:0])
    if np.abs(out_of_balance(structure, tensions)).max() <= BALANCE_TOLERANCE * tensions.max():
        return found
    note = ("rods share nodes, which form finding does not move: [keep] shape = true holds them as they are, by the "
            "tensions nearest to those given")  # fmt: skip
    return Imported(found.table | {"keep": {"shape": True}}, (*found.notes, note))
