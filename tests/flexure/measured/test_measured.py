"""Measured data: units are read or refused, noise does not spoil a fit, and a fit says what it does not know."""

import json

import numpy as np
import pytest
from stand_pictures import save, stand

from tensegym.errors import FlexureError, InputError
from tensegym.flexure import fem
from tensegym.flexure.fem.sampling import default_box, fit_states, held_out_states, moment_at
from tensegym.flexure.hinge import States, preset
from tensegym.flexure.hinge.presets import leaf_spring, x_hinge
from tensegym.flexure.measured.measured_file import read_measured
from tensegym.flexure.measured.measured_fit import fit_measured
from tensegym.flexure.measured.noisy_fit import fit_noisy
from tensegym.flexure.models.planar_spring import PlanarSpring
from tensegym.flexure.models.torsion_spring import TorsionSpring
from tests.conftest import assert_refused

LENGTH, ARM = 0.04, 0.12
TIP_NOISE, TORQUE_NOISE = 50e-6, 0.005  # the acceptance: 0.05 mm, 0.5 % of the 30-deg moment


def noisy(states, moment, seed, tip_noise=TIP_NOISE, torque_noise=TORQUE_NOISE):
    rng = np.random.default_rng(seed)
    return States(states.theta, states.tip + rng.normal(0.0, tip_noise, states.tip.shape), states.force,
                  states.moment + rng.normal(0.0, torque_noise * moment, len(states)))  # fmt: skip


def stand_states(hinge, count=30, degrees=24.0):
    """States of the paper's stand: a force across the undeformed arm at its end."""
    theta = np.radians(np.linspace(-degrees, degrees, count))
    return fem.rotate(hinge, theta, direction=fem.arm_direction(theta, ARM)).states()


def write(path, header, rows):
    path.write_text("\n".join([header, *(",".join(f"{v:.9g}" for v in row) for row in rows)]) + "\n")
    return path


def rms(joint, states, moment):
    got = joint.poses(states.theta, states.force)
    tip = np.sqrt(np.mean(np.sum((got.tip - states.tip) ** 2, axis=1)))
    return tip, np.sqrt(np.mean((got.moment - states.moment) ** 2)) / moment


# reading


@pytest.mark.parametrize(("header", "row"), [
    ("angle_deg,x_mm,y_mm,force_N", (30.0, 38.0, 9.0, 0.5)),
    ("force_mN,angle_rad,x_m,y_m", (500.0, np.pi / 6, 0.038, 0.009)),
    ("y_mm,x_mm,theta_deg,Fx_N,Fy_N", (9.0, 38.0, 30.0, 0.0, 0.5)),
    ("theta_rad,x_mm,y_mm,Fx_N,Fy_N,Mz_Nmm", (np.pi / 6, 38.0, 9.0, 0.0, 0.5, 60.0 * np.cos(np.pi / 6))),
    ("angle_deg,x_mm,y_mm,force_N,torque_Nm", (30.0, 38.0, 9.0, 0.5, 0.06 * np.cos(np.pi / 6))),
])  # fmt: skip
def test_every_unit_reads_as_the_same_state(header, row, tmp_path):
    states = read_measured(write(tmp_path / "a.csv", header, [row, row]), ARM)
    assert states.theta == pytest.approx([np.pi / 6] * 2)
    assert states.tip[1] == pytest.approx([0.038, 0.009])
    assert states.force[1] == pytest.approx([0.0, 0.5])
    assert states.moment == pytest.approx([0.5 * ARM * np.cos(np.pi / 6)] * 2)


def test_the_stand_is_read_as_the_fem_loads_it(tmp_path):
    want = stand_states(leaf_spring(), 7)
    rows = np.column_stack([np.degrees(want.theta), 1e3 * want.tip, want.force[:, 1]])
    got = read_measured(write(tmp_path / "a.csv", "angle_deg,x_mm,y_mm,force_N", rows), ARM)
    assert got.moment == pytest.approx(want.moment, abs=1e-9)


