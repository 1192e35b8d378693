"""Measured data as people have them: what is unambiguous is read, what this hinge cannot do is refused in a line."""

from pathlib import Path

import numpy as np
import pytest

from tensegym.errors import FlexureError, InputError
from tensegym.flexure import fem
from tensegym.flexure.fem.sampling import default_box, fit_states
from tensegym.flexure.hinge import PAPER_HINGES, States, preset
from tensegym.flexure.measured import fit_measured, read_measured
from tensegym.flexure.measured.plausibility import check_measured, load_note
from tests.conftest import assert_refused

CASES = Path(__file__).parents[1] / "cases"
LENGTH, ARM = 0.06, 0.1  # m, of the cases with x and y


def torsion(path):
    fit = fit_measured(read_measured(path, ARM), LENGTH, "torsion")
    return {c.name: c for c in fit.coefficients}


@pytest.fixture
def good():
    return read_measured(CASES / "measured_xy_good.csv", ARM)


def test_a_good_file_is_fitted():
    found = torsion(CASES / "measured_xy_good.csv")
    assert found["lambda"].value == pytest.approx(0.776, abs=5e-4)
    assert found["k_Nm_per_rad"].value == pytest.approx(0.05546, abs=5e-6)


@pytest.mark.parametrize("name", ["measured_torque.csv", "measured_german.csv"])
def test_angle_and_torque_alone_give_a_torsion_spring(name):
    found = torsion(CASES / name)
    assert found["k_Nm_per_rad"].value == pytest.approx(0.0125, rel=1e-5)
    assert found["k_Nm_per_rad"].error < 1e-6 and not found["k_Nm_per_rad"].doubt
    assert "no tip (x, y) was measured" in found["lambda"].doubt


def test_the_standard_error_of_a_stiffness_from_torques_is_its_scatter():
    theta, rng = np.radians(np.linspace(-20, 20, 30)), np.random.default_rng(0)
    nowhere, none = np.full((30, 2), np.nan), np.zeros((30, 2))
    fits = [fit_measured(States(theta, nowhere, none, 0.1 * theta + rng.normal(0, 1e-3, 30)), 0.04, "torsion")
            for _ in range(200)]  # fmt: skip
    stiffness = [fit.coefficients[1] for fit in fits]
    scatter = np.std([c.value for c in stiffness], ddof=1)
    assert np.mean([c.error for c in stiffness]) == pytest.approx(scatter, rel=0.15)


def test_forces_without_tips_say_that_the_pin_is_unknown():
    theta = np.radians(np.linspace(-20, 20, 21))
    states = fem.rotate(preset("leaf-spring"), theta, direction=fem.arm_direction(theta, 0.12)).states()
    blind = States(theta, np.full((21, 2), np.nan), states.force, states.moment)
    stiffness = fit_measured(blind, 0.04, "torsion").coefficients[1]
    seen = fit_measured(states, 0.04, "torsion").coefficients[1]
    assert "depends on where the pin stands" in stiffness.doubt
    assert abs(stiffness.value - seen.value) < stiffness.error


def test_the_other_models_need_the_tip(cli, tmp_path):
    out = tmp_path / "o.json"
    result = cli("flexure", "fit", "--data", CASES / "measured_torque.csv", "--out", out)
    assert_refused(result, "measured_torque.csv", "no tip (x, y) was measured", "fit torsion")
    assert not out.exists()


def test_a_torque_only_joint_goes_to_a_file_and_back(cli, tmp_path):
    from tensegym.flexure import load_joint

    out = tmp_path / "o.json"
    status, text, _ = cli("flexure", "fit", "--data", CASES / "measured_german.csv", "--model", "torsion", "--out", out)
    assert status == 0 and "tip not measured" in text
    assert load_joint(out).model("torsion").stiffness == pytest.approx(0.0125, rel=1e-5)


def test_y_downwards_is_refused(cli, tmp_path):
    out = tmp_path / "o.json"
    result = cli("flexure", "fit", "--data", CASES / "measured_xy_ydown.csv", "--length-mm", 60, "--arm-mm", 100,
                 "--model", "torsion", "--out", out)  # fmt: skip
    assert_refused(result, "measured_xy_ydown.csv", "y = -5.06 mm", "+8.99 deg", "y is counted downwards")
    assert not out.exists()


