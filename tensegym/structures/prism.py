"""Prisms: rods in a ring, twisted; and the three-rod robot."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tensegym.errors import StructureError
from tensegym.tables import Checked, bounded, choice

from .blueprint import Blueprint, circle, ring, tensions_of


@dataclass(frozen=True)
class Prism(Checked, error=StructureError):
    """Rods from each node of a polygon to the one beside that above it; cables around both ends and up the sides.

    Of any height it is in balance at one twist, pi/2 - pi/n, where an upright cable has 2 sin(pi/n) times the force
    density of one around, and a rod the upright's with its sign changed (Connelly and Terrell 1995, "Globally rigid
    symmetric tensegrities"). Another twist is for form finding to start from.
    """

    rods: int = bounded(3, 60, 3, "", "around")
    radius: float = bounded(0.01, 10, 0.3, "m", "of the polygons that the rods' ends are on")
    height: float = bounded(0.01, 20, 0.35, "m", "between the polygons")
    twist: float | None = bounded(0, 180, None, "deg", "of the upper polygon; else 90 - 180 / rods, in balance")
    wound: str = choice("none", "around", "upright", "across", "all", what="where drives wind: beside those cables, or "
                        "from lower nodes across to the ones before those above")

    def build(self) -> Blueprint:
        twist = balanced_twist(self.rods) if self.twist is None else np.radians(self.twist)
        nodes = np.concatenate([circle(self.rods, self.radius, z, a) for z, a in ((0.0, 0.0), (self.height, twist))])
        low, high = np.arange(2 * self.rods).reshape(2, -1)
        cables = {"around": np.concatenate([ring(low), ring(high)]), "upright": np.column_stack([low, high])}
        densities = {"around": 1.0, "upright": 2 * np.sin(np.pi / self.rods)}
        balanced = abs(twist - balanced_twist(self.rods)) < 1e-9
        tensions = tensions_of(nodes, cables, densities) if balanced else {}
        # the upper ring is wound the other way, so that a half turn lays drives onto drives
        ways = {"around": np.concatenate([ring(low), ring(high)[:, ::-1]]), "upright": cables["upright"],
                "across": np.column_stack([low, np.roll(high, 1)])}  # fmt: skip
        stiff = ways.get(self.wound, np.concatenate(list(ways.values()))) if self.wound != "none" else low[:0]
        return Blueprint(f"prism_{self.rods}", nodes, np.column_stack([low, np.roll(high, -1)]), cables, tensions,
                         stiff.reshape(-1, 2))  # fmt: skip


def balanced_twist(rods: int) -> float:
    """Of one end of a prism's cables against the other, where they balance its rods [rad]."""
    return np.pi / 2 - np.pi / rods


@dataclass(frozen=True)
class ThreeRodRobot(Checked, error=StructureError):
    """A prism of three rods whose cables around both ends have drives beside them; those between are passive.

    So are the published robots of three rods wound (Chen et al. 2025, arXiv 2511.05798; rods of 0.325 m). Equal
    tensions balance it: the cables around are sqrt(3) times as long as those between.
    """

    length: float = bounded(0.02, 10, 0.325, "m", "of the rods")

    def build(self) -> Blueprint:
        # of radius 1 the sides are sqrt(3) long, and the uprights 1 at this height
        upright, reach = (2 * np.sin(angle / 2) for angle in (np.pi / 6, np.pi / 6 + 2 * np.pi / 3))
        height = np.sqrt(1 - upright**2)
        radius = self.length / np.hypot(height, reach)
        return replace(Prism(3, float(radius), float(radius * height), wound="around").build(), name="three_rod_robot")
