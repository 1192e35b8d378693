"""Equilibrium of tensegrities: self-stress, mechanisms, prestress.

Force density is a member's force over its length, tension positive [N/m]. A q = 0 with the equilibrium matrix A is the
balance of every node (Pellegrino and Calladine 1986, "Matrix analysis of statically and kinematically indeterminate
frameworks").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import linprog

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import ShapeError, StructureError

from .structure import Structure

RANK_TOLERANCE = 1e-9  # of the largest singular value
BALANCE_TOLERANCE = 1e-6  # of the tension: residual force a balanced node may show


def members(structure: Structure, stiff: bool = False) -> IntArray:
    """(m, 2) node pairs: elastic cables, then stiff cables when asked for, then rods."""
    parts = [structure.cables, structure.stiff_cables if stiff else np.zeros((0, 2), int), structure.rods]
    return np.concatenate(parts)


def equilibrium_matrix(structure: Structure, stiff: bool = False) -> FloatArray:
    """Equilibrium matrix A: times force densities it gives the members' pull on each node.

    Args:
        structure: n nodes and their members.
        stiff: whether the stiff cables are members too.

    Returns:
        (3n, m) [m], rows xyz by xyz, columns in the order of `members`.
    """
    pairs = members(structure, stiff)
    matrix = np.zeros((len(structure.nodes), 3, len(pairs)))
    span = structure.nodes[pairs[:, 1]] - structure.nodes[pairs[:, 0]]
    columns = np.arange(len(pairs))
    matrix[pairs[:, 0], :, columns] = span
    matrix[pairs[:, 1], :, columns] -= span
    return matrix.reshape(-1, len(pairs))


@dataclass(frozen=True)
class StaticCount:
    """How many self-stresses and mechanisms a structure of n nodes and m members has."""

    rank: int
    """Of the equilibrium matrix."""
    self_stress_states: int
    """m - rank."""
    mechanisms: int
    """3n - 6 - rank."""
    basis: FloatArray
    """(m, states) orthonormal self-stresses, as force densities."""


def count_states(structure: Structure, stiff: bool = False) -> StaticCount:
    """Count self-stress states and mechanisms from the singular values of the equilibrium matrix."""
    matrix = equilibrium_matrix(structure, stiff)
    _, values, right = np.linalg.svd(matrix)
    rank = int((values > RANK_TOLERANCE * values[0]).sum())
    mechanisms = 3 * len(structure.nodes) - 6 - rank
    return StaticCount(rank, matrix.shape[1] - rank, mechanisms, right[rank:].T)


def feasible_self_stress(structure: Structure, stiff: bool = False) -> FloatArray | None:
    """A self-stress in which every cable pulls and the weakest pulls as strongly as can be.

    A linear program: maximise s with A q = 0, q >= s on the cables, mean q = 1 over the cables.

    Args:
        structure: what is stressed.
        stiff: whether the stiff cables are members too.

    Returns:
        (m,) force densities in the order of `members`, or None where there is no such self-stress.
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
    """Force that cable tensions and the rod forces that balance them best leave on each node.

    Args:
        structure: what is stressed.
        tension: of the elastic cables, scalar or (c,) [N].

    Returns:
        (n, 3) [N].
    """
    matrix = equilibrium_matrix(structure)
    count = len(structure.cables)
    densities = np.broadcast_to(tension, count) / structure.lengths(structure.cables)
    load = matrix[:, :count] @ densities
    rods, *_ = np.linalg.lstsq(matrix[:, count:], -load, rcond=None)
    return (load + matrix[:, count:] @ rods).reshape(-1, 3)