@pytest.mark.parametrize(("change", "words"), [
    (lambda s: States(s.theta, 1e-3 * s.tip, s.force, s.moment), "the positions are in m under a header in mm"),
    (lambda s: States(s.theta, 1e3 * s.tip, s.force, s.moment), "the positions are in mm under a header in m"),
    (lambda s: States(s.theta, s.tip - [LENGTH, 0], s.force, s.moment), "counted from the tip at rest"),
    (lambda s: States(s.theta, s.tip - [-0.03, 0], s.force, s.moment), "another length, or x is not counted"),
    (lambda s: States(s.theta, s.tip - [0, 0.02], s.force, s.moment), "not counted from the hinge's fixed end"),
    (lambda s: States(-s.theta, s.tip, s.force, s.moment), "or the angle clockwise"),
    (lambda s: States(s.theta, s.tip, -s.force, -s.moment), "the moment turns against the angle"),
])  # fmt: skip
@pytest.mark.parametrize("model", ["potential", "planar", "torsion"])
def test_another_unit_sign_or_origin_is_named_whatever_is_fitted(change, words, model, good):
    with pytest.raises(FlexureError, match=words) as caught:
        fit_measured(change(good), LENGTH, model)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize("name", [*PAPER_HINGES, "cross-spring", "parallel-guide"])
def test_what_a_hinge_does_passes(name):
    """Its sweeps by force and by moment, one-sided too, and wrenches all over its box, with the noise of a stand."""
    hinge = preset(name)
    theta = hinge.max_angle * np.linspace(-1, 1, 31)
    rng = np.random.default_rng(1)
    for states in (fem.rotate(hinge, theta).states(), fem.rotate(hinge, theta[15:]).states(),
                   fem.rotate(hinge, theta, direction=fem.arm_direction(theta, 0.12)).states(),
                   fit_states(hinge, default_box(hinge), 200)):  # fmt: skip
        tip = states.tip + rng.normal(0, 5e-5, states.tip.shape)
        check_measured(States(states.theta, tip, states.force, states.moment), hinge.length)


@pytest.mark.parametrize(("text", "words"), [
    ("angle_deg;torque_Nmm\n1,5;1.234,5\n2;3\n", ("row 1, torque_Nmm", "'1.234,5' is not a number")),
    ("angle_rad,torque_Nmm\n0.1,1\n25,3\n", ("row 2", "1432 deg", "degrees under a header in rad")),
    ("angle_deg,torque_Nmm\n1,5,1,234\n", ("line 2: 4 cells",)),
    ("angle_deg,torque_Nmm\n1_0,5\n2,5\n", ("'1_0' is not a number",)),
    ("angle_deg,torque_Nmm\n1,5\0\n2,5\n", ()),
])  # fmt: skip
def test_what_is_ambiguous_is_refused(text, words, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_measured(path)
    assert all(word in str(caught.value) for word in words) and "\n" not in str(caught.value)


@pytest.mark.parametrize("text", [
    "angle_deg;torque_Nmm\n1,5;-2,5e1\n2;3\n",
    "\ufeffangle_deg\ttorque_Nmm\r\n1,5\t-25\r\n2\t3\r\n",
    "angle_deg,torque_Nmm,\n1.5,-25,\n2,3,\n",
    "angle_deg,torque_Nmm\n1.5,-25,,\n2,3\n\n",
])  # fmt: skip
def test_separators_and_decimal_commas_are_read(text, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8", newline="")
    states = read_measured(path)
    assert states.theta == pytest.approx(np.radians([1.5, 2]))
    assert states.moment == pytest.approx([-0.025, 0.003])


@pytest.mark.parametrize(("change", "said"), [
    (lambda s: s, None),
    (lambda s: States(s.theta, s.tip, 1e3 * s.force, 1e3 * s.moment), "the load is 1e+03 times"),
    (lambda s: States(s.theta / 57.3, s.tip, s.force, s.moment), "the load is"),
])  # fmt: skip
def test_loads_are_held_against_the_hinges_fem(change, said):
    hinge = preset("leaf-spring")
    theta = np.radians(np.linspace(-24, 24, 13))
    for states in (fem.rotate(hinge, theta).states(),
                   fem.rotate(hinge, theta, direction=fem.arm_direction(theta, 0.12)).states()):  # fmt: skip
        note = load_note(change(states), hinge)
        assert (note == "") if said is None else (said in note and "unit of " in note)


def test_the_command_says_so_in_report_and_file(cli, tmp_path):
    data, out = CASES / "measured_torque.csv", tmp_path / "o.json"
    status, text, _ = cli("flexure", "fit", "leaf-spring", "--data", data, "--model", "torsion",
                          "--youngs-modulus-GPa", 210, "--out", out)  # fmt: skip
    assert status == 0 and "E = 210 GPa" in text and "note: at" in text
    assert "times that of this hinge's FEM" in out.read_text()
