"""A spine of tetrahedra: rigid vertebrae of six rods, hung from one another by cables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.errors import StructureError
from tensegym.tables import Checked, bounded

from .blueprint import Blueprint, circle, ring, tensions_of


@dataclass(frozen=True)
class Spine(Checked, error=StructureError):
    """Regular tetrahedra with their tips up; the base of each hangs from the tip of the one below and is tied down to
    its base. Rods along all edges share their nodes (class 3).

    In balance where the ties' force density over the hangers' is (height - pitch) / pitch: three of either pull a
    vertebra down and up (the layout of tetrahedral spines: Tietz et al. 2013, "Tetraspine").
    """

    vertebrae: int = bounded(2, 40, 4, "", "tetrahedra")
    edge: float = bounded(0.02, 5, 0.3, "m", "of a tetrahedron")
    pitch: float = bounded(0.1, 0.95, 0.6, "", "from base to base, as a part of a tetrahedron's height")

    def build(self) -> Blueprint:
        height = self.edge * np.sqrt(2 / 3)
        step = self.pitch * height
        parts = [np.vstack([circle(3, self.edge / np.sqrt(3), n * step, 0.0), (0.0, 0.0, n * step + height)])
                 for n in range(self.vertebrae)]  # fmt: skip
        base = np.arange(4 * self.vertebrae).reshape(-1, 4)
        rods = [np.vstack([ring(row[:3]), np.column_stack([row[:3], np.full(3, row[3])])]) for row in base]
        below, above = base[:-1], base[1:, :3]
        cables = {"hanger": np.column_stack([np.repeat(below[:, 3], 3), above.ravel()]),
                  "tie": np.column_stack([below[:, :3].ravel(), above.ravel()])}  # fmt: skip
        nodes = np.concatenate(parts)
        tensions = tensions_of(nodes, cables, {"hanger": 1.0, "tie": (height - step) / step})
        return Blueprint(f"spine_{self.vertebrae}", nodes, np.concatenate(rods), cables, tensions)
