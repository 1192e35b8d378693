"""All leaves and bodies of a hinge together: energy, gradient and Hessian over the moving bodies, compiled."""

from __future__ import annotations

import math

from tensegym.compiled import kernel

from .beam import OPTIONS, energy
from .chain import AX, AY, BX, BY, COS, EA, EI, L0, SIN, condense


@kernel(**OPTIONS)
def strain_energy(mesh, mem):
    """Energy of all leaves [J]."""
    total = 0.0
    for m in range(len(mesh.ends)):
        _, _, count, first = mesh.ends[m]
        real = mesh.real[m]
        for i in range(first, first + count):
            one, two = mem.nodes[i], mem.nodes[i + 1]
            total += energy(two[0] - one[0], two[1] - one[1], one[2], two[2], mesh.pieces[i, L0], real[COS],
                            real[SIN], mesh.pieces[i, EA], mesh.pieces[i, EI])  # fmt: skip
    return total


@kernel(**OPTIONS)
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
        negative += condense(mem.nodes[first:last], mem.axial[first:last], real, mesh.pieces[first:last], count, a == 0,
                             mem.strains[first:last], mem.back[first : last + 1], mem.blocks, mem.loads)  # fmt: skip
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


@kernel(**OPTIONS)
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


@kernel(**OPTIONS)
def add_load(mem, row, load, raw, ax, ay):
    """Residual of one end onto its body, and the curvature of the body's turn times the raw force."""
    mem.right[0, row] += load[0]
    mem.right[0, row + 1] += load[1]
    mem.right[0, row + 2] += load[2] - ay * load[0] + ax * load[1]
    mem.matrix[row + 2, row + 2] -= raw[0] * ax + raw[1] * ay
