"""Stiffness of a parallelogram along its travel, by exudyn and by our FEM.

    python benchmarks/parallelogram.py

exudyn: ANCF cables on a rigid stage, 16 a leaf; its stiffness is the inverse of what five static solves give: the load,
and the load a little more and less across and along (at rest more: small loads alone are below what its solver
resolves). Ours: the tangent. Across: the force over the travel;
along: the force over the stretch while the travel is held; the stage turns freely in both.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parent))

import numpy as np
from flexure import exudyn_sweep

from tensegym.flexure.fem.travel import pushed
from tensegym.flexure.hinge import Hinge, preset
from tensegym.report import table

TRAVELS = (0.0, 0.025, 0.05, 0.1, 0.15)  # of L
ELEMENTS = 16
CHANGE, AT_REST = 0.03, 1.0  # N that forces are changed by


def exudyn_stiffness(hinge: Hinge, force: tuple[float, float], elements: int = ELEMENTS) -> np.ndarray:
    """y [m] and stiffness across and along [N/m] under a dead force [N]."""

    def tip(x: float, y: float) -> np.ndarray:
        return exudyn_sweep(hinge, 0.0, elements, force=(force[0] + x, force[1] + y), steps=1).tip

    step = CHANGE if force[1] else AT_REST
    along = (tip(step, 0) - tip(-step, 0)) / (2 * step)
    across = (tip(0, step) - tip(0, -step)) / (2 * step)
    held = along[0] - across[0] * along[1] / across[1]
    at = tip(0, 0)[1] if any(force) else 0.0
    return np.array([at, 1 / across[1], 1 / held])


def compared(hinge: Hinge, axial: float = 0.0, travels: tuple[float, ...] = TRAVELS) -> np.ndarray:
    """(n, 6) travel by ours and by exudyn [m], stiffness across by both, along by both [N/m], under the same forces."""
    path = pushed(hinge, hinge.length * np.array(travels), axial=axial)
    theirs = np.array([exudyn_stiffness(hinge, (axial, float(y))) for y in path.states.force[:, 1]])
    ours = np.column_stack([path.states.tip[:, 1], path.drive_stiffness, path.support_stiffness(0)])
    return np.stack([ours, theirs], axis=2).reshape(len(ours), 6)


def main() -> None:
    hinge = preset("parallel-guide")
    print(hinge.describe())
    for axial in (0.0, 30.0, -30.0):
        rows = [[f"{1e3 * y:.4g}", f"{1e6 * (other - y):.2g}", f"{ky:.6g}", f"{100 * (ky / ky_ - 1):.1g}", f"{kx:.6g}",
                 f"{100 * (kx / kx_ - 1):.1g}"] for y, other, ky, ky_, kx, kx_ in compared(hinge, axial)]  # fmt: skip
        print(f"\n{axial:g} N along the leaves")
        print(table(["y mm", "exudyn's less ours um", "k y N/m", "off exudyn %", "k x N/m", "off exudyn %"], rows))


if __name__ == "__main__":
    main()