def test_torque_alone_is_a_pure_moment_and_empty_cells_are_not_measured(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("\ufeffangle_deg,x_mm,y_mm,torque_Nmm,remark\n10,39,3,50,ok\n\n20,,,100,camera off\n")
    states = read_measured(path)
    assert np.array_equal(states.force, np.zeros((2, 2)))
    assert states.moment == pytest.approx([0.05, 0.1])
    assert np.isnan(states.tip[1]).all()
    assert len(states.whole()) == 1


@pytest.mark.parametrize(("content", "words"), [
    ("angle_deg,force_N\n1,0.1\n2,-1e299\n", ("row 2: force = -1e+299 in SI units is above 1e+06",)),
    ("angle,x_mm,y_mm,force_N\n1,2,3,4\n", ("'angle'", "no unit", "angle_deg or angle_rad")),
    ("angle_deg,x,y_mm,force_N\n1,2,3,4\n", ("'x'", "no unit", "x_mm or x_m")),
    ("angle_deg,x_mm,y_inch,force_N\n1,2,3,4\n", ("'y_inch'", "unknown unit 'inch'", "y_mm or y_m")),
    ("angle_deg,x_mm,y_mm,torque\n1,2,3,4\n", ("'torque'", "torque_Nmm or torque_Nm")),
    ("angle_deg,x_mm,y_mm,Fx_kg,Fy_N\n1,2,3,4,5\n", ("'Fx_kg'", "Fx_N or Fx_mN")),
    ("angle [deg],x_mm,y_mm,force_N\n1,2,3,4\n", ("'angle [deg]'", "no unit")),
    ("x_mm,y_mm,force_N\n2,3,4\n", ("no column angle_deg",)),
    ("angle_deg,x_mm,force_N\n1,2,4\n", ("x without y",)),
    ("angle_deg,x_mm,y_mm,Fx_N\n1,2,3,4\n", ("Fx without Fy",)),
    ("angle_deg,x_mm,y_mm\n1,2,3\n", ("no load",)),
    ("angle_deg,theta_rad,x_mm,y_mm,force_N\n1,1,2,3,4\n", ("angle is given twice",)),
    ("angle_deg,x_mm,y_mm,force_N,Fx_N,Fy_N\n1,2,3,4,5,6\n", ("force beside Fx",)),
    ("angle_deg,x_mm,y_mm,force_N\n1,2,3,4\n1,two,3,4\n", ("row 2", "x_mm", "'two'")),
    ("angle_deg,x_mm,y_mm,force_N\n1,2,3,inf\n", ("row 1", "force_N", "'inf'")),
    ("angle_deg,x_mm,y_mm,force_N\n1,2,3,4\n,2,3,4\n", ("row 2 has no angle",)),
    ("angle_deg,x_mm,y_mm,force_N\n1,2,3\n", ("line 2: 3 cells",)),
    ("angle_deg,x_mm,y_mm,force_N\n", ("no rows",)),
    ("", ("empty",)),
], ids=lambda value: value[-1] if isinstance(value, tuple) else "")  # fmt: skip
def test_a_file_that_cannot_be_trusted_is_refused_in_one_line(content, words, cli, tmp_path):
    path, out = tmp_path / "bad.csv", tmp_path / "joint.json"
    path.write_text(content)
    assert_refused(cli("flexure", "fit", "--data", path, "--out", out), "bad.csv", *words)
    assert not out.exists()


def test_a_binary_file_is_no_csv(tmp_path):
    path = tmp_path / "bad.csv"
    path.write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match="not a CSV"):
        read_measured(path)


# fitting the potential to noise


@pytest.mark.parametrize("name", ["x-hinge", "leaf-spring", "trls2", "tfch"])
def test_noise_of_a_stand_leaves_the_clean_held_out_error_small(name):
    hinge = preset(name)
    box, moment = default_box(hinge), moment_at(hinge, np.radians(30.0))
    held_out = held_out_states(hinge, box, 300)
    for count in (60, 600):
        for seed in (0, 1, 2):
            data = noisy(fit_states(hinge, box, count), moment, seed)
            fit = fit_noisy(data, hinge.length, box=box)
            tip, torque = rms(fit.potential, held_out, moment)
            assert tip < 15e-6
            assert torque < 0.002
            assert fit.tip_noise == pytest.approx(TIP_NOISE, rel=0.2)
            assert fit.moment_noise == pytest.approx(TORQUE_NOISE * moment, rel=0.2)


