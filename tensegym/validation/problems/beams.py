"""Flexures under loads that have closed forms: the elastica, Princeton's beam where it is linear, the cross spring."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from tensegym.flexure import fem
from tensegym.flexure.hinge import Material
from tensegym.flexure.hinge.presets import cross_spring, leaf_spring
from tensegym.validation.row import Findings, Row


def end_force_elastica(load: float) -> tuple[float, float, float]:
    """x / L, y / L and slope [rad] at the tip of a cantilever under the dead force y with load = P L^2 / EI.

    Elliptic integrals: Mattiasson, Int. J. Num. Meth. Eng. 17, 1981.
    """

    def modulus(slope: float) -> float:
        return float(1 + np.sin(slope)) / 2  # k^2

    def start(slope: float) -> float:
        return float(np.arcsin(1 / np.sqrt(2 * modulus(slope))))

    def miss(slope: float) -> float:
        return float(ellipk(modulus(slope)) - ellipkinc(start(slope), modulus(slope)) - np.sqrt(load))

    slope = brentq(miss, 1e-6, np.pi / 2 - 1e-9, xtol=1e-15)
    m = modulus(slope)
    y = 1 - 2 / np.sqrt(load) * (ellipe(m) - ellipeinc(start(slope), m))
    return float(np.sqrt(2 * np.sin(slope) / load)), float(y), slope


def elastica(engine: str) -> Findings:
    """A cantilever under a dead force at its end, up to P L^2 / EI = 10. No engine takes part."""
    length, thickness = 0.04, 0.04e-4  # so thin that stretch, about (t / L)^2, is below every tolerance here
    hinge = leaf_spring(length=length, thickness=thickness)
    bending = hinge.material.effective_modulus * hinge.leaves[0].width * thickness**3 / 12
    loads = np.array([0.5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10])
    forces = np.zeros((len(loads), 3))
    forces[:, 1] = loads * bending / length**2
    found = fem.apply_wrench(hinge, forces)
    measured = np.column_stack([found.tip / length, found.theta])
    wanted = np.array([end_force_elastica(load) for load in loads.tolist()])
    readings = ("x / L", "deflection / L", "slope, rad")
    rows = [Row("elastica", f"P L^2/EI = {loads[k]:g}: {what}", float(wanted[k, i]), float(measured[k, i]), 1e-5)
            for k in (4, 10) for i, what in enumerate(readings)]  # fmt: skip
    return Findings(rows, {"P L^2/EI": loads.tolist(), "exact": wanted.tolist(), "measured": measured.tolist()})


def princeton(engine: str) -> Findings:
    """The Princeton beam's tip by linear theory, P L^3 / 3 EI, at a thousandth of its loads, where theory is linear.

    Dowell and Traybar 1975: L 0.508 m, 12.3777 x 3.2024 mm, E 71.7 GPa. The experiment's loads bend the soft axis by a
    third of the length, beyond linear theory; the elastica above has that.
    """
    length, wide, thin, young, part = 0.508, 12.3777e-3, 3.2024e-3, 71.7e9, 1e-3
    rows = []
    for axis, width, thickness in (("soft", wide, thin), ("stiff", thin, wide)):
        hinge = leaf_spring(length=length, width=width, thickness=thickness, material=Material(young, 0.31))
        for load in (4.448, 8.896, 13.345):
            exact = load * length**3 / (3 * young * width * thickness**3 / 12)
            tip = fem.apply_wrench(hinge, [0, part * load, 0]).tip[0, 1] / part
            rows.append(Row("princeton", f"{axis} axis, {load:g} N: tip, m", exact, float(tip), 1e-4 * exact))
    return Findings(rows)


def wittrick(engine: str) -> Findings:
    """Cross spring of two leaves of length l that cross at the fraction c: K = 4 (1 - 3 c + 3 c^2) 2 EI / l per radian
    without load. Wittrick, Aeronautical Quarterly 2, 1951; Haringx, Appl. Sci. Res. A1, 1949."""
    fractions = (0.5, 0.3, 0.127, 0.0)
    rows, curve = [], []
    for c in fractions:
        hinge = cross_spring(crossing=c, thickness=0.2e-3)
        leaf = hinge.leaves[0]
        bending = hinge.material.effective_modulus * leaf.width * leaf.thickness**3 / 12
        exact = 4 * (1 - 3 * c + 3 * c**2) * 2 * bending / leaf.length
        turn = 1e-4
        found = float(fem.rotate(hinge, [turn]).moment[0]) / turn
        rows.append(Row("wittrick", f"crossing at {c:g}: stiffness, N m/rad", exact, found, 1e-4 * exact))
        curve.append([exact, found])
    return Findings(rows, {"crossing fraction": list(fractions), "exact, measured, N m/rad": curve})
