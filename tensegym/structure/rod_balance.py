"""Rod balance: the forces and moments that a shape of rigid rods between cables leaves, and their derivative.

A shape is the rows y of the rods' middles, then their unit axes, then the payload's centre. Nodes and the spans of all
members are linear in y: spans = G y. So with n the members' unit directions and w their tensions, G^T (w n) are the
forces on the middles, on the axes (half a rod times the difference of its ends' forces) and on the payload, and
G^T (w (1 - n n^T) / l + w' n n^T) G is their stiffness.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray, IntArray

from .structure import Structure


class Law(NamedTuple):
    """Tensions of cables, base + slope times length, in what state they may come to rest: a tension has no slope, a
    force density no base, a spring of stiffness k and natural length l0 the base -k l0 and the slope k."""

    base: FloatArray
    """(c,) [N]."""
    slope: FloatArray
    """(c,) [N/m]."""


class Kept(NamedTuple):
    """What a shape is to keep, and which tensions may change for it."""

    places: IntArray
    """(k, 2) nodes and the axes, 0 to 2, along which they stay."""
    pairs: IntArray
    """(p, 2) nodes whose distance stays."""
    factors: IntArray
    """(c,) which factor the tension of each cable is multiplied by, from 0; -1 of none."""
    level: bool
    """Whether the factors' geometric mean is 1."""


class State(NamedTuple):
    """What is solved for."""

    rows: FloatArray
    """(2 r, 3) the shape; (2 r + 1, 3) with a payload."""
    logs: FloatArray
    """(f,) natural logarithms of the factors."""


