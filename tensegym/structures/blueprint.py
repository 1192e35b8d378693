"""Blueprint: what a builder gives: where the nodes are, and which cables are alike and how strongly they pull."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.structure.structure import Structure


@dataclass(frozen=True)
class Blueprint:
    """A tensegrity with its cables in groups.

    nodes (n, 3) [m]; rods (r, 2), every group of cables (c, 2) and stiff_cables (w, 2) are node indices from 0.
    """

    name: str
    nodes: FloatArray
    rods: IntArray
    cables: Mapping[str, IntArray]
    """Groups of elastic cables, by name."""
    tensions: Mapping[str, float] = field(default_factory=dict)
    """Of the cables of each group, over that of the first group; empty where none balance these nodes."""
    stiff_cables: IntArray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))

    @property
    def joint_class(self) -> int:
        """k of a class-k tensegrity: the most rods that share a node."""
        return int(np.bincount(self.rods.ravel()).max())

    @property
    def all_cables(self) -> IntArray:
        """(c, 2) all elastic cables, group after group."""
        return np.concatenate(list(self.cables.values()))

    @cached_property
    def structure(self) -> Structure:
        """The same without its groups. Raises StructureError where no structure may be so."""
        return Structure(self.nodes, self.rods, self.all_cables, self.stiff_cables)

    def lengths(self, pairs: IntArray) -> FloatArray:
        """(p,) distances between the nodes of pairs (p, 2) [m]."""
        return np.linalg.norm(self.nodes[pairs[:, 1]] - self.nodes[pairs[:, 0]], axis=1)

    def densities(self) -> FloatArray:
        """(c,) force density of each cable where those of the first group pull with 1 N [N/m], as in `all_cables`."""
        return np.concatenate([self.tensions[name] / self.lengths(pairs) for name, pairs in self.cables.items()])


def tensions_of(
    nodes: FloatArray, cables: Mapping[str, IntArray], densities: Mapping[str, float]
) -> dict[str, float]:
    """`Blueprint.tensions` of groups whose cables have these force densities, a group's all of one length."""
    ends = {name: nodes[pairs[0]] for name, pairs in cables.items()}
    pulls = {name: densities[name] * np.linalg.norm(first - second) for name, (first, second) in ends.items()}
    first = next(iter(pulls.values()))
    return {name: float(pull / first) for name, pull in pulls.items()}


def ring(nodes: IntArray) -> IntArray:
    """(n, 2) pairs of each node with the next, the last with the first."""
    return np.column_stack([nodes, np.roll(nodes, -1)])


def circle(count: int, radius: float, height: float, angle: float) -> FloatArray:
    """(count, 3) nodes of a regular polygon about z; the first is at ``angle`` [rad]."""
    at = angle + 2 * np.pi * np.arange(count) / count
    return np.column_stack([radius * np.cos(at), radius * np.sin(at), np.full(count, height)])
