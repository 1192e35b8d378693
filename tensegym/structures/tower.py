"""Towers: prisms on top of one another, apart (every rod free, class 1) or joined at their nodes (class 2)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tensegym.errors import StructureError
from tensegym.structure.form_finding import form_find
from tensegym.structure.structure import Structure
from tensegym.tables import Checked, bounded

from .blueprint import Blueprint, circle, ring, tensions_of
from .prism import balanced_twist


@dataclass(frozen=True)
class Stack(Checked, error=StructureError):
    """Prisms of alternate hand on one another's polygons, rods joined where they meet: each is in balance by itself."""

    stages: int = bounded(1, 40, 3, "", "prisms")
    rods: int = bounded(3, 30, 3, "", "of each")
    radius: float = bounded(0.01, 10, 0.2, "m", "of the polygons")
    height: float = bounded(0.01, 20, 0.3, "m", "of each")

    def build(self) -> Blueprint:
        twist, count = balanced_twist(self.rods), self.rods
        nodes = np.concatenate([circle(count, self.radius, stage * self.height, twist * (stage % 2))
                                for stage in range(self.stages + 1)])  # fmt: skip
        level = np.arange(len(nodes)).reshape(-1, count)
        # the upper polygon of a prism of the other hand is turned the other way, and so is where its rods lead
        rods = [np.column_stack([low, np.roll(high, -1 if stage % 2 == 0 else 1)])
                for stage, (low, high) in enumerate(pairwise(level))]  # fmt: skip
        cables = {
            "ends": np.concatenate([ring(level[0]), ring(level[-1])]),
            "upright": np.concatenate([np.column_stack(pair) for pair in pairwise(level)]),
        }
        densities = {"ends": 1.0, "upright": 2 * np.sin(np.pi / count)}
        if self.stages > 1:  # where two prisms pull
            cables["joints"], densities["joints"] = np.concatenate([ring(row) for row in level[1:-1]]), 2.0
        tensions = tensions_of(nodes, cables, densities)
        return Blueprint(f"stack_{self.stages}", nodes, np.concatenate(rods), cables, tensions)


@dataclass(frozen=True)
class Tower(Checked, error=StructureError):
    """Two stages of rods of either hand that touch no others, as in Snelson's towers: the feet of the upper stage hang
    in saddles between the heads of the lower.

    Equal tensions balance it, in a shape that form finding gets to from a cylinder. Three rods a stage make the
    expanded octahedron.
    """

    rods: int = bounded(3, 5, 3, "", "of each stage")
    length: float = bounded(0.02, 20, 0.7, "m", "of the rods")

    def build(self) -> Blueprint:
        count, rise = self.rods, self.length / 2
        half, turn = np.pi / count, np.pi / 2 + 2 * np.pi / (3 * count)
        layers = (0.0, 0.0), (-turn, rise), (half - turn, rise / 2), (half, 1.5 * rise)
        nodes = np.concatenate([circle(count, rise, height, angle) for angle, height in layers])
        feet, heads, upper_feet, upper_heads = level = np.arange(4 * count).reshape(4, -1)
        last, following = np.roll(level, 1, axis=1), np.roll(level, -1, axis=1)
        cables = [
            ring(feet), ring(upper_heads), np.column_stack([heads, upper_feet]), np.column_stack([heads, last[2]]),
            np.column_stack([feet, upper_feet]), np.column_stack([heads, last[3]]),
            np.column_stack([feet, following[1]]), np.column_stack([upper_feet, last[3]]),
        ]  # fmt: skip
        rods = np.concatenate([np.column_stack([feet, heads]), np.column_stack([upper_feet, upper_heads])])
        found = form_find(Structure(nodes, rods, np.concatenate(cables), rods[:0]), 1.0)
        nodes = found.nodes * (self.length / found.rod_lengths[:, None].max())
        return Blueprint(f"tower_{count}", nodes, rods, {"all": found.cables}, {"all": 1.0})
