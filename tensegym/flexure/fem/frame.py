"""All leaves and bodies of a hinge together: one Newton step, and Newton to the end, compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from tensegym.flexure.hinge.states import FloatArray

from .beam import OPTIONS, energy
from .chain import AX, AY, BX, BY, COS, EA, EI, L0, SIN, condense


class Mesh(NamedTuple):
    """A hinge as flat arrays. Body 0 is the ground, the last the tip; a body's pose is (x, y, turn) of its point."""

    ends: np.ndarray
    """(m, 4) of each leaf: start body, end body, number of elements, first node."""
    real: FloatArray
    """(m, 9) columns named in chain.py; AX..BY: leaf end from its body's point, in base axes at rest."""
    rest: FloatArray
    """(b, 3) pose of every body at rest."""


class Memory(NamedTuple):
    """State and workspace of one solution in progress."""

    poses: FloatArray
    """(b, 3) body poses."""
    nodes: FloatArray
    """(k, 3) x, y, turn of every leaf node."""
    axial: FloatArray
    """(k,) axial force of the element after each node [N]."""
    held: FloatArray
    """(4,) force x, y and moment about the tip that hold the last settled state, and its energy."""
    strains: FloatArray
    back: FloatArray
    blocks: FloatArray
    loads: FloatArray
    matrix: FloatArray
    right: FloatArray
    step: FloatArray


@njit(**OPTIONS)
def memory(mesh):
    """Memory of a hinge at rest."""
    total = 0
    for m in range(len(mesh.ends)):
        total += mesh.ends[m, 2] + 1
    size = 3 * (len(mesh.rest) - 1)
    new = Memory(
        mesh.rest.copy(), np.zeros((total, 3)), np.zeros(total), np.zeros(4), np.zeros((total, 5)),
        np.zeros((total + 2, 21)), np.zeros((3, 9)), np.zeros((4, 3)), np.zeros((size, size)), np.zeros((2, size)),
        np.zeros((len(mesh.rest), 3)))  # fmt: skip
    for m in range(len(mesh.ends)):
        _, _, count, first = mesh.ends[m]
        real = mesh.real[m]
        place_ends(mesh, new, m)
        for i in range(1, count):
            new.nodes[first + i, 0] = new.nodes[first, 0] + i * real[L0] * real[COS]
            new.nodes[first + i, 1] = new.nodes[first, 1] + i * real[L0] * real[SIN]
    return new


@njit(**OPTIONS)
def copy_state(source, target):
    """Poses, nodes, axial and holding forces of one memory into another."""
    for i in range(len(source.poses)):  # loops compile ten times faster here than array assignments
        for j in range(3):
            target.poses[i, j] = source.poses[i, j]
    for i in range(len(source.nodes)):
        target.axial[i] = source.axial[i]
        for j in range(3):
            target.nodes[i, j] = source.nodes[i, j]
    for i in range(4):
        target.held[i] = source.held[i]


@njit(**OPTIONS)
def place_ends(mesh, mem, m):
    """Put the end nodes of leaf m where its bodies carry them."""
    a, b, count, first = mesh.ends[m]
    real = mesh.real[m]
    for body, node, x, y in ((a, first, real[AX], real[AY]), (b, first + count, real[BX], real[BY])):
        px, py, turn = mem.poses[body]
        c, s = math.cos(turn), math.sin(turn)
        mem.nodes[node, 0] = px + c * x - s * y
        mem.nodes[node, 1] = py + s * x + c * y
        mem.nodes[node, 2] = turn


@njit(**OPTIONS)
def strain_energy(mesh, mem):
    """Energy of all leaves [J]."""
    total = 0.0
    for m in range(len(mesh.ends)):
        _, _, count, first = mesh.ends[m]
        real = mesh.real[m]
        for i in range(first, first + count):
            one, two = mem.nodes[i], mem.nodes[i + 1]
            total += energy(two[0] - one[0], two[1] - one[1], one[2], two[2], real[L0], real[COS], real[SIN], real[EA],
                            real[EI])  # fmt: skip
    return total


