"""Stiffness of one leaf as a solid, against the beams of our FEM: in the plane, and out of it.

    python benchmarks/leaf_solid.py

The solid: hexahedra of 20 nodes with 8 integration points, 32 by 16 and one through the thickness, linear elastic and
free of stress about the shape that it has, flat or bent to an arc; one end held, the other moved as a rigid body. The
arc is what a pure moment makes of a leaf. Checks: with nu = 0 the leaf turns by E I / L, and at nu = 0.38 hindered
anticlastic curvature makes one that is as wide as long stiffer, by 15 % in another solid code.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

from itertools import product

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from tensegym.flexure import fem
from tensegym.flexure.fem.out_of_plane import out_of_plane_stiffness
from tensegym.flexure.fem.tangent import memory_at
from tensegym.flexure.hinge import Material
from tensegym.flexure.hinge.presets import leaf_spring
from tensegym.report import table

LENGTH, THICKNESS = 0.04, 0.8e-3
CORNERS = [c for c in product((0, 1, 2), repeat=3) if sum(k == 1 for k in c) < 2]  # an element's nodes on a lattice


def shapes(place: np.ndarray) -> np.ndarray:
    """(20, 3) slopes of the serendipity functions at a place in [-1, 1]^3."""
    out = np.empty((20, 3))
    for i, corner in enumerate(CORNERS):
        at = np.array(corner) - 1.0
        middle = np.flatnonzero(at == 0)
        factors = 1 + at * place
        slopes = at.copy()
        if len(middle):  # of an edge: (1 - m^2) (1 + a p) (1 + b q) / 4
            factors[middle], slopes[middle] = 1 - place[middle] ** 2, -2 * place[middle]
            for k in range(3):
                out[i, k] = slopes[k] * np.prod(np.delete(factors, k)) / 4
        else:  # of a corner: (1 + a p) (1 + b q) (1 + c r) (a p + b q + c r - 2) / 8
            last = at @ place - 2
            for k in range(3):
                rest = np.prod(np.delete(factors, k))
                out[i, k] = at[k] * rest * (last + factors[k]) / 8
    return out


def solid_stiffness(width: float, poisson: float, bend: float = 0.0, counts: tuple[int, int] = (32, 16),
                    young: float = 2.95e9) -> np.ndarray:  # fmt: skip
    """(6, 6) wrench over the moved end's translation and turn, about its centre, axes x along the flat leaf, y through
    it and z across, both turned with the bent end's place only.

    Args:
        width: of the leaf [m].
        poisson: nu.
        bend: turn of the leaf's end in its stress-free shape [rad].
        counts: of elements along and across.
        young: E [Pa].
    """
    nx, nz = counts
    lattice = np.array([p for p in product(range(2 * nx + 1), range(3), range(2 * nz + 1))
                        if sum(k % 2 for k in p) < 2])  # fmt: skip
    number = {tuple(p): i for i, p in enumerate(lattice.tolist())}
    s, y, z = (lattice / [2 * nx, 2, 2 * nz] * [LENGTH, THICKNESS, width] - [0, THICKNESS / 2, width / 2]).T
    turn = bend * s / LENGTH
    radius = LENGTH / bend if bend else 0.0
    nodes = np.column_stack([radius * np.sin(turn) if bend else s, radius * (1 - np.cos(turn)), z])
    nodes += np.column_stack([-y * np.sin(turn), y * np.cos(turn), 0 * y])
    first, second = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    law = np.diag([2 * second] * 3 + [second] * 3)
    law[:3, :3] += first
    gauss = np.array(list(product((-1, 1), repeat=3))) / np.sqrt(3)
    slopes = [shapes(place) for place in gauss]
    rows, columns, values = [], [], []
    for i, k in product(range(nx), range(nz)):
        own = [number[2 * i + a, b, 2 * k + c] for a, b, c in CORNERS]
        block = np.zeros((60, 60))
        for slope in slopes:
            jacobian = slope.T @ nodes[own]
            g = np.linalg.solve(jacobian, slope.T)
            b = np.zeros((6, 20, 3))
            for m in range(3):
                b[m, :, m] = g[m]
            for m, (p, q) in enumerate(((0, 1), (1, 2), (2, 0))):
                b[3 + m, :, p], b[3 + m, :, q] = g[q], g[p]
            flat = b.reshape(6, 60)
            block += flat.T @ law @ flat * np.linalg.det(jacobian)
        where = (3 * np.array(own)[:, None] + np.arange(3)).ravel()
        rows.append(np.repeat(where, 60))
        columns.append(np.tile(where, 60))
        values.append(block.ravel())
    size = 3 * len(nodes)
    whole = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (size, size)).tocsc()
    end = np.flatnonzero(lattice[:, 0] == 2 * nx)
    free = np.flatnonzero(np.repeat((lattice[:, 0] > 0) & (lattice[:, 0] < 2 * nx), 3))
    moved = (3 * end[:, None] + np.arange(3)).ravel()
    arms = nodes[end] - nodes[end].mean(axis=0)
    rigid = np.zeros((len(end), 3, 6))
    rigid[:, :, :3] = np.eye(3)
    for axis in range(3):
        rigid[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arms)
    rigid = rigid.reshape(-1, 6)
    inside = splu(whole[free][:, free]).solve(np.asarray(whole[free][:, moved] @ rigid))
    return np.asarray(rigid.T @ (whole[moved][:, moved] @ rigid - whole[moved][:, free] @ inside))


def free(stiffness: np.ndarray) -> np.ndarray:
    """Force or moment over each freedom, the others free."""
    return 1 / np.diag(np.linalg.inv(stiffness))


def ours(width: float, poisson: float, bend: float) -> np.ndarray:
    """(3,) z [N/m], about x, about y [N m/rad] of the FEM's approximation."""
    hinge = leaf_spring(length=LENGTH, width=width, thickness=THICKNESS, material=Material(poisson_ratio=poisson))
    found = fem.rotate(hinge, [bend], keep_nodes=True)
    mesh = fem.mesh_of(hinge)
    return free(out_of_plane_stiffness(hinge, mesh, memory_at(mesh, found, 0)))


def main() -> None:
    bending = 2.95e9 * LENGTH * THICKNESS**3 / 12 / LENGTH
    for poisson in (0.0, 0.38):
        for bend in (0.0, 30.0):
            planes = solid_stiffness(LENGTH, poisson, np.radians(bend))[np.ix_((0, 1, 5), (0, 1, 5))]
            print(f"nu = {poisson:g}, bent by {bend:g} deg: a leaf as wide as long turns by E I / L "
                  f"{100 * (free(planes)[2] / bending - 1):+.1f} %")  # fmt: skip
    rows = []
    for share, bend in product((0.25, 0.5, 1.0), (0.0, 30.0)):
        solid = free(solid_stiffness(share * LENGTH, 0.38, np.radians(bend))[np.ix_((2, 3, 4), (2, 3, 4))])
        beam = ours(share * LENGTH, 0.38, np.radians(bend))
        cells = [f"{value:.4g} ({100 * (mine / value - 1):+.1f} %)" for value, mine in zip(solid, beam, strict=True)]
        rows.append([f"{share:g}", f"{bend:g}", *cells])
    print("\nout of plane, each with the others free: the solid, and what our approximation is off by")
    print(table(["w / L", "bent deg", "z N/m", "about x Nm/rad", "about y Nm/rad"], rows))


if __name__ == "__main__":
    main()
