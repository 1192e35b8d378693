"""Rotations that map a robot onto itself, as permutations of its nodes, rods, cables and drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray

from .design import RobotDesign


@dataclass(frozen=True)
class Symmetry:
    """One rotation. Arrays say where each goes: node i takes the place of node nodes[i], and so on.

    rod_flips (r,) is -1 where a rod lands with its ends exchanged. cables covers the kernel's order: elastic, stiff,
    payload. rotation (3, 3) acts on positions about the structure's centre of mass.
    """

    nodes: IntArray
    rods: IntArray
    rod_flips: IntArray
    cables: IntArray
    drives: IntArray
    rotation: FloatArray


def symmetries(design: RobotDesign, tolerance: float = 1e-6) -> list[Symmetry]:
    """The rotation group of a design, identity first; for the six-rod robot with three active rods it has order 3."""
    structure = design.standing
    masses = np.array([design.rod(i).mass for i in range(len(structure.rods))])
    split = np.isin(np.arange(len(structure.rods)), design.flexible_rods)
    weights = np.zeros(len(structure.nodes))
    np.add.at(weights, structure.rods, (masses / 2)[:, None])
    nodes = structure.nodes - weights @ structure.nodes / weights.sum()
    triple = list(_independent_triple(nodes))
    images = np.array(list(permutations(range(len(nodes)), 3)))
    products = nodes @ nodes.T
    same = np.isclose(products[images[:, :, None], images[:, None]], products[np.ix_(triple, triple)], atol=tolerance)
    found, hand = [], np.linalg.det(nodes[triple])
    for target in images[same.all(axis=(1, 2))]:
        if np.linalg.det(nodes[target]) * hand < 0:  # a mirror image, onto which no rotation takes the three
            continue
        turn = Rotation.align_vectors(nodes[target], nodes[triple])[0].as_matrix()
        distances = np.linalg.norm((nodes @ turn.T)[:, None] - nodes, axis=2)
        perm = distances.argmin(axis=1)
        if distances.min(axis=1).max() > tolerance or len(set(perm)) < len(perm):
            continue
        symmetry = _induced(design, perm, turn)
        if (symmetry and np.allclose(masses[symmetry.rods], masses) and (split[symmetry.rods] == split).all()
                and all((kinds[images] == kinds).all() for kinds, images in _kinds(design, symmetry))):  # fmt: skip
            found.append(symmetry)
    return sorted(found, key=lambda s: (not np.array_equal(s.nodes, np.arange(len(nodes))), tuple(s.nodes)))


def _kinds(design: RobotDesign, symmetry: Symmetry) -> list[tuple[IntArray, IntArray]]:
    """Numbers that tell rods, elastic cables and drives by what they are, and where each of them goes."""
    drives = list(zip(design.each_drive, design.each_stiff_cable, strict=True))
    members: tuple[tuple[Sequence[object], IntArray], ...] = (
        (design.each_rod if design.rods else (), symmetry.rods),
        (design.each_cable, symmetry.cables[: len(design.each_cable)]), (drives, symmetry.drives),
    )  # fmt: skip
    return [(np.array([kinds.index(kind) for kind in kinds], dtype=np.int64), images[: len(kinds)])
            for kinds, images in members]


def _independent_triple(nodes: FloatArray) -> tuple[int, int, int]:
    for triple in permutations(range(len(nodes)), 3):
        if abs(np.linalg.det(nodes[list(triple)])) > 1e-6 * np.abs(nodes).max() ** 3:
            return triple
    raise ValueError("all nodes lie in one plane through the centre of mass")


def _induced(design: RobotDesign, perm: IntArray, turn: FloatArray) -> Symmetry | None:
    """The permutations of members that a permutation of nodes makes, or None where it maps one onto none."""
    structure = design.standing
    rods = _map_members(structure.rods, perm, directed=False)
    elastic = _map_members(structure.cables, perm, directed=False)
    stiff = _map_members(structure.stiff_cables, perm, directed=True)
    if rods is None or elastic is None or stiff is None:
        return None
    flips = np.where((perm[structure.rods] == structure.rods[rods]).all(axis=1), 1, -1)
    cables = [elastic, len(elastic) + stiff]
    if design.payload:
        cables.append(len(elastic) + len(stiff) + rods)
    return Symmetry(perm, rods, flips, np.concatenate(cables), stiff, turn)


def _map_members(members: IntArray, perm: IntArray, directed: bool) -> IntArray | None:
    place = {}
    for row, (a, b) in enumerate(members.tolist()):
        place[a, b] = row
        if not directed:
            place[b, a] = row
    try:
        return np.array([place[a, b] for a, b in perm[members].tolist()], dtype=np.int64)
    except KeyError:
        return None
