"""`tensegym flexure table, curves, fit, solve`: what they write, and one clear line for each bad input."""

import csv
import json

import numpy as np
import pytest

from tensegym.cli.flexure.table import PAPER_TABLE_1
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import PAPER_HINGES, preset
from tensegym.flexure.models.joint_file import joint_to_dict, load_joint, save_joint
from tensegym.flexure.models.joint_fit import fit_joint
from tests.conftest import assert_refused

LOADS = "Fx_N,Fy_N,Mz_Nmm\n0,0.5,10\n-0.5,0.2,-20\n0,0,0\n"


@pytest.fixture(scope="module")
def joint_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("joint") / "joint.json"
    save_joint(fit_joint(preset("leaf-spring"), held_out=50), path)
    return path


@pytest.fixture
def loads(tmp_path):
    path = tmp_path / "loads.csv"
    path.write_text(LOADS)
    return path


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_table(cli):
    status, out, _ = cli("flexure", "table", "--json", "--loops", 5, "--held-out", 60)
    assert status == 0
    hinges = json.loads(out)["hinges"]
    assert list(hinges) == list(PAPER_HINGES)
    for name, facts in hinges.items():
        ours = facts["table_1"]
        assert ours["lambda"] == pytest.approx(PAPER_TABLE_1[name][0], abs=0.02)
        assert ours["dx"]["b"] == pytest.approx(PAPER_TABLE_1[name][2], abs=0.02)
        assert facts["errors"]["potential"]["tip_rms_m"] < 5e-6
        assert facts["loop_work"]["potential"]["largest"] < 1e-7
        assert "beam modulus" in facts["source"]


def test_table_as_text_and_other_hinges(cli):
    status, out, _ = cli(
        "flexure", "table", "--hinges", "x-hinge", "--modulus", "plate", "--loops", 2, "--held-out", 20
    )
    assert status == 0
    assert "plate modulus E/(1-nu^2)" in out
    assert "ours, F2 as printed" in out and "paper's dx is not reproduced" in out
    status, out, _ = cli(
        "flexure", "table", "--hinges", "cross-spring", "--crossing", 0.3, "--loops", 2, "--held-out", 20
    )
    assert status == 0 and "no row of the paper's table" in out


def test_fit_writes_a_small_readable_file(cli, tmp_path):
    out = tmp_path / "joint.json"
    status, text, _ = cli("flexure", "fit", "tfch", "--out", out, "--thickness-mm", 1.0, "--held-out", 20)
    assert status == 0 and "potential certified" in text
    data = json.loads(out.read_text())
    assert data["hinge"]["leaf"][0]["thickness_mm"] == 1.0
    assert data["hinge"]["material"]["youngs_modulus_GPa"] == 2.95
    assert set(data["models"]) == {"potential", "planar", "paper", "torsion"}
    assert len(out.read_text()) < 20_000
    status, text, _ = cli("flexure", "fit", "tfch", "--out", out, "--held-out", 20, "--json")
    assert status == 0 and json.loads(text)["certificate"]["buckling"] > 0


