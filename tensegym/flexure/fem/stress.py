"""Stress at the extreme fibre of leaves: sigma = |N| / (w t) + 6 |M| / (w t^2), with the thickness where it is.

Nominal, as beam theory has it: at a circular notch the true peak is higher by about (1 + t / (2 r))^(9/20)
(Smith, Chetwynd and Bowen, J. Phys. E 20, 1987), at a clamp without fillet by what its corner makes of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.flexure.hinge import Hinge

from .beam import element
from .chain import AT, COS, EA, EI, L0, SIN
from .memory import Memory
from .mesh import Mesh


class Stress(NamedTuple):
    """The largest of a state, and where."""

    size: float
    """[Pa]."""
    leaf: int
    """Its number in the hinge, from 0."""
    share: float
    """Of the leaf's length, from its start."""


def largest_stress(hinge: Hinge, mesh: Mesh, mem: Memory) -> Stress:
    """The largest at any node of a state, as ``memory_at`` gives it."""
    found, out = [Stress(0.0, 0, 0.0)], np.zeros(20)
    for number, (leaf, (_, _, count, first)) in enumerate(zip(hinge.leaves, mesh.ends, strict=True)):
        real = mesh.real[number]
        shares = mesh.pieces[first : first + count + 1, AT] / leaf.length
        thickness = leaf.thickness_at(shares)
        forces = np.empty((count, 3))  # axial force, moments at both ends of every element
        for i in range(count):
            (x1, y1, turn1), (x2, y2, turn2) = mem.nodes[first + i], mem.nodes[first + i + 1]
            ea, ei, l0 = mesh.pieces[first + i, EA], mesh.pieces[first + i, EI], mesh.pieces[first + i, L0]
            element(x2 - x1, y2 - y1, turn1, turn2, l0, real[COS], real[SIN], ea, ei, 0.0, out)
            forces[i] = out[18], out[2], out[3]
        size = np.zeros(count + 1)
        for end, part in ((1, slice(0, count)), (2, slice(1, count + 1))):
            along = np.abs(forces[:, 0]) / (leaf.width * thickness[part])
            bent = 6 * np.abs(forces[:, end]) / (leaf.width * thickness[part] ** 2)
            size[part] = np.maximum(size[part], along + bent)
        worst = int(size.argmax())
        found.append(Stress(float(size[worst]), number, float(shares[worst])))
    return max(found)
