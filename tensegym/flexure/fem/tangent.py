"""What the FEM's tangent says at a state: the stiffness at the tip, and how far its loads are from buckling it."""

from __future__ import annotations

import math

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

from .assembly import assemble
from .beam import element
from .chain import AX, AY, BX, BY, COS, EA, EI, L0, SIN
from .ldl import factor
from .memory import Memory, memory
from .mesh import Mesh
from .solution import Solution

MOST = 1e4  # load factors beyond are none
ACCURACY = 1e-6  # of a load factor, relative


def memory_at(mesh: Mesh, solution: Solution, index: int) -> Memory:
    """The FEM's memory at one converged state. Raises FlexureError where nodes were not kept."""
    if not len(solution.nodes):
        raise FlexureError("this solution holds no nodes; solve with keep_nodes=True")
    mem = memory(mesh)
    mem.nodes[:] = solution.nodes[index]
    for (a, b, count, first), real in zip(mesh.ends, mesh.real, strict=True):
        for body, node, x, y in ((a, first, real[AX], real[AY]), (b, first + count, real[BX], real[BY])):
            if body:
                place_x, place_y, turn = mem.nodes[node]
                c, s = math.cos(turn), math.sin(turn)
                mem.poses[body] = place_x - c * x + s * y, place_y - s * x - c * y, turn
    assemble(mesh, mem)
    mem.axial[:] = mem.strains[:, 4]  # at equilibrium the axial unknown is EA eps
    return mem


def tip_stiffness(mesh: Mesh, mem: Memory) -> FloatArray:
    """(3, 3) second derivative of the strain energy over the tip's x, y [m] and turn [rad], all else in equilibrium."""
    assemble(mesh, mem)
    whole = mem.matrix
    rest, tip = slice(0, len(whole) - 3), slice(len(whole) - 3, None)
    if len(whole) == 3:
        return whole.copy()
    return np.asarray(whole[tip, tip] - whole[tip, rest] @ np.linalg.solve(whole[rest, rest], whole[rest, tip]))


def load_factor(mesh: Mesh, mem: Memory, lever: float = 0.0) -> float:
    """By what the dead loads of a state may grow before it buckles, at its present shape; infinite where nothing does.

    The linear buckling of SPACAR and others, about the deformed state: the smallest factor above 0 at which the tangent
    is no longer positive definite, with the factor on all axial forces and on what bodies' turning makes of forces.
    Below 1 the state is past buckling.

    Args:
        mesh, mem: the state, as ``memory_at`` gives it.
        lever: second derivative of the load's own potential over the tip's turn [N m], at factor 1; 0 for a force at
            the tip.
    """
    axial, turning = mem.axial.copy(), _turning(mesh, mem)

    def stands(factor_: float) -> bool:
        mem.axial[:] = factor_ * axial
        inner = assemble(mesh, mem)
        for body, size in enumerate(turning):
            mem.matrix[3 * body + 2, 3 * body + 2] += (1 - factor_) * size
        mem.matrix[-1, -1] += factor_ * lever
        negative, last = factor(mem.matrix)
        return bool(inner + negative == 0 and not last)

    low, high = 0.0, 1.0
    while stands(high):
        low, high = high, 2 * high
        if high > MOST:
            break
    while high <= MOST and high - low > ACCURACY * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stands(middle) else (low, middle)
    mem.axial[:] = axial
    return high if high <= MOST else math.inf


def _turning(mesh: Mesh, mem: Memory) -> FloatArray:
    """(b - 1,) what the tangent takes off each body's turn, as leaves put forces on it beside its point [N m]."""
    sizes, out = np.zeros(len(mesh.rest)), np.zeros(20)
    for (a, b, count, first), real in zip(mesh.ends, mesh.real, strict=True):
        for body, i, sign, x, y in ((a, first, -1, real[AX], real[AY]),
                                    (b, first + count - 1, 1, real[BX], real[BY])):  # fmt: skip
            (x1, y1, turn1), (x2, y2, turn2) = mem.nodes[i], mem.nodes[i + 1]
            ea, ei, l0 = mesh.pieces[i, EA], mesh.pieces[i, EI], mesh.pieces[i, L0]
            element(x2 - x1, y2 - y1, turn1, turn2, l0, real[COS], real[SIN], ea, ei, mem.axial[i], out)
            c, s = math.cos(mem.poses[body, 2]), math.sin(mem.poses[body, 2])
            sizes[body] += sign * (out[0] * (c * x - s * y) + out[1] * (s * x + c * y))
    return sizes[1:]