def test_without_noise_the_prior_does_not_hold_the_fit_back():
    hinge = x_hinge()
    box, moment = default_box(hinge), moment_at(hinge, np.radians(30.0))
    fit = fit_noisy(fit_states(hinge, box, 200), hinge.length, box=box)
    tip, torque = rms(fit.potential, held_out_states(hinge, box, 100), moment)
    assert tip < 1e-6
    assert torque < 1e-4
    assert not [c for c in fit.coefficients if c.doubt]


def test_the_stated_error_of_a_coefficient_is_its_scatter():
    hinge = leaf_spring()
    clean = stand_states(hinge, 40)
    fits = [fit_noisy(noisy(clean, 0.045, seed), hinge.length) for seed in range(16)]
    # M0 is taken from the noisy data, so compare the stiffness at rest, su[0]^2 M0 / theta0^2
    firsts = [fit.coefficients[0] for fit in fits]
    stiffness = [c.value**2 * f.potential.moment_scale for c, f in zip(firsts, fits, strict=True)]
    stated = np.mean([2.0 * c.error / c.value for c in firsts])
    assert 0.5 < stated / (np.std(stiffness, ddof=1) / np.mean(stiffness)) < 2.0


def test_one_path_of_the_stand_cannot_tell_what_an_axial_force_would():
    hinge = leaf_spring()
    path = noisy(stand_states(hinge), 0.045, 3)
    doubted = {c.name for c in fit_noisy(path, hinge.length).coefficients if c.doubt}
    assert {"sa[0]", "sb[0]", "g[0]"} <= doubted
    assert not {"su[0]", "sk[0]", "rho[2]"} & doubted
    exact = fit_noisy(fit_states(hinge, default_box(hinge), 200), hinge.length)
    assert not {"sa[0]", "sb[0]", "g[0]"} & {c.name for c in exact.coefficients if c.doubt}


def test_pure_moments_cannot_tell_how_a_hinge_gives_across():
    hinge = leaf_spring()
    theta = np.radians(np.linspace(-25.0, 25.0, 40))
    fit = fit_noisy(noisy(fem.rotate(hinge, theta).states(), 0.05, 0), hinge.length)
    doubts = {c.name: c.doubt for c in fit.coefficients if c.doubt}
    assert {"sk[0]", "sa[0]", "g[0]"} <= set(doubts)
    assert "hardly depend" in doubts["sk[0]"]


def test_too_few_states_and_a_turned_sign_are_refused():
    hinge = leaf_spring()
    path = stand_states(hinge, 17)
    fit_noisy(path, LENGTH)
    with pytest.raises(FlexureError, match="16 states with angle, tip and load for a potential of 17 coefficients"):
        fit_noisy(path.pick(slice(1, None)), LENGTH)
    with pytest.raises(FlexureError, match="against the angle"):
        fit_noisy(States(path.theta, path.tip, -path.force, -path.moment), LENGTH)
    with pytest.raises(FlexureError, match="no rotation or no load"):
        fit_noisy(States(0 * path.theta, path.tip, path.force, path.moment), LENGTH)


# the simpler models


def test_each_spring_comes_back_from_its_own_states():
    path = stand_states(leaf_spring(), 12)
    for spring, model, values in (
        (TorsionSpring(LENGTH, 0.78, 0.13), "torsion", [0.78, 0.13]),
        (PlanarSpring(LENGTH, 0.5, 4e3, 700.0, 0.13), "planar", [0.5, 4e3, 700.0, 0.13]),
    ):
        force = path.force + np.array([0.3, 0.0])
        fit = fit_measured(spring.poses(path.theta, force), LENGTH, model)
        assert [c.value for c in fit.coefficients] == pytest.approx(values, rel=1e-3)
        assert not fit.unidentified
        assert fit.joint.errors[model].tip_rms < 1e-7
        assert fit.noise is None  # 12 states cannot carry a potential to compare with


