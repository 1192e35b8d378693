"""Equilibrium of tensegrities: self-stress, mechanisms, prestress, form finding.

Force density is a member's force over its length, tension positive [N/m]. A q = 0 with the equilibrium matrix A is the
balance of every node (Pellegrino and Calladine 1986, "Matrix analysis of statically and kinematically indeterminate
frameworks").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares, linprog
from scipy.spatial.transform import Rotation

from .errors import StructureError
from .structure import FloatArray, IntArray, Structure

RANK_TOLERANCE = 1e-9  # of the largest singular value
BALANCE_TOLERANCE = 1e-6  # of the tension: residual force a balanced node may show


def members(structure: Structure, stiff: bool = False) -> IntArray:
    """(m, 2) node pairs: elastic cables, then stiff cables when asked for, then rods."""
    parts = [structure.cables, structure.stiff_cables if stiff else np.zeros((0, 2), int), structure.rods]
    return np.concatenate(parts)


def equilibrium_matrix(structure: Structure, stiff: bool = False) -> FloatArray:
    """A (3n, m): times force densities (m,) it gives the members' pull on each node [N], xyz by xyz."""
    pairs = members(structure, stiff)
    matrix = np.zeros((len(structure.nodes), 3, len(pairs)))
    span = structure.nodes[pairs[:, 1]] - structure.nodes[pairs[:, 0]]
    columns = np.arange(len(pairs))
    matrix[pairs[:, 0], :, columns] = span
    matrix[pairs[:, 1], :, columns] -= span
    return matrix.reshape(-1, len(pairs))


@dataclass(frozen=True)
class StaticCount:
    """rank of the equilibrium matrix, self-stress states (m - rank), mechanisms (3n - 6 - rank), and an orthonormal
    basis of the self-stresses as force densities (m, states)."""

    rank: int
    self_stress_states: int
    mechanisms: int
    basis: FloatArray


def count_states(structure: Structure, stiff: bool = False) -> StaticCount:
    """Count self-stress states and mechanisms from the singular values of the equilibrium matrix."""
    matrix = equilibrium_matrix(structure, stiff)
    _, values, right = np.linalg.svd(matrix)
    rank = int((values > RANK_TOLERANCE * values[0]).sum())
    mechanisms = 3 * len(structure.nodes) - 6 - rank
    return StaticCount(rank, matrix.shape[1] - rank, mechanisms, right[rank:].T)


def feasible_self_stress(structure: Structure, stiff: bool = False) -> FloatArray | None:
    """Force densities (m,) with every cable pulling, mean 1 over the cables, the weakest as strong as can be; or None.

    A linear program: maximise s with A q = 0, q >= s on the cables, mean q = 1.
    """
    matrix = equilibrium_matrix(structure, stiff)
    cables = matrix.shape[1] - len(structure.rods)
    scale = np.abs(matrix).max()
    equalities = np.zeros((len(matrix) + 1, matrix.shape[1] + 1))
    equalities[:-1, :-1] = matrix / scale
    equalities[-1, :cables] = 1 / cables
    targets = np.zeros(len(equalities))
    targets[-1] = 1.0
    weakest = np.zeros((cables, matrix.shape[1] + 1))
    weakest[:, :cables] = -np.eye(cables)
    weakest[:, -1] = 1.0
    goal = np.zeros(matrix.shape[1] + 1)
    goal[-1] = -1.0
    solution = linprog(goal, A_ub=weakest, b_ub=np.zeros(cables), A_eq=equalities, b_eq=targets,
                       bounds=[(None, None)] * len(goal), method="highs")  # fmt: skip
    if not solution.success or solution.x[-1] <= 1e-9:
        return None
    return solution.x[:-1]


def out_of_balance(structure: Structure, tension: ArrayLike) -> FloatArray:
    """(n, 3) force [N] left on each node by these cable tensions (scalar or (c,)) and the best rod forces."""
    matrix = equilibrium_matrix(structure)
    count = len(structure.cables)
    densities = np.broadcast_to(tension, count) / structure.lengths(structure.cables)
    load = matrix[:, :count] @ densities
    rods, *_ = np.linalg.lstsq(matrix[:, count:], -load, rcond=None)
    return (load + matrix[:, count:] @ rods).reshape(-1, 3)