def test_joint_round_trip(joint_file, tmp_path):
    joint = load_joint(joint_file)
    save_joint(joint, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_text() == joint_file.read_text()
    assert joint.model("potential").wrench(0.0395, 0.005, 0.2) == pytest.approx(
        fit_joint(preset("leaf-spring"), held_out=0).model("potential").wrench(0.0395, 0.005, 0.2), rel=1e-12
    )


@pytest.mark.parametrize("model", ["fem", "potential", "planar", "paper", "torsion"])
def test_solve_by_every_model(model, cli, joint_file, loads, tmp_path):
    out = tmp_path / "poses.csv"
    status, _, _ = cli("flexure", "solve", "--joint", joint_file, "--model", model, "--loads", loads, "--out", out)
    rows = read(out)
    assert list(rows[0]) == ["Fx_N", "Fy_N", "Mz_Nmm", "theta_rad", "x_mm", "y_mm", "strain_energy_Nmm", "status"]
    assert [float(r["Mz_Nmm"]) for r in rows] == [10, -20, 0]
    assert status == 0 and [r["status"] for r in rows] == ["ok"] * 3
    assert float(rows[2]["theta_rad"]) == pytest.approx(0, abs=1e-9)
    assert (float(rows[2]["x_mm"]), float(rows[2]["y_mm"])) == pytest.approx((40, 0), abs=1e-6)
    assert (rows[0]["strain_energy_Nmm"] == "") == (model == "paper")  # the diagrams have no energy


def test_solve_potential_and_fem_agree(cli, joint_file, loads, tmp_path):
    answers = []
    for model in ("fem", "potential"):
        out = tmp_path / f"{model}.csv"
        assert (
            cli("flexure", "solve", "--hinge", "leaf-spring", "--model", model, "--loads", loads, "--out", out)[0] == 0
        )
        names = ("theta_rad", "x_mm", "y_mm", "strain_energy_Nmm")
        answers.append([[float(row[n]) for n in names] for row in read(out)])
    assert np.array(answers[1]) == pytest.approx(np.array(answers[0]), rel=1e-4, abs=2e-3)


def test_rows_that_fail_are_marked(cli, joint_file, tmp_path):
    loads, out = tmp_path / "loads.csv", tmp_path / "out.csv"
    loads.write_text("Mz_Nmm,Fx_N,Fy_N\n10,0,0.1\n0,-60,0\n500,0,0\n")
    status, text, _ = cli("flexure", "solve", "--hinge", "leaf-spring", "--loads", loads, "--out", out)
    rows = read(out)
    assert status == 1 and "row 2: buckles at 0.129 of this load" in text
    assert rows[0]["status"] == "ok" and rows[1]["status"].startswith("buckles") and rows[1]["theta_rad"] == ""
    status, text, _ = cli(
        "flexure", "solve", "--joint", joint_file, "--model", "potential", "--loads", loads, "--out", out
    )
    rows = read(out)
    assert status == 1 and "outside the fitted" in rows[1]["status"]
    assert "no stable state within +-30 deg" in rows[2]["status"]


def test_curves(cli, tmp_path):
    pytest.importorskip("matplotlib")
    measured = tmp_path / "points.csv"
    measured.write_text("angle_deg,force_N\n10,0.17\n20,0.33\n")
    hinges = ("--hinges", "leaf-spring", "parallel-guide")
    status, out, _ = cli(
        "flexure", "curves", "--out", tmp_path / "c", *hinges, "--data", f"leaf-spring={measured}", "--json"
    )
    assert status == 0
    names = {path.name for path in (tmp_path / "c").iterdir()}
    assert names == {"hinges.png", "torque.png", "drift.png", "stiffness.png", "errors.png", "curves.csv"}
    rows = read(tmp_path / "c" / "curves.csv")
    assert len(rows) == json.loads(out)["rows"]
    assert {r["model"] for r in rows if r["hinge"] == "leaf-spring"} == {
        "fem",
        "potential",
        "planar",
        "paper",
        "torsion",
    }
    assert list(rows[0])[2:] == ["theta_deg", "x_mm", "y_mm", "Fx_N", "Fy_N", "Mz_Nmm"]


@pytest.mark.parametrize(("options", "words"), [
    (("--thickness-mm", 0), ("thickness = 0",)),
    (("--poisson-ratio", 0.6), ("poisson_ratio = 0.6", "[-1, 0.5]")),
    (("--modulus", "shell"), ("modulus = 'shell'",)),
    (("--max-force-N", 8), ("past buckling", "lower max_force")),
    (("--max-force-N", -1), ("max_force_N = -1.0", "[0, 1e+06] N")),
    (("--max-angle-deg", 100), ("max_angle",)),
    (("--states", 4), ("count = 4",)),
    (("--crossing", 0.3), ("has no 'crossing'",)),
    (("--elements", 0), ("elements = 0",)),
    (("--seed", 12345), ("seed = 12345",)),
    (("--force-x-N", 40, 0), ("force_x = (40.0, 0.0) N: the ends are swapped",)),
    (("--force-y-N", 0, 1e7), ("force_y_N = 10000000.0", "[-1e+06, 1e+06] N")),
    (("--force-x-N", -9, 0), ("past buckling", "lower the forces or max_angle")),
])  # fmt: skip
def test_fit_refuses(cli, tmp_path, options, words):
    out = tmp_path / "joint.json"
    assert_refused(cli("flexure", "fit", "leaf-spring", "--out", out, *options), *words)
    assert not out.exists()


def test_bad_hinges_are_refused(cli, tmp_path, loads):
    out = tmp_path / "o"
    assert_refused(cli("flexure", "fit", "leafspring", "--out", out), "unknown hinge 'leafspring'", "leaf-spring")
    assert_refused(cli("flexure", "fit", "none.toml", "--out", out), "no hinge file")
    assert_refused(cli("flexure", "fit", "tfch", "--out", tmp_path / "no" / "o"), "no folder")
    hinge = tmp_path / "h.toml"
    hinge.write_text('length_mm = 40\nbodies = ["ground", "tip", "loose"]\n[[leaf]]\nfrom = "ground"\n'
                     'from_mm = [0, 0]\nto = "tip"\nto_mm = [40, 0]\nwidth_mm = 40\nthickness_mm = 0.8\n')  # fmt: skip
    assert_refused(cli("flexure", "solve", "--hinge", hinge, "--loads", loads, "--out", out), "'loose' is disconnected")
    assert_refused(cli("flexure", "table", "--hinges", hinge), "'loose' is disconnected")
    assert_refused(
        cli("flexure", "solve", "--hinge", hinge, "--thickness-mm", 1, "--loads", loads, "--out", out), "thickness"
    )
    assert not out.exists()


@pytest.mark.parametrize(("text", "words"), [
    ("Fx_N,Fy_N,Mz\n0,0,0\n", ("no column Mz_Nmm", "units")),
    ("Fx_N,Fy_N,Mz_Nmm\n", ("no rows below the header",)),
    ("", ("empty",)),
    ("Fx_N,Fy_N,Mz_Nmm\n0,zero,0\n", ("row 1", "Fy_N: 'zero' is not a number")),
    ("Fx_N,Fy_N,Mz_Nmm\n0,0,0\n0,1\n", ("line 3: 2 cells where the header has 3",)),
    ("Fx_N,Fy_N,Mz_Nmm\n0,nan,0\n", ("Fy_N: 'nan' is not a number",)),
    ("Fx_N,Fy_N,Mz_Nmm\n0,0,0\n0,,1\n", ("row 2 has no Fy_N",)),
])  # fmt: skip
def test_bad_loads_are_refused(cli, tmp_path, text, words):
    loads, out = tmp_path / "loads.csv", tmp_path / "out.csv"
    loads.write_text(text)
    assert_refused(cli("flexure", "solve", "--hinge", "tfch", "--loads", loads, "--out", out), *words)
    assert not out.exists()


def test_solve_needs_one_source_and_a_known_model(cli, joint_file, loads, tmp_path):
    out = ("--loads", loads, "--out", tmp_path / "o.csv")
    assert_refused(cli("flexure", "solve", *out), "give one of --hinge and --joint")
    assert_refused(cli("flexure", "solve", "--hinge", "tfch", "--joint", joint_file, *out), "give one of")
    assert_refused(cli("flexure", "solve", "--hinge", "tfch", "--model", "beam", *out), "model = 'beam'; one of fem")
    assert_refused(cli("flexure", "solve", "--joint", tmp_path / "none.json", *out), "no joint file")
    result = cli("flexure", "solve", "--hinge", "tfch", "--loads", tmp_path / "no.csv", "--out", tmp_path / "o.csv")
    assert_refused(result, "no file")


def test_curves_refuse_data_of_an_unknown_hinge(cli, tmp_path):
    result = cli("flexure", "curves", "--out", tmp_path / "c", "--hinges", "tfch", "--data", "x-hinge=points.csv")
    assert_refused(result, "HINGE=FILE.csv")
    assert not (tmp_path / "c").exists()


@pytest.mark.parametrize(("spoil", "words"), [
    (lambda d: d.update(format="other"), "no joint file"),
    (lambda d: d.pop("box"), "'box' is missing"),
    (lambda d: d["models"].update(cubic={}), "unknown model 'cubic'"),
    (lambda d: d["models"]["potential"]["coefficients_by_power"].pop("su"), "'su' is missing"),
    (lambda d: d["models"]["potential"]["coefficients_by_power"]["su"].update({"9": 1.0}), "power is outside"),
    (lambda d: d["models"]["potential"]["coefficients_by_power"]["g"].update({"0": -1e3}), "is not positive"),
    (lambda d: d["models"]["planar"].update(kx_N_per_m=-1.0), "kx = -1"),
    (lambda d: d["box"].update(max_force_N=0.0), "max_force = 0 N"),
])  # fmt: skip
def test_spoilt_joint_files_are_refused(joint_file, tmp_path, spoil, words):
    data = joint_to_dict(load_joint(joint_file))
    spoil(data)
    path = tmp_path / "spoilt.json"
    path.write_text(json.dumps(data))
    with pytest.raises(FlexureError, match=words):
        load_joint(path)


@pytest.mark.parametrize(("options", "words"), [
    (("table", "--arm-mm", 0), ("x-hinge with arm_mm = 0", "pure moment", "Table 1")),
    (("table", "--table-angle-deg", 120), ("table_angle_deg = 120", "89")),
    (("stand", "leaf-spring", "--arm-mm", 100, "--out", "OUT"), ("arm = 100 mm", "120 mm")),
    (("stand", "leaf-spring", "--force-y-N", 0, 2, "--out", "OUT"), ("--force-y-N has no effect on the stand",)),
    (("fit", "tfch", "--model", "planar", "--out", "OUT"), ("--model has no effect without --data",)),
    (("fit", "--data", "none.csv", "--thickness-mm", 1, "--out", "OUT"), ("--thickness-mm has no effect with --data",)),
    (("fit", "tfch", "--data", "none.csv", "--max-force-N", 1, "--out", "OUT"), ("--max-force-N has no effect",)),
    (("solve", "--joint", "JOINT", "--thickness-mm", 1, "--loads", "LOADS", "--out", "OUT"), ("--thickness-mm",)),
    (("solve", "--hinge", "tfch", "--max-angle-deg", 9, "--loads", "LOADS", "--out", "OUT"), ("--max-angle-deg has",)),
], ids=lambda value: value[0] if isinstance(value[0], str) and len(value) > 1 else "")  # fmt: skip
def test_no_option_means_something_else_than_its_name(cli, options, words, joint_file, loads, tmp_path):
    paths = {"OUT": tmp_path / "o", "JOINT": joint_file, "LOADS": loads}
    assert_refused(cli("flexure", *(paths.get(option, option) for option in options)), *words)
    assert not (tmp_path / "o").exists()


def test_the_load_of_a_hinge_without_an_arm_is_said(cli, tmp_path):
    status, out, _ = cli("flexure", "table", "--hinges", "parallel-guide", "--loops", 2, "--held-out", 10)
    assert status == 0
    assert "parallel-guide has no arm: its rows are of a pure moment" in out
    assert "parallel-guide: its rows are of +-0.01 deg, its range" in out
    joint = fit_joint(preset("parallel-guide"), held_out=0)
    assert any("pure moment" in note for note in joint.notes)
    assert not any("pure moment" in note for note in fit_joint(preset("tfch"), held_out=0).notes)


@pytest.mark.parametrize(("spoil", "words"), [
    (lambda d: d["models"]["potential"].update(degree=2_000_000_000), r"degree = 2000000000 is outside \[0, 30\]"),
    (lambda d: d["models"]["planar"].update(b="x"), "b = 'x' is a text, no number"),
    (lambda d: d["models"]["paper"].update(theta_rad=[0.1, "a"]), r"theta_rad\[2\] = 'a'"),
    (lambda d: d["models"]["paper"].update(theta_rad=[0.2, 0.1]), "angles"),
    (lambda d: d["models"]["paper"].update(kx_N_per_m=[1.0]), "different lengths"),
    (lambda d: d["models"]["torsion"].update({"lambda": None}), "lambda = None"),
    (lambda d: d["errors"]["planar"].update(tip_rms_m="small"), "tip_rms_m = 'small'"),
    (lambda d: d.update(notes="none"), "notes = 'none' must be a list"),
    (lambda d: d.update(source=3), "source = 3 must be a text"),
    (lambda d: d.update(hinge=[1]), "hinge = .* must be a table"),
    (lambda d: d.update(models=[]), "models = .* must be a table"),
])  # fmt: skip
def test_odd_values_in_joint_files_are_named(joint_file, tmp_path, spoil, words):
    data = json.loads(joint_file.read_text())
    spoil(data)
    path = tmp_path / "odd.json"
    path.write_text(json.dumps(data))
    with pytest.raises(FlexureError, match=words) as caught:
        load_joint(path)
    assert "odd.json" in str(caught.value) and len(str(caught.value)) <= 300


@pytest.mark.parametrize("text", ["[" * 100_000, "9" * 5000, '{"format": ', "\x00", "[]", "null"])
def test_texts_that_are_no_joint_files(text, tmp_path):
    path = tmp_path / "no.json"
    path.write_text(text)
    with pytest.raises(FlexureError, match=r"is not JSON|is no joint file|holds null bytes|nested too deep") as caught:
        load_joint(path)
    assert "\n" not in str(caught.value) and len(str(caught.value)) <= 300


def test_a_coarse_mesh_is_told_in_one_line(cli, loads, tmp_path):
    loads.write_text("Fx_N,Fy_N,Mz_Nmm\n0,3,0\n")
    words = ("flexure", "solve", "--hinge", "leaf-spring", "--loads", loads, "--out", tmp_path / "o.csv")
    _, coarse, _ = cli(*words, "--elements", 1)
    _, fine, _ = cli(*words)
    assert coarse.count("note: the mesh is too coarse: elements = 1 is off by") == 1 and "take elements = 2" in coarse
    assert "too coarse" not in fine
    _, fitted, _ = cli("flexure", "fit", "leaf-spring", "--out", tmp_path / "j", "--elements", 1, "--held-out", 0)
    assert fitted.count("too coarse") == 1


def test_profiles_from_the_command_line(cli, tmp_path):
    out = tmp_path / "joint.json"
    status, _, _ = cli(
        "flexure", "fit", "notch-hinge", "--out", out, "--radius-mm", 3, "--depth-mm", 2, "--held-out", 20
    )
    assert status == 0
    data = json.loads(out.read_text())
    assert data["hinge"]["leaf"][0]["notch_mm"] == [3.0, 2.0]
    assert data["errors"]["potential"]["tip_rms_m"] < 1e-6
    assert_refused(
        cli("flexure", "fit", "notch-hinge", "--out", out, "--radius-mm", 6), "above half of the web's length"
    )
    assert_refused(cli("flexure", "fit", "tapered-leaf", "--out", out, "--end-thickness-mm", 0), "end_thickness = 0 m")


def test_a_pivot_that_is_only_pulled(cli, tmp_path):
    """Its pulls, pushed, would buckle it: a box of +-20 N is refused, one of 0 to 20 N fitted and kept."""
    out, loads, poses = (tmp_path / name for name in ("joint.json", "loads.csv", "poses.csv"))
    words = ("flexure", "fit", "leaf-spring", "--out", out, "--held-out", 60)
    assert_refused(cli(*words, "--max-force-N", 20), "past buckling")
    status, text, _ = cli(*words, "--force-x-N", 0, 20)
    assert status == 0 and "at the tip Fx in [0, 20] N and Fy in [-1.648, 1.648] N" in text
    joint = load_joint(out)
    assert joint.box.force_x == (0, 20)
    assert joint.errors["potential"].tip_rms < 5e-6 and joint.errors["potential"].moment_rms < 1e-3
    loads.write_text("Fx_N,Fy_N,Mz_Nmm\n20,1,0\n-1,0,0\n")
    status, text, _ = cli("flexure", "solve", "--joint", out, "--model", "potential", "--loads", loads, "--out", poses)
    assert [row["status"] == "ok" for row in read(poses)] == [True, False]
    assert "row 2: the force (-1, 0) N is outside the fitted Fx in [0, 20] N" in text
    fem = tmp_path / "fem.csv"
    cli("flexure", "solve", "--joint", out, "--loads", loads, "--out", fem)
    assert float(read(poses)[0]["y_mm"]) == pytest.approx(float(read(fem)[0]["y_mm"]), abs=0.02)