class RodBalance:
    """Forces and moments that a state leaves; moments over half a rod. Tensions of ``law`` and ``payload`` are over
    some reference."""

    def __init__(self, structure: Structure, law: Law, payload: float, kept: Kept | None = None) -> None:
        (first, second), rods = structure.rods.T, np.arange(len(structure.rods))
        ends = structure.nodes[structure.rods]
        self.count = count = len(rods)
        self.half = structure.rod_lengths[:, None] / 2
        self.to_nodes = np.zeros((len(structure.nodes), 2 * count))
        self.to_nodes[first, rods] = self.to_nodes[second, rods] = 1.0
        self.to_nodes[first, count + rods], self.to_nodes[second, count + rods] = -self.half[:, 0], self.half[:, 0]
        middles, axes = ends.mean(axis=1), (ends[:, 1] - ends[:, 0]) / (2 * self.half)
        rows = np.concatenate([middles, axes])
        self.spans = self.to_nodes[structure.cables[:, 1]] - self.to_nodes[structure.cables[:, 0]]
        self.base, self.slope = law.base[:, None], law.slope[:, None]
        if payload:
            inward = np.column_stack([-np.eye(count), np.zeros((count, count)), np.ones(count)])
            rows = np.vstack([rows, middles.mean(axis=0)])
            self.spans = np.vstack([np.column_stack([self.spans, np.zeros(len(self.spans))]), inward])
            self.base = np.vstack([self.base, np.full((count, 1), payload)])
            self.slope = np.vstack([self.slope, np.zeros((count, 1))])
        self.kept, self.given, self.size = kept, structure, float(structure.rod_lengths.max())
        self.member = np.zeros((len(self.spans), 0))
        if kept is not None and len(kept.factors):
            self.member = np.zeros((len(self.spans), kept.factors.max() + 1))
            cables = np.flatnonzero(kept.factors >= 0)
            self.member[cables, kept.factors[cables]] = 1.0
        self.start = State(rows, np.zeros(self.member.shape[1]))

    def nodes(self, state: State) -> FloatArray:
        return self.to_nodes @ state.rows[: 2 * self.count]

    def moved(self, state: State, step: FloatArray) -> State:
        """The state after a step of all its numbers, axes of unit length again."""
        rows = state.rows + step[: state.rows.size].reshape(-1, 3)
        axes = rows[self.count : 2 * self.count]
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        return State(rows, state.logs + step[state.rows.size :])

    def _members(self, state: State) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Directions (m, 3) of cables and the payload's springs; lengths, tensions and their slopes (m, 1)."""
        span = self.spans @ state.rows
        lengths = np.linalg.norm(span, axis=1)[:, None]
        tensions, slope = self.base + self.slope * lengths, self.slope
        if len(state.logs):
            factor = np.exp(self.member @ state.logs)[:, None]
            tensions, slope = tensions * factor, slope * factor
        return span / lengths, lengths, tensions, slope

    def residual(self, state: State) -> FloatArray:
        """Net force, moment across each rod, net force on the payload; in the rows of the shape."""
        directions, _, tensions, _ = self._members(state)
        return self._turned(state, self.spans.T @ (tensions * directions))

    def _turned(self, state: State, left: FloatArray) -> FloatArray:
        """Forces on the axes made moments."""
        turn = slice(self.count, 2 * self.count)
        left[turn] = np.cross(state.rows[turn], left[turn]) / self.half
        return left

    def missed(self, state: State) -> FloatArray:
        """What is to be kept less what it was, over the longest rod, and the mean of the logs where that is 0."""
        if self.kept is None:
            return np.zeros(0)
        nodes, kept = self.nodes(state), self.kept
        node, axis = kept.places.T
        places = nodes[node, axis] - self.given.nodes[node, axis]
        lengths = np.linalg.norm(nodes[kept.pairs[:, 1]] - nodes[kept.pairs[:, 0]], axis=1)
        level = [state.logs.mean()] if kept.level else []
        return np.concatenate([places / self.size, (lengths - self.given.lengths(kept.pairs)) / self.size, level])

    def jacobian(self, state: State) -> FloatArray:
        """Of the residual, then of what is missed, over steps of all numbers. A step along an axis changes nothing."""
        directions, lengths, tensions, slope = self._members(state)
        forces = self.spans.T @ (tensions * directions)
        along = directions[:, :, None] * directions[:, None, :]
        stiffness = (tensions / lengths)[:, :, None] * (np.eye(3) - along) + slope[:, :, None] * along
        jacobian = np.einsum("ci,cjde->idje", self.spans, self.spans[:, :, None, None] * stiffness[:, None])
        turn, rods = slice(self.count, 2 * self.count), np.arange(self.count)
        axes, pulls = state.rows[turn], forces[turn]
        jacobian[turn] = np.einsum("ide,iejf->idjf", cross_matrices(axes), jacobian[turn])
        jacobian[turn][rods, :, self.count + rods] -= cross_matrices(pulls)
        jacobian[turn] /= self.half[:, :, None, None]
        unstretched = np.eye(3) - axes[:, :, None] * axes[:, None, :]
        jacobian[:, :, turn] = np.einsum("idje,jef->idjf", jacobian[:, :, turn], unstretched)
        square = jacobian.reshape(state.rows.size, state.rows.size)
        return square if self.kept is None else self._bordered(state, square, tensions * directions, unstretched)

    def _bordered(self, state: State, square: FloatArray, pulls: FloatArray, unstretched: FloatArray) -> FloatArray:
        """The Jacobian with the columns of the factors and the rows of what is to be kept."""
        assert self.kept is not None
        columns = [self._turned(state, self.spans.T @ (part[:, None] * pulls)).ravel() for part in self.member.T]
        nodes, kept = self.nodes(state), self.kept
        to_rows = np.zeros((len(nodes), 3, len(state.rows), 3))
        to_rows[:, :, : 2 * self.count] = np.einsum("nj,de->ndje", self.to_nodes, np.eye(3))
        turn = slice(self.count, 2 * self.count)
        to_rows[:, :, turn] = np.einsum("ndje,jef->ndjf", to_rows[:, :, turn], unstretched)
        node, axis = kept.places.T
        spans = nodes[kept.pairs[:, 1]] - nodes[kept.pairs[:, 0]]
        along = spans / np.linalg.norm(spans, axis=1)[:, None]
        change = np.einsum("pd,pdje->pje", along, to_rows[kept.pairs[:, 1]] - to_rows[kept.pairs[:, 0]])
        below = np.concatenate([to_rows[node, axis], change]).reshape(-1, state.rows.size) / self.size
        whole = np.zeros((len(square) + len(below) + kept.level, len(square) + len(state.logs)))
        whole[: len(square), : len(square)] = square
        whole[: len(square), len(square) :] = np.reshape(columns, (len(state.logs), len(square))).T
        whole[len(square) : len(square) + len(below), : len(square)] = below
        if kept.level:
            whole[-1, len(square) :] = 1 / len(state.logs)
        return whole


def cross_matrices(vectors: FloatArray) -> FloatArray:
    """(v, 3, 3) with which a product is the cross product of each vector (v, 3) and its factor."""
    return np.cross(vectors[:, None, :], np.eye(3)).transpose(0, 2, 1)
