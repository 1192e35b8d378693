"""A free rod with a leaf in the middle: the pin in the leaf's place, PyBullet and FEM, as the benchmark has them."""

import runpy
from pathlib import Path

import pytest

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "flexible_rod.py"


@pytest.fixture(scope="module")
def rod():
    return runpy.run_path(str(BENCHMARK))


def test_first_bending_frequency(rod):
    for row in rod["rod_rows"]((0.0, 24.5)):
        assert abs(row["beam"]) < 1e-6
        assert abs(row["pin_fitted_at_load"]) < 1e-5
        assert abs(row["PyBullet"]) < 3e-3
    assert row["pin"] == pytest.approx(-0.018, abs=0.002)  # a spring fitted without the load, under it


def test_what_the_pin_leaves_out_is_far_stiffer(rod):
    bend, *others = (row["Hz"] for row in rod["other_modes"](24.5))
    assert min(others) > 20 * bend
