"""Stiffness of a hinge out of its plane: an approximation, linear about the deformed shape.

Every element of the planar FEM, where it stands, is a beam: bending and shear in the leaf's own plane, E t w^3/12 and
5/6 G t w, and torsion, G J with J of a rectangle. Bodies are rigid. Clamped ends hinder the warping of a wide leaf,
which stiffens its torsion by 1 / (1 - tanh(z) / z), z = L/w sqrt(12 G / E) (Vlasov; a strip's warping constant is
t^3 w^3 / 144). Left out: what axial forces add, and the plate that a leaf as wide as long is; docs/flexure.md has the
error against a solid.
"""

from __future__ import annotations

import math

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.flexure.hinge import Hinge, Leaf

from .memory import Memory
from .mesh import Mesh

SHEAR = 5 / 6  # of a rectangle's area


def out_of_plane_stiffness(hinge: Hinge, mesh: Mesh, mem: Memory) -> FloatArray:
    """(3, 3) force z [N] and moments about x and y [N m] at the tip over its z [m] and turns about x and y [rad].

    Args:
        hinge, mesh, mem: a state, as ``memory_at`` gives it. Base axes, z towards the viewer.
    """
    bodies = len(mesh.rest) - 1
    inner = mem.nodes.shape[0]  # a place for every node; ends are bodies' and keep theirs empty
    whole = np.zeros((3 * (inner + bodies), 3 * (inner + bodies)))
    for leaf, (a, b, count, first) in zip(hinge.leaves, mesh.ends, strict=True):
        maps = [(3 * (first + i), np.eye(3)) for i in range(count + 1)]
        for body, i in ((a, 0), (b, count)):
            x, y = mem.nodes[first + i, :2] - mem.poses[body, :2]
            carried = np.array([[1.0, y, -x], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
            maps[i] = (3 * (inner + body - 1), carried) if body else (-1, carried)
        thickness = leaf.thickness_at((np.arange(count) + 0.5) / count)
        for i in range(count):
            chord = mem.nodes[first + i + 1, :2] - mem.nodes[first + i, :2]
            part = _element(hinge, leaf, float(thickness[i]), chord)
            ends = [(row, half, carried) for half, (row, carried) in ((0, maps[i]), (3, maps[i + 1])) if row >= 0]
            for row, p, left in ends:
                for column, q, right in ends:
                    whole[row : row + 3, column : column + 3] += left.T @ part[p : p + 3, q : q + 3] @ right
    used = np.flatnonzero(whole.diagonal())
    kept = whole[np.ix_(used, used)]
    tip = slice(len(kept) - 3, None)
    flexibility = np.linalg.solve(kept, np.eye(len(kept))[:, tip])[tip]
    return np.asarray(np.linalg.inv(flexibility))


def _element(hinge: Hinge, leaf: Leaf, thickness: float, chord: FloatArray) -> FloatArray:
    """(6, 6) over z, turn about x and about y of both ends, base axes."""
    material = hinge.material
    young = material.factor * material.youngs_modulus  # of a wide leaf in its own plane: no plate
    shear = young / (2 * (1 + material.poisson_ratio))
    length, width = math.hypot(*chord), leaf.width
    bending, across = young * thickness * width**3 / 12, SHEAR * shear * thickness * width
    phi = 12 * bending / (across * length**2)
    k = bending / (length**3 * (1 + phi))
    one, two = 6 * k * length, (4 + phi) * k * length**2
    mixed = (2 - phi) * k * length**2
    thin, wide = sorted((thickness, width))
    torsion = shear * thin**3 * wide * (1 / 3 - 0.21 * thin / wide * (1 - thin**4 / (12 * wide**4)))
    z = leaf.length / width * math.sqrt(12 * shear / young)
    twist = torsion / (1 - math.tanh(z) / z) / length
    # z, twist about the chord, slope along it, of both ends
    local = np.array([[12 * k, 0, one, -12 * k, 0, one], [0, twist, 0, 0, -twist, 0], [one, 0, two, -one, 0, mixed],
                      [-12 * k, 0, -one, 12 * k, 0, -one], [0, -twist, 0, 0, twist, 0],
                      [one, 0, mixed, -one, 0, two]])  # fmt: skip
    c, s = chord / length
    turn = np.array([[1, 0, 0], [0, c, s], [0, s, -c]])  # the slope dz/ds is less the turn about (-s, c)
    both = np.kron(np.eye(2), turn)
    return np.asarray(both.T @ local @ both)
