"""Notches and tapers: our FEM against closed forms, and how its mesh converges.

    python benchmarks/notches.py
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

from tensegym.flexure import fem
from tensegym.flexure.fem.mesh_error import load_error
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.hinge.presets import leaf_spring, notch_hinge, tapered_leaf
from tensegym.flexure.models.notch_formulas import notch_compliance, thin_notch_compliance
from tensegym.report import table

RADIUS, WIDTH, E = 5e-3, 0.04, 2.95e9
FINE = 64


def turn_per_moment(hinge: Hinge) -> float:
    """At a turn so small that the hinge is linear [rad/(N m)]."""
    turned = fem.rotate(hinge, [1e-5])
    return float(turned.theta[0] / turned.moment[0])


def notch_rows() -> list[list[str]]:
    """Web over radius, compliance, what ours and the formula for thin webs are off by, for circle and ellipse."""
    rows = []
    for ratio in (0.02, 0.05, 0.1, 0.2, 0.4):
        web = ratio * RADIUS
        exact = notch_compliance(E, WIDTH, web, RADIUS, RADIUS)
        thin = thin_notch_compliance(E, WIDTH, web, RADIUS)
        flat = notch_compliance(E, WIDTH, web, RADIUS, 0.4 * RADIUS)
        rows.append([f"{ratio:g}", f"{exact:.5g}", f"{turn_per_moment(notch_hinge(thickness=web)) / exact - 1:.0e}",
                     f"{100 * (thin / exact - 1):.2f}",
                     f"{turn_per_moment(notch_hinge(thickness=web, depth=0.4 * RADIUS)) / flat - 1:.0e}"])  # fmt: skip
    return rows


def mesh_rows() -> list[list[str]]:
    """Elements, and the miss of a mesh under a force across: what halving says, and what it is."""
    rows = []
    for hinge, force in ((leaf_spring(), 2.0), (tapered_leaf(), 1.0), (notch_hinge(), 20.0)):
        exact = fem.apply_wrench(hinge, [0, force, 0], elements=FINE)
        for elements in (2, 4, 8, 16):
            found = fem.apply_wrench(hinge, [0, force, 0], elements=elements)
            tip = np.linalg.norm(found.tip - exact.tip) / hinge.length
            miss = max(tip, float(np.abs(found.theta - exact.theta)[0]))
            told = load_error(hinge, [0, force, 0], elements) * 1e-4
            rows.append([hinge.name, f"{np.degrees(exact.theta[0]):.3g}", elements, f"{told:.1e}", f"{miss:.1e}"])
    return rows


def main() -> None:
    print("a circular notch of 5 mm radius: turn over pure moment against Paros and Weisbord; an ellipse of 5 by 2 mm")
    header = ["t / r", "rad/(N m)", "ours off by", "thin form off %", "ellipse, ours off by"]
    print(table(header, notch_rows()))
    print("\na force across the tip: miss of the tip / L or turn [rad], the larger, as halving tells it and as it is")
    print(table(["hinge", "turn deg", "elements", "told", "is"], mesh_rows()))


if __name__ == "__main__":
    main()
