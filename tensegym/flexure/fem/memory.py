"""Memory: state and workspace of one solution in progress, compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.compiled import kernel

from .beam import OPTIONS
from .chain import AT, AX, AY, BX, BY, COS, SIN


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


@kernel(**OPTIONS)
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
            new.nodes[first + i, 0] = new.nodes[first, 0] + mesh.pieces[first + i, AT] * real[COS]
            new.nodes[first + i, 1] = new.nodes[first, 1] + mesh.pieces[first + i, AT] * real[SIN]
    return new


@kernel(**OPTIONS)
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


@kernel(**OPTIONS)
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