def holding_tensions(structure: Structure, wanted: FloatArray, payload_tension: float = 0.0) -> FloatArray:
    """Tensions of the elastic cables that hold the nodes as they are, nearest to the ``wanted`` ones.

    The sum of their squared differences is least over the self-stresses; where some of those would push, the
    self-stress whose weakest cable pulls most takes their place, at the same mean.

    Args:
        structure: what is held.
        wanted: (c,) [N].
        payload_tension: in one spring from every rod's middle to a common central body [N], in balance too.

    Returns:
        (c,) [N], above 0.

    Raises:
        ShapeError: no tensions do; it says why.
    """
    pairs, count = members(structure), len(structure.cables)
    lengths = structure.lengths(pairs)
    matrix = equilibrium_matrix(structure) / lengths
    inward = _payload_pull(structure, payload_tension)
    _, values, right = np.linalg.svd(matrix)
    rank = int((values > RANK_TOLERANCE * values[0]).sum())
    first, states = np.linalg.lstsq(matrix, -inward.ravel(), rcond=RANK_TOLERANCE)[0], right[rank:].T
    out = np.abs(matrix @ first + inward.ravel()).max()
    if out > BALANCE_TOLERANCE * wanted.max(initial=payload_tension):
        raise ShapeError(f"no tensions hold these nodes with the payload's pull of {payload_tension:g} N: {out:.2g} N "
                         "are left; move them, or let form finding do so")  # fmt: skip
    best = np.linalg.lstsq(states[:count], wanted - first[:count], rcond=None)[0]
    found: FloatArray = (first + states @ best)[:count]
    if count and found.min() <= 0.01 * wanted.min():
        weakest = feasible_self_stress(structure) if not payload_tension else None
        if weakest is None:
            raise ShapeError("no tensions hold these nodes: they have no self-stress in which every cable pulls; move "
                             "them, or let form finding do so")  # fmt: skip
        found = weakest[:count] * lengths[:count]
        found *= wanted.mean() / found.mean()
    return found


def _payload_pull(structure: Structure, tension: float) -> FloatArray:
    """(n, 3) what springs from the rods' middles to the middle of those come to at the rods' ends [N]."""
    pull = np.zeros_like(structure.nodes)
    if tension:
        middles = structure.nodes[structure.rods].mean(axis=1)
        inward = middles.mean(axis=0) - middles
        pull[structure.rods] = (tension / 2 * inward / np.linalg.norm(inward, axis=1)[:, None])[:, None]
    return pull


def in_words(tension: ArrayLike) -> str:
    """Tensions [N] of all cables, for messages."""
    low, high = float(np.min(tension, initial=np.inf)), float(np.max(tension, initial=0.0))
    return f"a tension of {high:g} N in every cable" if low >= high else f"one of {low:g} to {high:g} N in the cables"


def compressions(structure: Structure, tension: FloatArray) -> FloatArray:
    """(r,) force along each rod under tensions (c,) [N] of the elastic cables, positive in compression [N]; of rods
    that share no node."""
    nodes, cables = structure.nodes, structure.cables
    span = nodes[cables[:, 1]] - nodes[cables[:, 0]]
    pull = (tension / np.linalg.norm(span, axis=1))[:, None] * span
    forces = np.zeros_like(nodes)
    np.add.at(forces, cables[:, 0], pull)
    np.add.at(forces, cables[:, 1], -pull)
    first, last = structure.rods.T
    along = (nodes[last] - nodes[first]) / structure.rod_lengths[:, None]
    return np.asarray(((forces[first] - forces[last]) * along).sum(axis=1) / 2, dtype=float)


def shared_compressions(structure: Structure, tension: ArrayLike) -> FloatArray:
    """(r,) force along each rod that balances tensions [N] of the elastic cables best, positive in compression [N]; for
    rods that share nodes, on which they divide what cables do there."""
    matrix, count = equilibrium_matrix(structure), len(structure.cables)
    pull = matrix[:, :count] @ (np.broadcast_to(tension, count) / structure.lengths(structure.cables))
    densities = np.linalg.lstsq(matrix[:, count:], pull, rcond=None)[0]
    return np.asarray(densities * structure.rod_lengths, dtype=float)


def check_balance(structure: Structure, tension: ArrayLike) -> None:
    """Raise StructureError, naming the nodes, unless these tensions [N] of the elastic cables balance: (c,), or one of
    all."""
    left = np.linalg.norm(out_of_balance(structure, tension), axis=1)
    bad = np.flatnonzero(left > BALANCE_TOLERANCE * max(float(np.max(tension, initial=0.0)), 1e-9))
    if len(bad):
        named = ", ".join(f"{node + 1} ({left[node]:.3g} N)" for node in bad)
        reason = "these nodes have no self-stress" if feasible_self_stress(structure) is None else (
            "these nodes need other tensions")  # fmt: skip
        raise StructureError(
            f"{in_words(tension)} leaves nodes out of balance: {named}; {reason}. "
            "Move them, or let form finding do so (form_finding = true)"
        )
