"""Random tensegrities as tables of a design file: prisms, expanded octahedra, bodies of rods at random, twelve rods."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from numpy.random import Generator
from scipy.spatial import ConvexHull

from tensegym.arrays import FloatArray
from tensegym.structure.structure import six_rod

Table = dict[str, Any]


def log_uniform(rng: Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def cables_and_masses(rng: Generator) -> Table:
    """Tensions over a factor of 60, stiffnesses over 30, masses of rods' ends over 100."""
    return {
        "elastic_cable": {"pretension": log_uniform(rng, 1, 60), "stiffness": log_uniform(rng, 100, 3000)},
        "passive_rod": {"tube_mass": log_uniform(rng, 0.01, 0.1), "end_mass": log_uniform(rng, 0.01, 1.0)},
    }


def prism(rods: int, radius: float, height: float, twist: float, skip: int = 1) -> Table:
    """Cables around both ends and up the sides; a rod leads from a node to the one ``skip`` beside that above it."""
    around = 2 * np.pi * np.arange(rods) / rods
    rings = [np.column_stack([radius * np.cos(around + t), radius * np.sin(around + t), np.full(rods, z)])
             for t, z in ((0.0, 0.0), (twist, height))]  # fmt: skip
    ring = [[i + 1, (i + 1) % rods + 1] for i in range(rods)]
    return {
        "nodes": np.concatenate(rings).tolist(), "stiff_cables": [],
        "rods": [[i + 1, rods + (i + skip) % rods + 1] for i in range(rods)],
        "cables": ring + [[a + rods, b + rods] for a, b in ring] + [[i + 1, rods + i + 1] for i in range(rods)],
    }  # fmt: skip


def random_prism(rng: Generator, rods: int) -> Table:
    """Within 60 degrees of the twist of 90 (1 - 2 skip / rods) degrees at which it can balance (Connelly and Terrell
    1995, "Globally rigid symmetric tensegrities")."""
    skip = int(rng.integers(1, (rods + 1) // 2))
    twist = np.pi / 2 - skip * np.pi / rods + rng.uniform(-1, 1) * np.pi / 3
    return {"structure": prism(rods, rng.uniform(0.15, 0.4), rng.uniform(0.15, 0.7), twist, skip)}


def random_octahedron(rng: Generator) -> Table:
    """Six rods of the expanded octahedron, its nodes moved, every other one with a payload."""
    structure = six_rod(rng.uniform(0.4, 1.0))
    nodes = structure.nodes + rng.normal(size=(12, 3)) * structure.rod_lengths.max() * rng.choice([0, 0.03, 0.08])
    table: Table = {"structure": _members(nodes, structure.rods + 1, structure.cables + 1)}
    if rng.random() < 0.5:
        table["payload"] = {"mass": log_uniform(rng, 0.1, 2), "stiffness": log_uniform(rng, 50, 500),
                            "pretension": log_uniform(rng, 1, 8)}  # fmt: skip
    return table


def random_body(rng: Generator) -> Table | None:
    """Four to eight rods between nodes spread over a sphere, matched at random, and cables along the hull's edges; None
    where no match is left."""
    count = 2 * int(rng.integers(4, 9))
    nodes = rng.normal(size=(count, 3))
    for _ in range(60):
        nodes /= np.linalg.norm(nodes, axis=1)[:, None]
        apart = nodes[:, None] - nodes
        nodes = nodes + 0.05 * (apart / ((apart**2).sum(axis=2) + np.eye(count))[:, :, None] ** 1.5).sum(axis=1)
    nodes *= rng.uniform(0.2, 0.5) / np.linalg.norm(nodes, axis=1)[:, None]
    corners = ConvexHull(nodes).simplices.tolist()
    edges = sorted({(min(t[i], t[i - 1]), max(t[i], t[i - 1])) for t in corners for i in range(3)})
    free, rods = rng.permutation(count).tolist(), []
    while free:
        first = free.pop()
        across = [node for node in free if (min(first, node), max(first, node)) not in edges]
        if not across:
            return None
        rods.append((first, across[int(rng.integers(len(across)))]))
        free.remove(rods[-1][1])
    return {"structure": _members(nodes, np.array(rods) + 1, np.array(edges) + 1)}


def random_twelve_rods(rng: Generator) -> Table:
    """A truncated cube: a node towards each edge of each corner, and a rod along every edge, from one side of it at the
    one corner to the other side of it at the other."""
    size, turn, depth = rng.uniform(0.2, 0.4), rng.uniform(0.05, 0.4), rng.uniform(0.1, 0.4)
    place: dict[tuple[tuple[int, ...], int], int] = {}
    nodes, rods, cables = [], [], []
    corners = list(product((-1, 1), repeat=3))
    for corner, axis in product(corners, range(3)):
        place[corner, axis] = len(nodes) + 1
        node = size * np.array(corner, float)
        node[axis] *= 1 - depth
        node[(axis + (1 if np.prod(corner) < 0 else 2)) % 3] *= 1 - turn
        nodes.append(node)
    for corner, axis in product(corners, range(3)):
        other = tuple(-side if n == axis else side for n, side in enumerate(corner))
        cables.append([place[corner, axis], place[corner, (axis + 1) % 3]])
        if corner[axis] < 0:
            cables.append([place[corner, axis], place[other, axis]])
        if np.prod(corner) < 0:
            rods.append([place[corner, (axis + 2) % 3], place[other, (axis + 1) % 3]])
    return {"structure": _members(np.array(nodes), np.array(rods), np.array(cables))}


def _members(nodes: FloatArray, rods: Any, cables: Any) -> Table:
    """Members by node numbers from 1."""
    return {"nodes": nodes.tolist(), "rods": rods.tolist(), "cables": cables.tolist(), "stiff_cables": []}
