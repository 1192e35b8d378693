"""Nodes and connectivity as matrices in CSV files, without headers: as MOTES, TsgFEM and tnsgrt have them.

Nodes are columns (3, n) or rows (n, 3). Rods and cables are each a matrix (m, n) with -1 where a member begins, 1 where
it ends and 0 elsewhere, or pairs of node numbers, (m, 2) or (2, m), counted from 0 or 1, which must then be said.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import InputError
from tensegym.tables import number_of, read_text

from .table import Imported, kept, length_of, merged

LARGEST = 4_000_000  # bytes


def read_matrices(
    nodes: str | Path, rods: str | Path, cables: str | Path, units: str | None = None, base: int | None = None
) -> Imported:
    """Three matrices as a design's table, its masses, stiffnesses and pretension the defaults.

    Args:
        nodes, rods, cables: CSV files, see the module.
        units: of the nodes, one of UNITS.
        base: the number of the first node, 0 or 1, where members are pairs of numbers.

    Raises:
        FileNotFoundError: one is not there.
        InputError: one that is no such matrix, with what it holds.
    """
    unit, name = length_of(units), Path(nodes).stem
    points = _nodes(Path(nodes)) * unit
    members = [_members(Path(path), len(points), base) for path in (rods, cables)]
    made = merged(points, [(a, b) for pairs in members for a, b in pairs.tolist()])
    pairs = [(made.place[each] + 1).tolist() for each in members]
    structure = {"nodes": made.nodes.tolist(), "rods": pairs[0], "cables": pairs[1], "stiff_cables": []}
    found = Imported({"name": name, "structure": structure}, made.notes)
    return kept(found, np.ones(len(pairs[1])), f"matrices {nodes}")


def _matrix(path: Path) -> FloatArray:
    """(rows, columns) of a CSV of numbers; between commas, semicolons, tabs or blanks."""
    text = read_text(path, "matrix", InputError, LARGEST)
    lines = [line for line in text.splitlines() if line.strip()]
    between = next((mark for mark in (";", "\t", ",") if lines and mark in lines[0]), None)
    rows = [[cell.strip() for cell in line.strip().rstrip(between or " ").split(between)] for line in lines]
    if not rows or len({len(row) for row in rows}) != 1:
        count = f"rows of {min(map(len, rows))} to {max(map(len, rows))} numbers" if rows else "nothing"
        raise InputError(f"matrix {path} holds {count}; give rows of equal length, without a header")
    if "" in {cell for row in rows for cell in row}:
        raise InputError(f"matrix {path} has an empty cell")
    return np.array([[number_of(cell, f"matrix {path}, row {n}") for cell in row] for n, row in enumerate(rows, 1)])


def _nodes(path: Path) -> FloatArray:
    matrix = _matrix(path)
    if 3 not in matrix.shape:
        raise InputError(f"nodes {path}: {matrix.shape[0]} x {matrix.shape[1]}; give 3 rows or 3 columns, x, y and z")
    return matrix.T if matrix.shape[0] == 3 else matrix


def _members(path: Path, count: int, base: int | None) -> IntArray:
    """(m, 2) node indices from 0."""
    matrix = _matrix(path)
    if (matrix != np.rint(matrix)).any():
        raise InputError(f"members {path} hold numbers that are not whole; give -1, 0 and 1, or node numbers")
    if matrix.shape[1] == count and (np.sort(matrix, axis=1)[:, [0, -1]] == [-1, 1]).all():
        wrong = np.flatnonzero(np.abs(matrix).sum(axis=1) != 2)
        if len(wrong):
            raise InputError(f"members {path}, row {wrong[0] + 1}: a member has one -1 and one 1, all else 0")
        return np.column_stack([matrix.argmin(axis=1), matrix.argmax(axis=1)])
    if 2 not in matrix.shape:
        raise InputError(f"members {path}: {matrix.shape[0]} x {matrix.shape[1]} is neither -1, 0 and 1 for {count} "
                         "nodes nor pairs of node numbers")  # fmt: skip
    if base not in (0, 1):
        raise InputError(f"members {path} are node numbers; say whether they count from 0 or 1: base = {base!r}")
    pairs = (matrix if matrix.shape[1] == 2 else matrix.T).astype(np.int64) - base
    if pairs.min() < 0 or pairs.max() >= count:
        low, high = pairs.min() + base, pairs.max() + base
        raise InputError(f"members {path} name nodes {low} to {high}; counted from {base} there are {base} to "
                         f"{count - 1 + base}")  # fmt: skip
    return pairs
