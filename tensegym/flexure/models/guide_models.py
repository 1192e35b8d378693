"""Closed forms of a parallelogram flexure: the beam constraint model, and the pseudo-rigid body of its two leaves.

Two equal leaves of length L side by side, a height H apart; the load acts at the stage's middle, between the leaves'
ends. EI and EA are of one leaf, f = F L^2 / EI across, p = P L^2 / EI along, k33 = EA L^2 / EI.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import GROUND, TIP, Hinge

CHARACTERISTIC, SPRING = 0.8517, 2.65
"""gamma and K_theta of a leaf whose ends do not turn (Howell, Compliant Mechanisms, 2001, section 5.5)."""
ROUNDS = 30


@dataclass(frozen=True)
class Guide:
    """Two equal leaves side by side."""

    length: float
    """L [m]."""
    height: float
    """H, between the leaves [m]."""
    bending: float
    """EI of one leaf [N m^2]."""
    stretching: float
    """EA of one leaf [N]."""


def guide_of(hinge: Hinge) -> Guide:
    """The guide that a hinge is. Raises FlexureError for one that is none: the closed forms are of no other."""
    leaves = hinge.leaves
    if len(leaves) == 2 and all({leaf.start_body, leaf.end_body} == {GROUND, TIP} for leaf in leaves):
        one, two = (sorted((leaf.start, leaf.end)) for leaf in leaves)
        same = (leaves[0].width, leaves[0].thickness) == (leaves[1].width, leaves[1].thickness)
        level = all(abs(ends[0][1] - ends[1][1]) < 1e-9 for ends in (one, two)) and abs(one[0][1] + two[0][1]) < 1e-9
        aligned = abs(one[0][0] - two[0][0]) < 1e-9 and all(abs(e[1][0] - hinge.length) < 1e-9 for e in (one, two))
        if same and level and aligned and not any(leaf.profile for leaf in leaves) and one[0][1] != 0:
            leaf, modulus = leaves[0], hinge.material.effective_modulus
            area = leaf.width * leaf.thickness
            return Guide(leaf.length, 2 * abs(one[0][1]), modulus * area * leaf.thickness**2 / 12, modulus * area)
    raise FlexureError(f"{hinge.name} is no parallelogram: the closed forms need two equal uniform leaves side by "
                       "side, from the ground to the tip; take parallel-guide")  # fmt: skip


class GuideModel(Protocol):
    """What is asked of a closed form."""

    def poses(self, force: FloatArray, axial: float = 0.0) -> FloatArray:
        """(n, 3) x, y of the stage [m] and its turn [rad] under forces (n,) across and one along [N]."""

    def across(self, travel: FloatArray, axial: float = 0.0) -> FloatArray:
        """(n,) stiffness across at travels (n,) [N/m]."""

    def along(self, travel: FloatArray) -> FloatArray:
        """(n,) stiffness along at travels (n,) that are held [N/m]."""


@dataclass(frozen=True)
class BeamConstraint:
    """Beam constraint model: Awtar, Slocum and Sevincer, J. Mech. Des. 129, 2007, their parallelogram.

    f = (24 + 1.2 p) y,   x = p / (2 k33) - 0.6 y^2 + p y^2 / 1400,
    turn = (1 / k33 + y^2 / 700) y (12 + 0.1 p) / (2 w^2),   w = H / (2 L); x, y in units of L.
    """

    guide: Guide

    def poses(self, force: FloatArray, axial: float = 0.0) -> FloatArray:
        g = self.guide
        unit = g.length**2 / g.bending
        p, slender = axial * unit, self._slender
        y = force * unit / (24 + 1.2 * p)
        x = p / (2 * slender) - 0.6 * y**2 + p * y**2 / 1400
        turn = (1 / slender + y**2 / 700) * y * (12 + 0.1 * p) * 2 * (g.length / g.height) ** 2
        return np.column_stack([g.length * (1 + x), g.length * y, turn])

    def across(self, travel: FloatArray, axial: float = 0.0) -> FloatArray:
        g = self.guide
        unit = g.bending / g.length**3
        return np.full(len(travel), (24 + 1.2 * axial * g.length**2 / g.bending) * unit)

    def along(self, travel: FloatArray) -> FloatArray:
        g = self.guide
        return np.asarray(g.bending / g.length**3 / (1 / (2 * self._slender) + (travel / g.length) ** 2 / 1400))

    @property
    def _slender(self) -> float:
        return self.guide.stretching * self.guide.length**2 / self.guide.bending


@dataclass(frozen=True)
class PseudoRigid:
    """Pseudo-rigid body: two rigid links gamma L on four pins, each with a spring 2 gamma K_theta EI / L; no stretch.

    F = (4 K T + P gamma L sin T) / (gamma L cos T) at the links' angle T = asin(y / (gamma L)).
    """

    guide: Guide

    def poses(self, force: FloatArray, axial: float = 0.0) -> FloatArray:
        link, spring = self._sizes
        angle = np.zeros(len(force))
        for _ in range(ROUNDS):
            c, s = np.cos(angle), np.sin(angle)
            miss = 4 * spring * angle + (axial * s - force * c) * link
            step = miss / (4 * spring + (axial * c + force * s) * link)
            angle = angle - step
            if not np.abs(step).max() > 1e-12:
                break
        drop = link * (np.cos(angle) - 1)
        return np.column_stack([self.guide.length + drop, link * np.sin(angle), np.zeros(len(force))])

    def across(self, travel: FloatArray, axial: float = 0.0) -> FloatArray:
        link, spring = self._sizes
        angle = np.arcsin(travel / link)
        c = np.cos(angle)
        return np.asarray((4 * spring * (1 + angle * np.tan(angle)) + axial * link / c) / (link * c) ** 2)

    def along(self, travel: FloatArray) -> FloatArray:
        return np.full(len(travel), np.inf)

    @property
    def _sizes(self) -> tuple[float, float]:
        """Link [m] and spring of a pin [N m/rad]."""
        g = self.guide
        return CHARACTERISTIC * g.length, 2 * CHARACTERISTIC * SPRING * g.bending / g.length
