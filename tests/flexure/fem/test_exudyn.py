"""A second opinion on the FEM: exudyn's ANCF cables, clamped to rigid bodies, as in benchmarks/flexure.py."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from tensegym.flexure import fem
from tensegym.flexure.hinge import preset

pytest.importorskip("exudyn")


@pytest.fixture
def benchmark(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[3] / "benchmarks"))
    return import_module


@pytest.mark.parametrize("name", ["leaf-spring", "tfch"])
def test_tip_at_30_deg_within_1e_4_mm(name, benchmark):
    hinge = preset(name)
    ours = fem.rotate(hinge, [np.radians(30)])
    theirs = benchmark("flexure").exudyn_sweep(hinge, float(ours.moment[0]), 16, steps=10)
    assert 1e3 * np.linalg.norm(theirs.tip - ours.tip[0]) < 1e-4  # mm
    assert theirs.theta == pytest.approx(ours.theta[0], abs=1e-6)


@pytest.mark.parametrize("axial", [0.0, -30.0])
def test_stiffness_of_a_parallelogram_along_its_travel(axial, benchmark):
    """Across and along, to 15 % of the length; half of the load that buckles it among them."""
    y, y_, across, across_, along, along_ = (
        benchmark("parallelogram").compared(preset("parallel-guide"), axial, (0.0, 0.05, 0.15)).T
    )
    assert y_ == pytest.approx(y, abs=1e-7)
    assert across_ == pytest.approx(across, rel=2e-3)
    assert along_ == pytest.approx(along, rel=1e-3)
