"""The expanded octahedron: three pairs of parallel rods, the six-rod robot."""

from __future__ import annotations

from dataclasses import dataclass

from tensegym.errors import StructureError
from tensegym.structure.structure import PAPER_ROD_LENGTH, six_rod
from tensegym.tables import Checked, bounded

from .blueprint import Blueprint


@dataclass(frozen=True)
class Octahedron(Checked, error=StructureError):
    """Six rods, 24 equal cables of sqrt(3/8) rods, parallel rods half a rod apart, six wound cables as in the paper
    (Tibert and Pellegrino 2003, "Review of form-finding methods for tensegrity structures")."""

    length: float = bounded(0.02, 20, PAPER_ROD_LENGTH, "m", "of the rods")

    def build(self) -> Blueprint:
        robot = six_rod(self.length)
        return Blueprint("octahedron", robot.nodes, robot.rods, {"around": robot.cables}, {"around": 1.0},
                         robot.stiff_cables)  # fmt: skip
