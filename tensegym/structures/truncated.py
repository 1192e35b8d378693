"""Truncated polyhedra: cables along the edges of a solid whose corners are cut off, rods through it.

All nodes are images g p of one under the solid's rotations g. With rotations c about a corner, e about the middle of an
edge and b, by half a turn each, that of a rod, the node at p is in balance where

    (q_c (c + c^-1 - 2) + q_e (e - 1) + q_b (b - 1)) p = 0

(Connelly and Back 1998, "Mathematics and tensegrity"): the rods' force density q_b < 0 makes the matrix singular, a
quadratic, and p is what it maps to 0. Of the rods' rotations that give edges a length, the one with the shortest rods
is taken; of its mirror images, the first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import StructureError
from tensegym.tables import Checked, bounded, choice

from .blueprint import Blueprint, tensions_of


class _Solid(NamedTuple):
    group: str
    """Of its rotations, Schoenflies' name."""
    corner: int
    """Edges that meet at a corner."""
    face: int
    """Edges of a face."""
    rod: tuple[int, int]
    """Orders of the rotations c b and e b."""


SOLIDS = {
    "tetrahedron": _Solid("T", 3, 3, (3, 2)),
    "cube": _Solid("O", 3, 4, (4, 3)),
    "octahedron": _Solid("O", 4, 3, (3, 3)),
    "dodecahedron": _Solid("I", 3, 5, (5, 5)),
    "icosahedron": _Solid("I", 5, 3, (3, 5)),
}


@dataclass(frozen=True)
class Truncated(Checked, error=StructureError):
    """A truncated solid, its corners cut to polygons; super-stable for every ratio."""

    solid: str = choice(*SOLIDS, what="whose corners are cut: 6, 12, 12, 30 or 30 rods")
    length: float = bounded(0.02, 20, 0.7, "m", "of the rods")
    ratio: float = bounded(0.05, 20, 1.0, "", "force density of a cable along an edge over one around a corner")

    def build(self) -> Blueprint:
        solid = SOLIDS[self.solid]
        turns = Rotation.create_group(solid.group).as_matrix()
        corner = next(turn for turn in turns if _is(turn, solid.corner))
        edge = next(turn for turn in turns if _is(turn, 2) and _is(corner @ turn, solid.face))
        rod = next(turn for turn in turns if _is(turn, 2)
                   and _is(corner @ turn, solid.rod[0]) and _is(edge @ turn, solid.rod[1]))  # fmt: skip
        node = node_in_balance(corner, edge, rod, self.ratio)
        node *= self.length / np.linalg.norm(rod @ node - node)
        pairs = {name: _images(turns, turn) for name, turn in (("corner", corner), ("edge", edge), ("rod", rod))}
        rods = pairs.pop("rod")
        nodes = turns @ node
        tensions = tensions_of(nodes, pairs, {"corner": 1.0, "edge": self.ratio})
        return Blueprint(f"truncated_{self.solid}", nodes, rods, pairs, tensions)


def _is(turn: FloatArray, order: int) -> bool:
    """Whether a rotation (3, 3) turns by a full turn over ``order``."""
    return bool(abs(np.trace(turn) - 1 - 2 * np.cos(2 * np.pi / order)) < 1e-9)


def _images(turns: FloatArray, turn: FloatArray) -> IntArray:
    """(m, 2) the pairs of nodes g p and g turn p, each once, by their turns' places."""
    other = np.array([np.abs(turns - turns[i] @ turn).sum(axis=(1, 2)).argmin() for i in range(len(turns))])
    return np.unique(np.sort(np.column_stack([np.arange(len(turns)), other]), axis=1), axis=0)


def node_in_balance(corner: FloatArray, edge: FloatArray, rod: FloatArray, ratio: float) -> FloatArray:
    """(3,) unit vector to a node; see the module."""
    one = np.eye(3)
    pull, push = corner + corner.T - 2 * one + ratio * (edge - one), rod - one
    # det(pull + q push) is a quadratic: a half turn's push has rank 2
    values = [np.linalg.det(pull + q * push) for q in (-1.0, 0.0, 1.0)]
    roots = np.roots([(values[0] + values[2]) / 2 - values[1], (values[2] - values[0]) / 2, values[1]])
    density = max(root.real for root in roots if root.real < 0)
    return np.linalg.svd(pull + density * push)[2][-1]
