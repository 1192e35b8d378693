"""Stiffness of a hinge out of its plane: an approximation, linear about the deformed shape.

Every element of the planar FEM, where it stands, is a beam: bending and shear in the leaf's own plane, E t w^3/12 and
5/6 G t w, and torsion with its warping, G J with J of a rectangle and E C with C = t^3 w^3/144 (Vlasov). Bodies are
rigid and let no leaf warp at its ends, which stiffens the torsion of a straight one by 1 / (1 - tanh(z) / z),
z = L/2 sqrt(G J / (E C)). Left out: what axial forces add, and the plate that a leaf as wide as long is;
docs/flexure.md has the error against a solid.
"""

from __future__ import annotations

import math

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.flexure.hinge import Hinge, Leaf

from .chain import AT
from .memory import Memory
from .mesh import Mesh

SHEAR = 5 / 6  # of a rectangle's area
BENT, TWISTED = (0, 2, 4, 6), (1, 3, 5, 7)  # of an element's z, twist, slope and twist rate at both ends


def out_of_plane_stiffness(hinge: Hinge, mesh: Mesh, mem: Memory) -> FloatArray:
    """(3, 3) force z [N] and moments about x and y [N m] at the tip over its z [m] and turns about x and y [rad].

    Args:
        hinge, mesh, mem: a state, as ``memory_at`` gives it. Base axes, z towards the viewer.
    """
    own = 3 * (len(mesh.rest) - 1)  # places of the bodies: z and two turns; every node inside has its twist rate too
    whole = np.zeros((own + 4 * len(mem.nodes), own + 4 * len(mem.nodes)))
    for leaf, (a, b, count, first) in zip(hinge.leaves, mesh.ends, strict=True):
        maps = [(own + 4 * (first + i), np.eye(4)) for i in range(count + 1)]
        for body, i in ((a, 0), (b, count)):
            x, y = mem.nodes[first + i, :2] - mem.poses[body, :2]
            carried = np.array([[1.0, y, -x], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
            maps[i] = (3 * (body - 1), carried)
        at = mesh.pieces[first : first + count + 1, AT] / leaf.length
        thickness = leaf.thickness_at(0.5 * (at[:-1] + at[1:]))
        for i in range(count):
            chord = mem.nodes[first + i + 1, :2] - mem.nodes[first + i, :2]
            part = _element(hinge, leaf, float(thickness[i]), chord)
            ends = [(row, half, carried) for half, (row, carried) in ((0, maps[i]), (4, maps[i + 1])) if row >= 0]
            for row, p, left in ends:
                for column, q, right in ends:
                    block = left.T @ part[p : p + 4, q : q + 4] @ right
                    whole[row : row + left.shape[1], column : column + right.shape[1]] += block
    used = np.flatnonzero(whole.diagonal())
    kept, tip = whole[np.ix_(used, used)], slice(own - 3, own)
    flexibility = np.linalg.solve(kept, np.eye(len(kept))[:, tip])[tip]
    return np.asarray(np.linalg.inv(flexibility))


def _element(hinge: Hinge, leaf: Leaf, thickness: float, chord: FloatArray) -> FloatArray:
    """(8, 8) over z, turn about x and about y, twist rate of both ends, base axes."""
    material, length, width = hinge.material, math.hypot(*chord), leaf.width
    young = material.factor * material.youngs_modulus  # of a wide leaf in its own plane: no plate
    shear = young / (2 * (1 + material.poisson_ratio))
    bending, across = young * thickness * width**3 / 12, SHEAR * shear * thickness * width
    phi = 12 * bending / (across * length**2)
    thin, wide = sorted((thickness, width))
    torsion = shear * thin**3 * wide * (1 / 3 - 0.21 * thin / wide * (1 - thin**4 / (12 * wide**4)))
    warping = young * (thickness * width) ** 3 / 144
    local = np.zeros((8, 8))
    local[np.ix_(BENT, BENT)] = bending / (length**3 * (1 + phi)) * _cubic(length, phi)
    local[np.ix_(TWISTED, TWISTED)] = warping / length**3 * _cubic(length, 0.0) + torsion / (30 * length) * np.array(
        [[36, 3 * length, -36, 3 * length], [3 * length, 4 * length**2, -3 * length, -(length**2)],
         [-36, -3 * length, 36, -3 * length], [3 * length, -(length**2), -3 * length, 4 * length**2]]
    )  # fmt: skip
    c, s = chord / length
    turn = np.array([[1, 0, 0, 0], [0, c, s, 0], [0, s, -c, 0], [0, 0, 0, 1]])  # dz/ds is less the turn about (-s, c)
    both = np.kron(np.eye(2), turn)
    return np.asarray(both.T @ local @ both)


def _cubic(length: float, phi: float) -> FloatArray:
    """(4, 4) of a beam's deflection and slope at both ends, with the shear's share phi."""
    one, two, mixed = 6 * length, (4 + phi) * length**2, (2 - phi) * length**2
    return np.array([[12, one, -12, one], [one, two, -one, mixed], [-12, -one, 12, -one], [one, mixed, -one, two]])
