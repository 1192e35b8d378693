"""A second opinion on the FEM: exudyn's ANCF cables, clamped to rigid bodies, as in benchmarks/flexure.py."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from tensegym.flexure import fem
from tensegym.flexure.hinge import preset

pytest.importorskip("exudyn")


def benchmark():
    path = Path(__file__).parents[3] / "benchmarks" / "flexure.py"
    spec = importlib.util.spec_from_file_location("benchmarks_flexure", path)
    module = importlib.util.module_from_spec(spec)
    import sys

    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", ["leaf-spring", "tfch"])
def test_tip_at_30_deg_within_1e_4_mm(name):
    hinge = preset(name)
    ours = fem.rotate(hinge, [np.radians(30)])
    theirs = benchmark().exudyn_sweep(hinge, float(ours.moment[0]), 16, steps=10)
    assert 1e3 * np.linalg.norm(theirs.tip - ours.tip[0]) < 1e-4  # mm
    assert theirs.theta == pytest.approx(ours.theta[0], abs=1e-6)
