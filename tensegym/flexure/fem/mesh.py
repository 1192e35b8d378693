"""Mesh: a hinge as flat arrays, for the compiled FEM."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.flexure.hinge import GROUND, TIP, Hinge, Leaf
from tensegym.flexure.hinge.ranges import check_count

ELEMENTS = 16  # a leaf as long as the hinge: exact to the elastica within 3e-7 L
PROFILED = 4  # times as many where the thickness changes, whatever the leaf's length: there the error falls as h^2 only
FINE = 2001  # places at which a profile is looked at to lay out its elements
GAUSS = np.polynomial.legendre.leggauss(16)


class Mesh(NamedTuple):
    """A hinge as flat arrays. Body 0 is the ground, the last the tip; a body's pose is (x, y, turn) of its point."""

    ends: IntArray
    """(m, 4) of each leaf: start body, end body, number of elements, first node."""
    real: FloatArray
    """(m, 6) columns named in chain.py; AX..BY: leaf end from its body's point, in base axes at rest."""
    pieces: FloatArray
    """(k, 4) EA [N], EI [N m^2] and length [m] of the element after each node, and the node's distance along its leaf
    [m]; a leaf's last node repeats the element before."""
    rest: FloatArray
    """(b, 3) pose of every body at rest."""


def mesh_of(hinge: Hinge, elements: int = ELEMENTS) -> Mesh:
    """Flat arrays of a hinge; ``elements`` for a leaf as long as the hinge, others in proportion, 4 at least.

    A leaf with a profile has PROFILED times ``elements``.
    """
    check_count("elements", elements, 1, 2000, "16 is exact to the elastica within 3e-7 L")
    order = [GROUND, *(b for b in hinge.bodies if b not in (GROUND, TIP)), TIP]
    points: dict[str, list[tuple[float, float]]] = {body: [] for body in order}
    for leaf in hinge.leaves:
        points[leaf.start_body].append(leaf.start)
        points[leaf.end_body].append(leaf.end)
    rest = np.zeros((len(order), 3))
    for i, body in enumerate(order[1:-1], start=1):
        rest[i, :2] = np.mean(points[body], axis=0)
    rest[-1, 0] = hinge.length
    ends, real, pieces, first = [], [], [], 0
    modulus = hinge.material.effective_modulus
    for leaf in hinge.leaves:
        count = max(min(elements, 4), round(elements * leaf.length / hinge.length))
        if leaf.profile is not None:
            count = PROFILED * elements
        a, b = order.index(leaf.start_body), order.index(leaf.end_body)
        dx, dy = leaf.end[0] - leaf.start[0], leaf.end[1] - leaf.start[1]
        ends.append((a, b, count, first))
        real.append((dx / leaf.length, dy / leaf.length, leaf.start[0] - rest[a, 0],
                     leaf.start[1] - rest[a, 1], leaf.end[0] - rest[b, 0], leaf.end[1] - rest[b, 1]))  # fmt: skip
        pieces.append(_pieces(leaf, count, modulus))
        first += count + 1
    return Mesh(np.array(ends, dtype=np.int64), np.array(real), np.concatenate(pieces), rest)


def _pieces(leaf: Leaf, count: int, modulus: float) -> FloatArray:
    """(count + 1, 4): even and constant, or such that each element stretches and bends as its part of the profile.

    That is the harmonic mean over the element, exact under a constant force and moment. Elements are as long as the
    leaf is thick, in proportion: all are equally stiff, EI / l^3, and thick ends do not drown a thin web in rounding.
    """
    if leaf.profile is None:
        area, length = leaf.width * leaf.thickness, leaf.length / count
        same = [modulus * area, modulus * area * leaf.thickness**2 / 12, length]
        return np.column_stack([np.tile(same, (count + 1, 1)), np.arange(count + 1) * length])
    fine = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, FINE))
    density = 1 / leaf.thickness_at(fine)
    passed = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))])
    at = np.interp(np.linspace(0, passed[-1], count + 1), passed, fine)
    place, weight = GAUSS
    thickness = leaf.thickness_at(at[:-1, None] + np.diff(at)[:, None] * 0.5 * (1 + place))
    mean, cube = (1 / (1 / thickness**power @ (0.5 * weight)) for power in (1, 3))
    rows = np.column_stack([modulus * leaf.width * mean, modulus * leaf.width * cube / 12, leaf.length * np.diff(at)])
    return np.column_stack([np.concatenate([rows, rows[-1:]]), leaf.length * at])
