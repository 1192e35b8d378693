"""Free modes of rigid rods held by prestressed cables.

Linearised about equilibrium: a cable of stiffness k, length l, tension T and direction u resists relative end motion
with k u u^T + (T / l)(I - u u^T) (Guest 2006, "The stiffness of prestressed frameworks: a unifying approach"). Each
rod has three translations and two turns across its axis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import eigh

from tensegym.arrays import FloatArray

from .structure import Structure


@dataclass(frozen=True)
class Modes:
    """Free vibrations, without the six rigid motions."""

    frequencies: FloatArray
    """(k,) ascending [Hz]."""
    shapes: FloatArray
    """(k, n, 3) node displacements, mass-normalised."""

    def multiplicities(self, tolerance: float = 1e-3) -> list[tuple[float, int]]:
        """Frequencies [Hz] that agree within ``tolerance`` (relative), with how often each occurs."""
        groups: list[list[float]] = []
        for f in self.frequencies.tolist():
            if groups and f - groups[-1][0] <= tolerance * f:
                groups[-1].append(f)
            else:
                groups.append([f])
        return [(float(np.mean(g)), len(g)) for g in groups]


def free_modes(
    structure: Structure, tension: ArrayLike, stiffness: ArrayLike, masses: ArrayLike, transverse_inertias: ArrayLike
) -> Modes:
    """Modes in free flight.

    Args:
        structure: in balance under the tensions.
        tension: of the elastic cables, scalar or (c,) [N].
        stiffness: of the elastic cables, scalar or (c,) [N/m].
        masses: of the rods, scalar or (r,) [kg].
        transverse_inertias: of the rods about their centres, across their axes, scalar or (r,) [kg m^2].
    """
    stiff = _node_stiffness(structure, tension, stiffness)
    to_nodes, mass = _rod_coordinates(structure, masses, transverse_inertias)
    reduced = to_nodes.T @ stiff @ to_nodes + _rod_geometric(structure, tension)
    values, vectors = eigh(reduced, mass)
    elastic = slice(6, None)  # the six rigid motions come first, at zero
    shapes = (to_nodes @ vectors[:, elastic]).T.reshape(-1, len(structure.nodes), 3)
    return Modes(np.sqrt(np.clip(values[elastic], 0, None)) / (2 * np.pi), shapes)


def breathing_frequency(tension: float, mass: float, cable_length: float) -> float:
    """Breathing mode of six equal rods: w^2 = 8 T / (m l), whatever the stiffness.

    Args:
        tension: of every elastic cable [N].
        mass: of a rod [kg].
        cable_length: of every elastic cable [m].

    Returns:
        Frequency [Hz].
    """
    return float(np.sqrt(8 * tension / (mass * cable_length)) / (2 * np.pi))


def _cable_directions(structure: Structure) -> tuple[FloatArray, FloatArray]:
    span = structure.nodes[structure.cables[:, 1]] - structure.nodes[structure.cables[:, 0]]
    lengths = np.linalg.norm(span, axis=1)
    return span / lengths[:, None], lengths


def _node_stiffness(structure: Structure, tension: ArrayLike, stiffness: ArrayLike) -> FloatArray:
    """(3n, 3n) tangent stiffness of the cables [N/m]."""
    directions, lengths = _cable_directions(structure)
    count = len(structure.cables)
    tensions, rates = np.broadcast_to(tension, count), np.broadcast_to(stiffness, count)
    matrix = np.zeros((len(structure.nodes), 3, len(structure.nodes), 3))
    for (a, b), u, length, t, k in zip(structure.cables, directions, lengths, tensions, rates, strict=True):
        block = (k - t / length) * np.outer(u, u) + t / length * np.eye(3)
        matrix[a, :, a] += block
        matrix[b, :, b] += block
        matrix[a, :, b] -= block
        matrix[b, :, a] -= block
    return matrix.reshape(3 * len(structure.nodes), -1)


def _rod_coordinates(
    structure: Structure, masses: ArrayLike, inertias: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Node displacements (3n, 5r) for unit rod translations and turns, and the mass matrix (5r, 5r)."""
    rods = structure.rods
    m, i = np.broadcast_to(masses, len(rods)), np.broadcast_to(inertias, len(rods))
    to_nodes = np.zeros((len(structure.nodes), 3, len(rods), 5))
    mass = np.zeros((len(rods), 5, len(rods), 5))
    for r, (a, b) in enumerate(rods):
        axis = structure.nodes[b] - structure.nodes[a]
        across = _across(axis)
        for node, side in ((a, -0.5), (b, 0.5)):
            to_nodes[node, :, r, :3] = np.eye(3)
            to_nodes[node, :, r, 3:] = np.cross(across, side * axis).T
        mass[r, :, r] = np.diag([m[r]] * 3 + [i[r]] * 2)
    return to_nodes.reshape(3 * len(structure.nodes), -1), mass.reshape(5 * len(rods), -1)


def _rod_geometric(structure: Structure, tension: ArrayLike) -> FloatArray:
    """(5r, 5r): turning a rod moves its ends towards its middle to second order, against the compression it carries."""
    directions, _ = _cable_directions(structure)
    tensions = np.broadcast_to(tension, len(structure.cables))
    force = np.zeros_like(structure.nodes)
    np.add.at(force, structure.cables[:, 0], tensions[:, None] * directions)
    np.add.at(force, structure.cables[:, 1], -tensions[:, None] * directions)
    matrix = np.zeros((len(structure.rods), 5, len(structure.rods), 5))
    for r, (a, b) in enumerate(structure.rods):
        half = (structure.nodes[b] - structure.nodes[a]) / 2
        across = force[b] @ half - force[a] @ half
        matrix[r, 3:, r, 3:] = across * np.eye(2)
    return matrix.reshape(5 * len(structure.rods), -1)


def _across(axis: FloatArray) -> FloatArray:
    """Two unit vectors (2, 3) across ``axis`` and each other."""
    _, _, basis = np.linalg.svd(axis[None])
    return basis[1:]
