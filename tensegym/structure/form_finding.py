"""Form finding: where rigid rods come to rest between cables of given tensions.

A shape is the rows y of the rods' middles, then their unit axes, then the payload's centre. Nodes and the spans of all
members are linear in y: spans = G y. So with n the members' unit directions and w their tensions, G^T (w n) are the
forces on the middles, on the axes (half a rod times the difference of its ends' forces) and on the payload, and
G^T w (1 - n n^T) / l G is their stiffness.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.errors import StructureError

from .equilibrium import BALANCE_TOLERANCE, in_words
from .structure import Structure

MOST_STEPS = 200
ROUNDING = 1e-14  # of the cables' tension, left out of balance where a shape is found


def form_find(structure: Structure, tension: ArrayLike, payload_tension: float = 0.0) -> Structure:
    """Move rigid rods until the given tensions in the elastic cables balance; stiff cables are slack.

    Solves for the net force and moment on each rod from the given nodes, then lays the result back onto them as well
    as a rigid motion can.

    Args:
        structure: where the search begins.
        tension: of the elastic cables [N], above 0: (c,), or one of all.
        payload_tension: in one spring from every rod's middle to a common central body [N], in balance too.

    Raises:
        StructureError: no shape in balance was found; it names the nodes furthest out.
    """
    tensions = np.broadcast_to(np.asarray(tension, dtype=float), len(structure.cables))
    if (tensions <= 0).any():
        raise StructureError(f"tension = {float(tensions.min()):g} N must be above 0 for form finding")
    most = float(tensions.max(initial=0.0)) or 1.0
    balance = _RodBalance(structure, tensions / most, payload_tension / most)
    if np.abs(balance.residual(balance.start)).max() <= 1e-12:
        return structure
    shape = _solve(balance)
    nodes, left = balance.nodes(shape), np.abs(balance.residual(shape)).max(axis=1)
    spans = np.linalg.norm(nodes[structure.cables[:, 1]] - nodes[structure.cables[:, 0]], axis=1)
    if not left.max() <= BALANCE_TOLERANCE or spans.min(initial=np.inf) < 0.05 * structure.rod_lengths.min():
        worst = structure.rods[np.argsort(left[: len(structure.rods)])[::-1][:3]].ravel() + 1
        raise StructureError(
            f"form finding found no shape that {in_words(tensions)} balances; furthest out are nodes "
            f"{', '.join(map(str, worst))}. Start nearer a tensegrity, or change the cables"
        )
    return structure.with_nodes(_laid_onto(nodes, structure.nodes))


class _RodBalance:
    """Forces and moments that a shape leaves, over the largest tension; a moment over half a rod. tensions (c,),
    payload: over the largest tension too."""

    def __init__(self, structure: Structure, tensions: FloatArray, payload: float) -> None:
        (first, second), rods = structure.rods.T, np.arange(len(structure.rods))
        ends = structure.nodes[structure.rods]
        self.count = count = len(rods)
        self.half = structure.rod_lengths[:, None] / 2
        self.to_nodes = np.zeros((len(structure.nodes), 2 * count))
        self.to_nodes[first, rods] = self.to_nodes[second, rods] = 1.0
        self.to_nodes[first, count + rods], self.to_nodes[second, count + rods] = -self.half[:, 0], self.half[:, 0]
        middles, axes = ends.mean(axis=1), (ends[:, 1] - ends[:, 0]) / (2 * self.half)
        self.start = np.concatenate([middles, axes])
        self.spans = self.to_nodes[structure.cables[:, 1]] - self.to_nodes[structure.cables[:, 0]]
        self.tensions = tensions[:, None]
        if payload:
            inward = np.column_stack([-np.eye(count), np.zeros((count, count)), np.ones(count)])
            self.start = np.vstack([self.start, middles.mean(axis=0)])
            self.spans = np.vstack([np.column_stack([self.spans, np.zeros(len(self.spans))]), inward])
            self.tensions = np.vstack([self.tensions, np.full((count, 1), payload)])

    def nodes(self, shape: FloatArray) -> FloatArray:
        return self.to_nodes @ shape[: 2 * self.count]

    def moved(self, shape: FloatArray, step: FloatArray) -> FloatArray:
        """The shape after a step of all rows, axes of unit length again."""
        shape = shape + step.reshape(-1, 3)
        axes = shape[self.count : 2 * self.count]
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        return shape

    def _directions(self, shape: FloatArray) -> tuple[FloatArray, FloatArray]:
        span = self.spans @ shape
        lengths = np.linalg.norm(span, axis=1)[:, None]
        return span / lengths, lengths

    def residual(self, shape: FloatArray) -> FloatArray:
        """Net force, moment across each rod, net force on the payload; in the rows of the shape."""
        directions, _ = self._directions(shape)
        left = self.spans.T @ (self.tensions * directions)
        turn = slice(self.count, 2 * self.count)
        left[turn] = np.cross(shape[turn], left[turn]) / self.half
        return left

    def jacobian(self, shape: FloatArray) -> FloatArray:
        """Of the residual over steps of all rows; square. A step along an axis changes nothing."""
        directions, lengths = self._directions(shape)
        forces = self.spans.T @ (self.tensions * directions)
        across = np.eye(3) - directions[:, :, None] * directions[:, None, :]
        stiffness = (self.tensions / lengths)[:, :, None] * across
        jacobian = np.einsum("ci,cjde->idje", self.spans, self.spans[:, :, None, None] * stiffness[:, None])
        turn, rods = slice(self.count, 2 * self.count), np.arange(self.count)
        axes, pulls = shape[turn], forces[turn]
        jacobian[turn] = np.einsum("ide,iejf->idjf", cross_matrices(axes), jacobian[turn])
        jacobian[turn][rods, :, self.count + rods] -= cross_matrices(pulls)
        jacobian[turn] /= self.half[:, :, None, None]
        unstretched = np.eye(3) - axes[:, :, None] * axes[:, None, :]
        jacobian[:, :, turn] = np.einsum("idje,jef->idjf", jacobian[:, :, turn], unstretched)
        return jacobian.reshape(shape.size, shape.size)


def _solve(balance: _RodBalance) -> FloatArray:
    """A shape in balance by Levenberg-Marquardt from the given one, or where no step leaves less out of balance.

    With damping in proportion to the residual it converges quadratically, although rigid motions leave the Jacobian
    singular, wherever the residual bounds the way to balance (Fan and Yuan 2005, "On the quadratic convergence of the
    Levenberg-Marquardt method without nonsingularity assumption").
    """
    shape, damping = balance.start, 1e-2
    residual = balance.residual(shape).ravel()
    for _ in range(MOST_STEPS):
        size = np.linalg.norm(residual)
        left, values, right = np.linalg.svd(balance.jacobian(shape))
        along = left.T @ residual
        while True:
            damped = values**2 + damping * size
            trial = balance.moved(shape, -right.T @ (values / damped * along))
            left_over = balance.residual(trial).ravel()
            gain = 1 - np.linalg.norm(left_over) / size
            if gain > 0:
                break
            damping *= 4
            if damped[0] > 2 * values[0] ** 2:
                return shape
        foreseen = 1 - np.linalg.norm((1 - values**2 / damped) * along) / size
        damping *= 0.1 if gain > 0.75 * foreseen else 4 if gain < 0.25 * foreseen else 1
        shape, residual = trial, left_over
        if np.abs(residual).max() <= ROUNDING:
            break
    return shape


def cross_matrices(vectors: FloatArray) -> FloatArray:
    """(v, 3, 3) with which a product is the cross product of each vector (v, 3) and its factor."""
    return np.cross(vectors[:, None, :], np.eye(3)).transpose(0, 2, 1)


def _laid_onto(nodes: FloatArray, target: FloatArray) -> FloatArray:
    centre, goal = nodes.mean(axis=0), target.mean(axis=0)
    turn, _ = Rotation.align_vectors(target - goal, nodes - centre)
    return turn.apply(nodes - centre) + goal
