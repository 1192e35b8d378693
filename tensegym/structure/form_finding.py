"""Form finding: where rigid rods come to rest between cables, and with which tensions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.errors import ShapeError, StructureError

from .equilibrium import BALANCE_TOLERANCE, in_words, out_of_balance
from .rod_balance import Kept, Law, RodBalance, State
from .structure import Structure

MOST_STEPS = 200
ROUNDING = 1e-14  # of the cables' tension, left out of balance where a shape is found


class Found(NamedTuple):
    """A shape in balance."""

    structure: Structure
    tensions: FloatArray
    """(c,) of the elastic cables [N]."""


def form_find(structure: Structure, tension: ArrayLike, payload_tension: float = 0.0) -> Structure:
    """`find_form` with given tensions, above 0, of the elastic cables [N]: (c,), or one of all."""
    tensions = np.broadcast_to(np.asarray(tension, dtype=float), len(structure.cables))
    return find_form(structure, Law(tensions, np.zeros_like(tensions)), payload_tension).structure


def find_form(structure: Structure, law: Law, payload_tension: float = 0.0, kept: Kept | None = None) -> Found:
    """Move rigid rods until the elastic cables balance; stiff cables are slack.

    Solves for the net force and moment on each rod from the given nodes, then lays the result back onto them as well
    as a rigid motion can, unless nodes are kept. Steps are the smallest that balance to first order, so that a
    symmetry of the nodes and tensions given is one of the shape found.

    Args:
        structure: where the search begins.
        law: of the cables' tensions, above 0 at the given lengths.
        payload_tension: in one spring from every rod's middle to a common central body [N], in balance too.
        kept: what does not change, and which tensions do in return.

    Raises:
        StructureError: a tension of 0 or below.
        ShapeError: no shape in balance was found; it names the nodes furthest out.
    """
    tensions = law.base + law.slope * structure.lengths(structure.cables)
    if len(structure.shared):
        left = np.abs(out_of_balance(structure, tensions)).max()
        if payload_tension or left > BALANCE_TOLERANCE * tensions.max(initial=0.0):
            raise ShapeError(f"node {structure.shared[0] + 1} is on more than one rod: form finding does not move such "
                             "nodes, and they are out of balance. Keep them, [keep] shape = true")  # fmt: skip
        return Found(structure, tensions)
    if (tensions <= 0).any():
        raise StructureError(f"tension = {float(tensions.min()):g} N must be above 0 for form finding")
    most = float(tensions.max(initial=0.0)) or 1.0
    balance = RodBalance(structure, Law(law.base / most, law.slope / most), payload_tension / most, kept)
    if np.abs(balance.residual(balance.start)).max() <= 1e-12:
        return Found(structure, tensions)
    state = _solve(balance)
    nodes, left = balance.nodes(state), np.abs(balance.residual(state)).max(axis=1)
    spans = np.linalg.norm(nodes[structure.cables[:, 1]] - nodes[structure.cables[:, 0]], axis=1)
    short = spans.min(initial=np.inf) < 0.05 * structure.rod_lengths.min()
    found = (law.base + law.slope * spans) * np.exp(balance.member[: len(spans)] @ state.logs)
    missed = float(np.abs(balance.missed(state)).max(initial=0.0))
    if not max(left.max(), missed) <= BALANCE_TOLERANCE or short or (found <= 0).any():
        worst = structure.rods[np.argsort(left[: len(structure.rods)])[::-1][:3]].ravel() + 1
        what = f"keeps what it is to ({missed * balance.size:.2g} m off)" if missed > BALANCE_TOLERANCE else (
            f"{in_words(tensions)} balances")  # fmt: skip
        raise ShapeError(
            f"form finding found no shape that {what}; furthest out are nodes "
            f"{', '.join(map(str, worst))}. Start nearer a tensegrity, or change the cables"
        )
    if kept is None or not len(kept.places):
        nodes = _laid_onto(nodes, structure.nodes)
    return Found(structure.with_nodes(nodes), found)


def _solve(balance: RodBalance) -> State:
    """A state in balance by Levenberg-Marquardt from the given one, or where no step leaves less out of balance.

    With damping in proportion to the residual it converges quadratically, although rigid motions leave the Jacobian
    singular, wherever the residual bounds the way to balance (Fan and Yuan 2005, "On the quadratic convergence of the
    Levenberg-Marquardt method without nonsingularity assumption").
    """
    state, damping = balance.start, 1e-2
    residual = _left(balance, state)
    for _ in range(MOST_STEPS):
        size = np.linalg.norm(residual)
        jacobian = balance.jacobian(state)
        left, values, right = np.linalg.svd(jacobian, full_matrices=balance.kept is None)
        along = left.T @ residual
        while True:
            damped = values**2 + damping * size
            trial = balance.moved(state, -right.T @ (values / damped * along))
            left_over = _left(balance, trial)
            gain = 1 - np.linalg.norm(left_over) / size
            if gain > 0:
                break
            damping *= 4
            if damped[0] > 2 * values[0] ** 2:
                return state
        foreseen = 1 - np.linalg.norm((1 - values**2 / damped) * along) / size
        damping *= 0.1 if gain > 0.75 * foreseen else 4 if gain < 0.25 * foreseen else 1
        state, residual = trial, left_over
        if np.abs(residual).max() <= ROUNDING:
            break
    return state


def _left(balance: RodBalance, state: State) -> FloatArray:
    return np.concatenate([balance.residual(state).ravel(), balance.missed(state)])


def _laid_onto(nodes: FloatArray, target: FloatArray) -> FloatArray:
    centre, goal = nodes.mean(axis=0), target.mean(axis=0)
    turn, _ = Rotation.align_vectors(target - goal, nodes - centre)
    return turn.apply(nodes - centre) + goal