@njit(**OPTIONS)
def assemble(mesh, mem):
    """Energy's gradient into right[0], its Hessian into matrix, over the moving bodies; returns negative pivots."""
    negative = 0
    for i in range(len(mem.matrix)):
        mem.right[0, i] = 0.0
        for j in range(len(mem.matrix)):
            mem.matrix[i, j] = 0.0
    for m in range(len(mesh.ends)):
        a, b, count, first = mesh.ends[m]
        real = mesh.real[m]
        last = first + count + 1
        negative += condense(mem.nodes[first:last], mem.axial[first:last], real, count, a == 0, mem.strains[first:last],
                             mem.back[first : last + 1], mem.blocks, mem.loads)  # fmt: skip
        ca, sa, cb, sb = (math.cos(mem.poses[a, 2]), math.sin(mem.poses[a, 2]), math.cos(mem.poses[b, 2]),
                          math.sin(mem.poses[b, 2]))  # fmt: skip
        ax, ay = ca * real[AX] - sa * real[AY], sa * real[AX] + ca * real[AY]
        bx, by = cb * real[BX] - sb * real[BY], sb * real[BX] + cb * real[BY]
        if a > 0:
            add(mem, 3 * (a - 1), 3 * (a - 1), mem.blocks[0], ax, ay, ax, ay)
            add_load(mem, 3 * (a - 1), mem.loads[0], mem.loads[2], ax, ay)
        if b > 0:
            add(mem, 3 * (b - 1), 3 * (b - 1), mem.blocks[2], bx, by, bx, by)
            add_load(mem, 3 * (b - 1), mem.loads[1], mem.loads[3], bx, by)
        if a > 0 and b > 0:
            add(mem, 3 * (a - 1), 3 * (b - 1), mem.blocks[1], ax, ay, bx, by)
            for i in range(3):  # the coupling's transpose
                for j in range(3):
                    mem.matrix[3 * (b - 1) + j, 3 * (a - 1) + i] = mem.matrix[3 * (a - 1) + i, 3 * (b - 1) + j]
    return negative


@njit(**OPTIONS)
def add(mem, row, column, k, ax, ay, bx, by):
    """T_a^T k T_b onto the matrix; T takes a body's (x, y, turn) increments to those of a point (ax, ay) from it."""
    c0 = -k[0] * by + k[1] * bx + k[2]
    c1 = -k[3] * by + k[4] * bx + k[5]
    c2 = -k[6] * by + k[7] * bx + k[8]
    matrix = mem.matrix
    matrix[row, column] += k[0]
    matrix[row, column + 1] += k[1]
    matrix[row, column + 2] += c0
    matrix[row + 1, column] += k[3]
    matrix[row + 1, column + 1] += k[4]
    matrix[row + 1, column + 2] += c1
    matrix[row + 2, column] += -ay * k[0] + ax * k[3] + k[6]
    matrix[row + 2, column + 1] += -ay * k[1] + ax * k[4] + k[7]
    matrix[row + 2, column + 2] += -ay * c0 + ax * c1 + c2


@njit(**OPTIONS)
def add_load(mem, row, load, raw, ax, ay):
    """Residual of one end onto its body, and the curvature of the body's turn times the raw force."""
    mem.right[0, row] += load[0]
    mem.right[0, row + 1] += load[1]
    mem.right[0, row + 2] += load[2] - ay * load[0] + ax * load[1]
    mem.matrix[row + 2, row + 2] -= raw[0] * ax + raw[1] * ay


@njit(**OPTIONS)
def factor(matrix):
    """L D L^T in place without pivoting; returns the negative pivots of all but the last, and whether the last is."""
    size = len(matrix)
    negative = 0
    for j in range(size):
        pivot = matrix[j, j]
        for i in range(j + 1, size):
            share = matrix[i, j] / pivot
            for k in range(j + 1, i + 1):
                matrix[i, k] -= share * matrix[k, j]
        for i in range(j + 1, size):
            matrix[i, j] /= pivot
        if pivot < 0 and j < size - 1:
            negative += 1
    return negative, matrix[size - 1, size - 1] < 0


@njit(**OPTIONS)
def forward(matrix, right):
    """Solve L z = right in place."""
    for i in range(len(right)):
        for k in range(i):
            right[i] -= matrix[i, k] * right[k]


@njit(**OPTIONS)
def backward(matrix, right):
    """Solve L^T x = right in place."""
    for i in range(len(right) - 1, -1, -1):
        for k in range(i + 1, len(right)):
            right[i] -= matrix[k, i] * right[k]