def check_balance(structure: Structure, tension: float) -> None:
    """Raise StructureError, naming the nodes, unless this tension [N] in every elastic cable balances."""
    left = np.linalg.norm(out_of_balance(structure, tension), axis=1)
    bad = np.flatnonzero(left > BALANCE_TOLERANCE * max(tension, 1e-9))
    if len(bad):
        named = ", ".join(f"{node + 1} ({left[node]:.3g} N)" for node in bad)
        reason = "these nodes have no self-stress" if feasible_self_stress(structure) is None else (
            "these nodes need unequal tensions")  # fmt: skip
        raise StructureError(
            f"a tension of {tension:g} N in every cable leaves nodes out of balance: {named}; {reason}. "
            "Move them, or let form finding do so (form_finding = true)"
        )


def form_find(structure: Structure, tension: float, payload_tension: float = 0.0) -> Structure:
    """Move rigid rods until this tension [N] in every elastic cable balances; stiff cables are slack.

    payload_tension: of one spring from every rod's middle to a common central body [N], in balance too. Solves for
    the net force and moment on each rod with least squares from the given nodes, then lays the result back onto them
    as well as a rigid motion can. Raises StructureError, naming the nodes out of balance, where that fails.
    """
    if tension <= 0:
        raise StructureError(f"tension = {tension!r} N must be above 0 for form finding")
    balance = _RodBalance(structure, tension, payload_tension)
    if np.abs(balance(balance.start)).max() <= 1e-12:
        return structure
    solution = least_squares(balance, balance.start, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=400)
    nodes = balance.nodes(solution.x)
    found = structure.with_nodes(_laid_onto(nodes, structure.nodes))
    left = np.abs(balance(solution.x)).reshape(-1, 3).max(axis=1)
    lengths = found.lengths(found.cables)
    if left.max() > BALANCE_TOLERANCE or lengths.min() < 0.05 * found.rod_lengths.min():
        worst = structure.rods[np.argsort(left[: len(structure.rods)])[::-1][:3]].ravel() + 1
        raise StructureError(
            f"form finding found no shape that {tension:g} N in every cable balances; furthest out are nodes "
            f"{', '.join(map(str, worst))}. Start nearer a tensegrity, or change the cables"
        )
    return found


class _RodBalance:
    """Residuals of rigid rods: net force and the moment's part across the rod, over the tension; shape (6 r + 3,)."""

    def __init__(self, structure: Structure, tension: float, payload_tension: float) -> None:
        self.structure, self.payload = structure, payload_tension / tension
        self.half = structure.rod_lengths[:, None] / 2
        ends = structure.nodes[structure.rods]
        self.count = len(ends)
        middles = ends.mean(axis=1)
        self.start = np.concatenate([middles.ravel(), (ends[:, 1] - ends[:, 0]).ravel(), middles.mean(axis=0)])

    def _unpack(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        middles, axes, centre = np.split(x, [3 * self.count, 6 * self.count])
        axes = axes.reshape(-1, 3)
        return middles.reshape(-1, 3), axes / np.linalg.norm(axes, axis=1)[:, None], centre

    def nodes(self, x: FloatArray) -> FloatArray:
        middles, axes, _ = self._unpack(x)
        nodes = np.empty_like(self.structure.nodes)
        nodes[self.structure.rods[:, 0]] = middles - self.half * axes
        nodes[self.structure.rods[:, 1]] = middles + self.half * axes
        return nodes

    def __call__(self, x: FloatArray) -> FloatArray:
        middles, axes, centre = self._unpack(x)
        nodes = self.nodes(x)
        pairs = self.structure.cables
        span = nodes[pairs[:, 1]] - nodes[pairs[:, 0]]
        pull = span / np.linalg.norm(span, axis=1)[:, None]
        force = np.zeros_like(nodes)
        np.add.at(force, pairs[:, 0], pull)
        np.add.at(force, pairs[:, 1], -pull)
        first, second = force[self.structure.rods[:, 0]], force[self.structure.rods[:, 1]]
        inward = np.zeros_like(middles)
        if self.payload:
            inward = centre - middles
            inward *= self.payload / np.linalg.norm(inward, axis=1)[:, None]
        moment = np.cross(axes, second - first)
        on_centre = -inward.sum(axis=0) if self.payload else centre - middles.mean(axis=0)
        return np.concatenate([(first + second + inward).ravel(), moment.ravel(), on_centre])


def _laid_onto(nodes: FloatArray, target: FloatArray) -> FloatArray:
    centre, goal = nodes.mean(axis=0), target.mean(axis=0)
    turn, _ = Rotation.align_vectors(target - goal, nodes - centre)
    return turn.apply(nodes - centre) + goal