def test_a_simple_model_tells_its_own_error_from_the_noise():
    data = noisy(stand_states(leaf_spring(), 40), 0.045, 5)
    fit = fit_measured(data, LENGTH, "torsion")
    assert fit.noise is not None
    assert fit.noise[0] == pytest.approx(TIP_NOISE, rel=0.2)
    assert fit.joint.errors["torsion"].tip_rms > 10 * fit.noise[0]


def test_a_planar_spring_under_pure_moments_does_not_know_its_translation():
    theta = np.radians(np.linspace(-25.0, 25.0, 40))
    data = noisy(fem.rotate(leaf_spring(), theta).states(), 0.05, 0)
    fit = fit_measured(data, LENGTH, "planar")
    assert {c.name for c in fit.unidentified} == {"kx_N_per_m", "ky_N_per_m"}
    with pytest.raises(FlexureError, match=r"3 states .* 4 coefficients of planar"):
        fit_measured(data.pick(slice(3)), LENGTH, "planar")
    with pytest.raises(FlexureError, match="one of potential, planar, torsion"):
        fit_measured(data, LENGTH, "cubic")


# the command


def test_pictures_to_csv_to_joint(cli, tmp_path):
    pytest.importorskip("PIL")
    hinge = leaf_spring()
    truth = stand_states(hinge, 19, 20.0)
    pictures, loads = [], ["image,force_N"]
    for k in range(len(truth)):
        theta, tip = float(np.degrees(truth.theta[k])), tuple(1e3 * truth.tip[k])
        pictures.append(save(stand(theta, tip, blur=0.8, noise=3.0, seed=k).drawn(), tmp_path / f"{k}.png"))
        loads.append(f"{k}.png,{truth.force[k, 1]:.5f}")
    (tmp_path / "loads.csv").write_text("\n".join(loads) + "\n")
    data, out = tmp_path / "data.csv", tmp_path / "joint.json"
    status, _, err = cli("flexure", "track", *pictures, "--arm-length-mm", 120, "--rest", pictures[9],
                         "--loads", tmp_path / "loads.csv", "--out", data)  # fmt: skip
    assert (status, err) == (0, "")
    status, text, err = cli("flexure", "fit", "--data", data, "--out", out, "--json")
    assert (status, err) == (0, "")
    told = json.loads(text)
    assert (told["states"], told["model"]) == (19, "potential")
    assert told["covered"]["Fx_N"] == [0.0, 0.0]
    assert told["noise"]["tip_coordinate_m"] < 0.1e-3
    stiffness = moment_at(hinge, 0.01) / 0.01
    rows = {c["name"]: c for c in told["coefficients"]}
    joint = told["joint"]["models"]["potential"]
    at_rest = rows["su[0]"]["value"] ** 2 * joint["moment_scale_Nm"] / joint["angle_scale_rad"] ** 2
    assert at_rest == pytest.approx(stiffness, rel=0.02)
    assert rows["sa[0]"]["doubt"]
    assert out.exists()
    for model in ("planar", "torsion"):
        status, text, _ = cli("flexure", "fit", "--data", data, "--model", model, "--out", out)
        assert status == 0
        assert model in text


def test_the_command_takes_its_lengths_from_the_hinge_and_refuses_few_states(cli, tmp_path):
    truth, out = stand_states(leaf_spring(), 20), tmp_path / "joint.json"
    rows = np.column_stack([np.degrees(truth.theta), 1e3 * truth.tip, truth.force[:, 1]])
    data = write(tmp_path / "data.csv", "angle_deg,x_mm,y_mm,force_N", rows)
    one = cli("flexure", "fit", "leaf-spring", "--data", data, "--out", out, "--json")
    other = cli("flexure", "fit", "--data", data, "--length-mm", 40, "--arm-mm", 120, "--out", out, "--json")
    assert one == other
    assert one[0] == 0
    few = write(tmp_path / "few.csv", "angle_deg,x_mm,y_mm,force_N", rows[:10])
    out.unlink()
    assert_refused(cli("flexure", "fit", "--data", few, "--out", out), "few.csv", "10 states", "17 coefficients")
    assert_refused(cli("flexure", "fit", "--data", data, "--length-mm", -1, "--out", out), "length")
    assert_refused(cli("flexure", "fit", "--out", out), "--data")
    assert not out.exists()
