"""The FEM against the elastica: closed forms from elliptic integrals, not from any finite element code."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from tensegym.flexure import fem
from tensegym.flexure.hinge.presets import leaf_spring

LENGTH, THICKNESS = 0.04, 0.04e-4  # so thin that stretch, about (t / L)^2, is below every tolerance here
HINGE = leaf_spring(length=LENGTH, thickness=THICKNESS)
EI = HINGE.material.effective_modulus * HINGE.leaves[0].width * THICKNESS**3 / 12
MESHES = (2, 4, 8, 16)


def end_force_elastica(load):
    """x / L, y / L and slope at the tip of a cantilever under the dead force y with load = P L^2 / EI."""

    def modulus(slope):
        return (1 + np.sin(slope)) / 2  # k^2

    def start(slope):
        return np.arcsin(1 / np.sqrt(2 * modulus(slope)))

    def miss(slope):
        return ellipk(modulus(slope)) - ellipkinc(start(slope), modulus(slope)) - np.sqrt(load)

    slope = brentq(miss, 1e-6, np.pi / 2 - 1e-9, xtol=1e-15)
    m = modulus(slope)
    y = 1 - 2 / np.sqrt(load) * (ellipe(m) - ellipeinc(start(slope), m))
    return np.sqrt(2 * np.sin(slope) / load), y, slope


def test_the_closed_form_gives_the_published_values():
    """P L^2 / EI = 4: deflection .66996, shortening 1 - .67106, slope 1.12124 (Mattiasson 1981)."""
    assert end_force_elastica(4.0) == pytest.approx((0.671059, 0.669964, 1.121239), abs=1e-6)


def errors(wrench, exact):
    found = []
    for elements in MESHES:
        solution = fem.apply_wrench(HINGE, wrench, elements=elements)
        assert solution.status[0] == fem.CONVERGED
        found.append(float(np.linalg.norm(solution.tip[0] / LENGTH - exact)))
    return np.array(found)


def test_end_moment_to_90_deg_is_a_quarter_circle():
    error = errors([0, 0, EI / LENGTH * np.pi / 2], [2 / np.pi, 2 / np.pi])
    assert error[-1] < 1e-7  # at 16 elements, of L
    orders = np.log2(error[:-1] / error[1:])
    assert orders == pytest.approx(4, abs=0.15)


def test_end_force_of_4():
    x, y, slope = end_force_elastica(4.0)
    error = errors([0, 4 * EI / LENGTH**2, 0], [x, y])
    assert error[-1] < 1e-6
    assert np.log2(error[:-1] / error[1:]) == pytest.approx(4, abs=0.4)
    assert fem.apply_wrench(HINGE, [0, 4 * EI / LENGTH**2, 0]).theta[0] == pytest.approx(slope, abs=1e-6)


def test_energy_of_the_quarter_circle():
    solution = fem.apply_wrench(HINGE, [0, 0, EI / LENGTH * np.pi / 2])
    assert solution.energy[0] == pytest.approx(EI / LENGTH * (np.pi / 2) ** 2 / 2, rel=1e-6)


def test_rotation_control_meets_load_control():
    loaded = fem.apply_wrench(HINGE, [0, 2 * EI / LENGTH**2, 0])
    turned = fem.rotate(HINGE, loaded.theta, force=[0, 2 * EI / LENGTH**2])
    assert turned.moment[0] == pytest.approx(0, abs=1e-8 * EI / LENGTH)
    assert turned.tip == pytest.approx(loaded.tip, abs=1e-10)


def test_a_full_turn():
    solution = fem.rotate(HINGE, np.linspace(0, 2 * np.pi, 25)[1:], elements=32)
    assert (solution.status == fem.CONVERGED).all()
    assert solution.tip[-1] == pytest.approx([0, 0], abs=1e-5 * LENGTH)
    assert solution.moment[-1] == pytest.approx(2 * np.pi * EI / LENGTH, rel=1e-5)


def test_buckling_is_eulers_and_reported():
    """A cantilever column's load, pi^2 EI / (4 L^2); the perfect column would stay straight past it."""
    euler = np.pi**2 * EI / (4 * LENGTH**2)
    below, beyond = fem.apply_wrench(HINGE, [[-0.99 * euler, 0, 0], [-3 * euler, 0, 0]]).status
    assert (below, beyond) == (fem.CONVERGED, fem.BUCKLED)
    solution = fem.apply_wrench(HINGE, [-3 * euler, 0, 0])
    assert 3 * solution.reached[0] == pytest.approx(1, abs=2e-3)
    assert "buckles at 0.333 of this load" in solution.reason(0)
    assert np.isnan(solution.tip[0]).all()
