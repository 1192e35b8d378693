"""Reference FEM of a hinge: equilibrium states under rotation, load or wrench control.

Corotational beams (beam.py), fourth-order convergent, with analytic tangent; exact to the elastica within 3e-7 L at 16
elements a length L. Planar; leaves bend by Euler and Bernoulli (no shear), bodies are rigid, loads are dead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tensegym.errors import FlexureError
from tensegym.flexure.hinge.hinge import GROUND, TIP, Hinge
from tensegym.flexure.hinge.states import FloatArray, States

from . import newton
from .frame import Mesh

ELEMENTS = 16  # a leaf as long as the hinge
CONVERGED, BUCKLED, FAILED = newton.CONVERGED, newton.BUCKLED, newton.FAILED


@dataclass(frozen=True)
class Solution:
    """Equilibrium states in the order asked; a state that was not reached is NaN with a status other than CONVERGED."""

    theta: FloatArray
    """(n,) [rad]."""
    tip: FloatArray
    """(n, 2) base axes [m]."""
    force: FloatArray
    """(n, 2) on the tip body at the tip, base axes [N]."""
    moment: FloatArray
    """(n,) on the tip body about the tip [N m]."""
    energy: FloatArray
    """(n,) strain energy [J]."""
    status: NDArray[np.int64]
    """(n,) CONVERGED, BUCKLED or FAILED."""
    stable: NDArray[np.bool_]
    """(n,) the state is a minimum of the potential energy under its dead load."""
    reached: FloatArray
    """(n,) fraction of the path to the asked state that is stable: where it buckled; 1 when converged."""
    nodes: FloatArray
    """(n, k, 3) x, y [m] and turn [rad] of every leaf node, leaf after leaf; (0, k, 3) when not kept."""

    def states(self) -> States:
        """The converged states, for a fit."""
        good = self.status == CONVERGED
        return States(self.theta[good], self.tip[good], self.force[good], self.moment[good])

    def reason(self, index: int) -> str:
        """Why a state is missing; empty when it is not."""
        if self.status[index] == CONVERGED:
            return ""
        if self.status[index] == BUCKLED:
            return f"buckles at {self.reached[index]:.3g} of this load"
        return f"no equilibrium found beyond {self.reached[index]:.3g} of this load"


def mesh_of(hinge: Hinge, elements: int = ELEMENTS) -> Mesh:
    """Flat arrays of a hinge; ``elements`` for a leaf as long as the hinge, others in proportion, 4 at least."""
    if not 1 <= elements <= 2000:
        raise FlexureError(f"elements = {elements} is outside [1, 2000]; 16 is exact to the elastica within 3e-7 L")
    order = [GROUND, *(b for b in hinge.bodies if b not in (GROUND, TIP)), TIP]
    points: dict[str, list[tuple[float, float]]] = {body: [] for body in order}
    for leaf in hinge.leaves:
        points[leaf.start_body].append(leaf.start)
        points[leaf.end_body].append(leaf.end)
    rest = np.zeros((len(order), 3))
    for i, body in enumerate(order[1:-1], start=1):
        rest[i, :2] = np.mean(points[body], axis=0)
    rest[-1, 0] = hinge.length
    ends, real, first = [], [], 0
    modulus = hinge.material.effective_modulus
    for leaf in hinge.leaves:
        count = max(min(elements, 4), round(elements * leaf.length / hinge.length))
        a, b = order.index(leaf.start_body), order.index(leaf.end_body)
        dx, dy = leaf.end[0] - leaf.start[0], leaf.end[1] - leaf.start[1]
        area = leaf.width * leaf.thickness
        ends.append((a, b, count, first))
        real.append((leaf.length / count, dx / leaf.length, dy / leaf.length, modulus * area,
                     modulus * area * leaf.thickness**2 / 12, leaf.start[0] - rest[a, 0], leaf.start[1] - rest[a, 1],
                     leaf.end[0] - rest[b, 0], leaf.end[1] - rest[b, 1]))  # fmt: skip
        first += count + 1
    return Mesh(np.array(ends, dtype=np.int64), np.array(real), rest)


def rotate(hinge: Hinge, theta: ArrayLike, *, force: ArrayLike = (0.0, 0.0), direction: ArrayLike = (0.0, 0.0, 1.0),
           elements: int = ELEMENTS, from_rest: bool = False, keep_nodes: bool = False) -> Solution:  # fmt: skip
    """Rotation control: the tip body turned to theta (n,) [rad], and the multiple of ``direction`` that holds it there.

    force (2,) or (n, 2): dead force at the tip besides [N]; direction (3,) or (n, 3): force x, y and moment about the
    tip, scaled as needed; the default is a pure moment. See ``arm_direction`` for a force at a lever's end.
    """
    theta = _rows(theta, (), "theta")
    asks = np.zeros((len(theta), 8))
    asks[:, newton.THETA] = theta
    asks[:, newton.FX : newton.FY + 1] = _rows(force, (2,), "force", len(theta))
    asks[:, newton.WX : newton.WM + 1] = _rows(direction, (3,), "direction", len(theta))
    if (np.abs(theta) > 2 * math.pi).any():
        raise FlexureError(f"theta = {np.abs(theta).max():g} rad is outside [-2 pi, 2 pi]")
    if (asks[:, newton.WM] == 0).all():
        raise FlexureError("direction has no moment in any row: it cannot hold a rotation; give a moment or an arm")
    return _solve(hinge, newton.ROTATION, asks, elements, from_rest, keep_nodes)


def arm_direction(theta: ArrayLike, arm: float, follows: bool = False) -> FloatArray:
    """(n, 3) unit force across a lever of ``arm`` [m] beyond the tip, as force x, y and moment about the tip.

    The force keeps the base's y direction (a guide), or ``follows`` the lever and stays perpendicular to it.
    """
    angle = _rows(theta, (), "theta")
    if follows:
        return np.column_stack([-np.sin(angle), np.cos(angle), np.full(len(angle), arm)])
    return np.column_stack([np.zeros(len(angle)), np.ones(len(angle)), arm * np.cos(angle)])


def apply_wrench(hinge: Hinge, wrench: ArrayLike, *, arm: float = 0.0, elements: int = ELEMENTS, from_rest: bool = True,
                 keep_nodes: bool = False) -> Solution:  # fmt: skip
    """Wrench control: dead force x, y [N] and moment [N m], (3,) or (n, 3), applied from rest in proportion.

    The force acts ``arm`` [m] beyond the tip along the tip body's x; 0: at the tip. Load control is a zero moment.
    """
    wrench = _rows(np.atleast_2d(np.asarray(wrench, dtype=float)), (3,), "wrench")
    asks = np.zeros((len(wrench), 8))
    asks[:, newton.FX : newton.MZ + 1] = wrench
    asks[:, newton.ARM] = arm
    return _solve(hinge, newton.LOAD, asks, elements, from_rest, keep_nodes)


def _rows(value: ArrayLike, tail: tuple[int, ...], name: str, count: int | None = None) -> FloatArray:
    array = np.asarray(value, dtype=float)
    if count is not None:
        try:
            array = np.broadcast_to(array, (count, *tail))
        except ValueError:
            raise FlexureError(f"{name} has shape {array.shape}; give {tail} or {(count, *tail)}") from None
    elif not tail:
        array = np.atleast_1d(array)
    if array.shape[1:] != tail or array.ndim != 1 + len(tail):
        raise FlexureError(f"{name} has shape {array.shape}; give (n{''.join(f', {t}' for t in tail)})")
    if not np.isfinite(array).all():
        row = int(np.argwhere(~np.isfinite(array))[0, 0])
        raise FlexureError(f"{name} has a value that is not finite, in row {row}")
    return array


def _solve(hinge: Hinge, mode: int, asks: FloatArray, elements: int, from_rest: bool, keep_nodes: bool) -> Solution:
    results, status, stable, nodes = newton.sweep(mesh_of(hinge, elements), mode, asks, from_rest, keep_nodes)
    return Solution(results[:, 0], results[:, 1:3], results[:, 3:5], results[:, 5], results[:, 6], status, stable,
                    results[:, 7], nodes)  # fmt: skip
