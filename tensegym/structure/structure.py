"""Structure: a tensegrity as arrays, and the presets. Rods that share a node are joined there by a ball joint.

Node numbers start at 0 in arrays and at 1, as in the paper, wherever people read or write them (TOML, messages,
column names). Lengths in m.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from tensegym.arrays import FloatArray, IntArray, frozen
from tensegym.errors import StructureError
from tensegym.tables import Range, as_rows, as_whole_rows

PAPER_ROD_LENGTH = 2 * 8.42 / 24  # m, printed as 0.7016
PAPER_SPACING = 2 * 0.3125  # m between parallel rods in the paper's node table
ROD_LENGTHS = Range(0.01, 30.0)  # m; a robot in mm read as one in m is outside

_SIX_RODS = [(1, 2), (3, 4), (5, 6), (7, 8), (9, 10), (11, 12)]
_SIX_ROD_CABLES = [
    (1, 5), (1, 6), (1, 9), (1, 11), (2, 7), (2, 8), (2, 9), (2, 11),
    (3, 5), (3, 6), (3, 10), (3, 12), (4, 7), (4, 8), (4, 10), (4, 12),
    (5, 11), (5, 12), (6, 9), (6, 10), (7, 11), (7, 12), (8, 9), (8, 10),
]  # fmt: skip
_PAPER_STIFF_CABLES = [(3, 7), (4, 9), (5, 10), (6, 2), (11, 8), (12, 1)]  # active end, where the drive sits, first


@dataclass(frozen=True)
class Structure:
    """Nodes and what joins them. Raises StructureError, naming nodes counted from 1, for what is no tensegrity."""

    nodes: FloatArray
    """(n, 3) coordinates [m]."""
    rods: IntArray
    """(r, 2) node indices, every node on one rod (class 1) or more."""
    cables: IntArray
    """(c, 2) node indices of the elastic cables."""
    stiff_cables: IntArray
    """(w, 2) node indices of the cables wound by drives, the drive's end first."""

    def __post_init__(self) -> None:
        nodes = as_rows(self.nodes, 3, "nodes", StructureError, "x, y, z in m")
        object.__setattr__(self, "nodes", frozen(nodes))
        for name in ("rods", "cables", "stiff_cables"):
            object.__setattr__(self, name, _pairs(name, getattr(self, name), nodes))
        uses = np.bincount(self.rods.ravel(), minlength=len(nodes))
        if (uses == 0).any():
            bad = int(np.flatnonzero(uses == 0)[0])
            raise StructureError(f"node {bad + 1} is on no rod; every node is the end of one rod or more")
        wrong = np.flatnonzero([length not in ROD_LENGTHS for length in self.rod_lengths.tolist()])
        if len(wrong):
            (a, b), length = self.rods[wrong[0]] + 1, self.rod_lengths[wrong[0]]
            unit = "; coordinates are in m, these look like mm" if length > ROD_LENGTHS.high else ""
            raise StructureError(f"rod {a}-{b} is {length:.4g} m long, outside {ROD_LENGTHS} m{unit}")

    @cached_property
    def rod_lengths(self) -> FloatArray:
        """(r,) [m]"""
        return frozen(self.lengths(self.rods))

    @cached_property
    def shared(self) -> IntArray:
        """Nodes that are on more than one rod, ascending."""
        return frozen(np.flatnonzero(np.bincount(self.rods.ravel()) > 1))

    @cached_property
    def joined(self) -> IntArray:
        """(p, 2) rods that have a node in common."""
        uses = [np.flatnonzero((self.rods == node).any(axis=1)).tolist() for node in self.shared]
        pairs = sorted({pair for rods in uses for pair in combinations(rods, 2)})
        return frozen(np.array(pairs, dtype=np.int64).reshape(-1, 2))

    def lengths(self, pairs: ArrayLike) -> FloatArray:
        """Distances between the nodes of each pair: (p, 2) -> (p,) [m]."""
        pairs = np.asarray(pairs, dtype=np.int64).reshape(-1, 2)
        return np.linalg.norm(self.nodes[pairs[:, 1]] - self.nodes[pairs[:, 0]], axis=1)

    def with_nodes(self, nodes: ArrayLike) -> Structure:
        """The same members on other node positions (n, 3) [m]."""
        return Structure(np.asarray(nodes, dtype=float), self.rods, self.cables, self.stiff_cables)

    def with_rod_lengths(self, lengths: ArrayLike) -> Structure:
        """With the nodes of each rod moved along it, its middle where it is, to lengths (r,) [m]; NaN leaves a rod."""
        wanted = np.asarray(lengths, dtype=float)
        changed = np.isfinite(wanted)
        if not changed.any():
            return self
        nodes, rods = self.nodes.copy(), self.rods[changed]
        ends = self.nodes[rods]
        reach = (ends[:, 1] - ends[:, 0]) * (wanted / self.rod_lengths)[changed, None] / 2
        middles = ends.mean(axis=1)
        nodes[rods[:, 0]], nodes[rods[:, 1]] = middles - reach, middles + reach
        return self.with_nodes(nodes)


WHAT_A_ROW_HOLDS = "two node numbers; give a cable through several nodes as several cables"


def _pairs(name: str, pairs: ArrayLike, nodes: FloatArray) -> IntArray:
    array = as_whole_rows(pairs, 2, name, StructureError, WHAT_A_ROW_HOLDS)
    seen: set[frozenset[int]] = set()
    for a, b in array.tolist():
        member = f"{name} member {a + 1}-{b + 1}"
        if not (0 <= a < len(nodes) and 0 <= b < len(nodes)):
            raise StructureError(f"{member} names a node outside 1..{len(nodes)}")
        if a == b:
            raise StructureError(f"{member} joins node {a + 1} to itself; give two different nodes")
        if np.linalg.norm(nodes[b] - nodes[a]) < 1e-6:
            raise StructureError(f"{member} has no length: nodes {a + 1} and {b + 1} coincide")
        if frozenset((a, b)) in seen:
            raise StructureError(f"{member} is listed twice")
        seen.add(frozenset((a, b)))
    return frozen(array)


def _six_rod_nodes(rod_length: float, spacing: float) -> FloatArray:
    """The paper's node table (12, 3) for any rod length and spacing of parallel rods [m]."""
    h, d = rod_length / 2, spacing / 2
    return np.array(
        [(-d, -h, 0), (-d, h, 0), (d, -h, 0), (d, h, 0), (0, -d, -h), (0, -d, h),
         (0, d, -h), (0, d, h), (-h, 0, d), (h, 0, d), (-h, 0, -d), (h, 0, -d)]
    )  # fmt: skip


def six_rod(rod_length: float = PAPER_ROD_LENGTH, spacing: float | None = None) -> Structure:
    """The six-rod robot with the paper's members.

    Args:
        rod_length: of all rods [m].
        spacing: of parallel rods [m]; without it half a rod, where equal cable tensions balance. The paper's own
            (`PAPER_SPACING`, 0.8907 of its rods) has no self-stress.
    """
    nodes = _six_rod_nodes(rod_length, rod_length / 2 if spacing is None else spacing)
    return Structure(
        nodes,
        np.array(_SIX_RODS) - 1,
        np.array(_SIX_ROD_CABLES) - 1,
        np.array(_PAPER_STIFF_CABLES) - 1,
    )


def paper() -> Structure:
    """The six-rod robot on the paper's node table, as printed."""
    return six_rod(0.7016, PAPER_SPACING)

