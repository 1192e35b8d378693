"""`tensegym flexure travel`: what it says, draws and refuses."""

import json

import numpy as np
import pytest

from tests.conftest import assert_refused


def test_travel_of_a_guide(cli, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "guide.png"
    words = ("flexure", "travel", "parallel-guide", "--points", 3, "--axial-N", -20)
    status, text, _ = cli(*words, "--out", picture, "--strength-MPa", 10)
    assert status == 0 and picture.stat().st_size > 10_000
    assert "k y N/mm" in text and "used %" in text and "above strength_MPa = 10" in text
    data = json.loads(cli(*words, "--json")[1])
    assert data["driven"] == "y"
    assert np.array(data["tip_m"])[:, 1] == pytest.approx([0, 0.002, 0.004], abs=1e-9)
    assert np.shape(data["stiffness_x_y_turn"]) == np.shape(data["stiffness_z_about_x_about_y"]) == (3, 3, 3)
    euler = 2 * np.pi**2 * 2.95e9 * 0.04 * 0.8e-3**3 / 12 / 0.04**2  # two columns that sway
    assert data["load_factor"][0] == pytest.approx(euler / 20, rel=2e-3)
    assert np.all(np.diff(data["load_factor"]) > 0)


def test_travel_of_a_hinge(cli):
    status, text, _ = cli("flexure", "travel", "leaf-spring", "--points", 2, "--max-angle-deg", 20)
    assert status == 0 and "turned by a force in y at the end of the 120 mm arm" in text
    assert len(text.splitlines()) == 6
    status, text, _ = cli("flexure", "travel", "leaf-spring", "--arm-mm", 0, "--points", 2, "--axial-N", -10)
    assert status == 0 and "by a pure moment, -10 N along x" in text and "note: buckled" in text


@pytest.mark.parametrize(("options", "words"), [
    (("leafspring",), ("did you mean 'leaf-spring'",)),
    (("tfch", "--max-angle-deg", 0), ("max_angle_deg = 0",)),
    (("tfch", "--travel-mm", 0), ("travel_mm = 0",)),
    (("tfch", "--travel-mm", 1, "--max-angle-deg", 3), ("give one of --travel-mm",)),
    (("tfch", "--strength-MPa", 0), ("strength_MPa = 0",)),
    (("tfch", "--travel-mm", 70), ("travel = 70 mm is not below the hinge's length 40 mm",)),
    (("tfch", "--points", 1), ("points = 1", "[2, 1000]")),
    (("parallel-guide", "--axial-N", -900), ("buckles at", "lower the travel or the load")),
    (("tfch", "--out", "no/where.png"), ("no folder",)),
])  # fmt: skip
def test_travel_refuses(cli, options, words):
    assert_refused(cli("flexure", "travel", *options), *words)


def test_guide(cli, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "guide.png"
    status, text, _ = cli("flexure", "guide", "--axial-N", 30, "--travel-mm", 2, "--out", picture)
    assert status == 0 and picture.stat().st_size > 10_000
    assert "beam constraint model" in text and "pseudo-rigid body" in text and "beyond the box" in text
    assert_refused(cli("flexure", "guide", "tfch"), "tfch is no parallelogram", "take parallel-guide")
    assert_refused(cli("flexure", "guide", "--travel-mm", 0), "travel_mm = 0")
    assert_refused(cli("flexure", "guide", "--axial-N", -500), "buckles at", "lower the travel or the load")
