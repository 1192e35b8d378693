"""The virtual stand: what the camera and the dynamometer say against the FEM, and the arm let go."""

import json

import numpy as np
import pytest

from tensegym.errors import FlexureError
from tensegym.flexible.stand import pull, release
from tensegym.flexure.hinge import preset
from tensegym.flexure.models.joint_fit import fit_joint
from tests.conftest import assert_refused


def test_the_stand_measures_what_the_fem_says(tmp_path, cli):
    """Joint within the fit's error, camera to 0.2 mm and 0.05 deg, its fit to 0.1 mm and 0.1 % torque; the files."""
    pytest.importorskip("matplotlib")
    out = tmp_path / "stand"
    status, text, err = cli("flexure", "stand", "leaf-spring", "--out", out, "--points", 17, "--seconds", 1, "--json")
    assert status == 0, err
    data = json.loads(text)
    gaps = data["less_fem"]
    assert gaps["joint in PyBullet"]["tip_m"] < 3e-6
    assert gaps["joint in PyBullet"]["torque_share"] < 5e-4
    assert gaps["virtual measurement"]["tip_m"] < 2e-4
    assert gaps["fit to the measurement"]["tip_m"] < 1e-4
    assert gaps["fit to the measurement"]["torque_share"] < 1e-3
    assert data["camera"]["angle_deg"] < 0.05
    assert data["energy_max_share"] < 1.001
    for name in ("fig5.png", "vibration.png", "measured.csv", "stand.csv", "vibration.csv", "pictures/rest.png"):
        assert (out / name).stat().st_size > 100
    # the CSV is what `fit --data` reads
    status, text, err = cli("flexure", "fit", "--data", out / "measured.csv", "--model", "planar", "--out",
                            tmp_path / "joint.json", "--json")  # fmt: skip
    assert status == 0, err


def test_force_and_pose_obey_the_mirror():
    joint = fit_joint(preset("leaf-spring"), held_out=0)
    pulled = pull(joint, 5)
    np.testing.assert_allclose(pulled.force, -pulled.force[::-1], atol=2e-4)
    np.testing.assert_allclose(pulled.poses[:, 2], -pulled.poses[::-1, 2], atol=2e-5)
    assert pulled.pictures == ()


def test_damping_shows_in_the_decrement():
    joint = fit_joint(preset("leaf-spring"), held_out=0)
    loss = 2e-3
    run = release(joint, np.radians(5), 2.0, loss_time=loss)
    # delta = 2 pi zeta / sqrt(1 - zeta^2), zeta = loss time w / 2
    zeta = loss * np.pi * run.frequency
    assert run.decrement == pytest.approx(2 * np.pi * zeta / np.sqrt(1 - zeta**2), rel=0.03)


def test_bad_input(tmp_path, cli):
    assert_refused(cli("flexure", "stand", "leaf", "--out", tmp_path / "a"), "leaf", "one of")
    assert_refused(cli("flexure", "stand", "leaf-spring", "--out", tmp_path / "b" / "c"), "no folder")
    assert_refused(cli("flexure", "stand", "leaf-spring", "--out", tmp_path / "a", "--points", 2), "points = 2")
    assert_refused(cli("flexure", "stand", "leaf-spring", "--out", tmp_path / "a", "--release-deg", 80), "outside")
    assert_refused(cli("flexure", "stand", "leaf-spring", "--length-mm", 50, "--out", tmp_path / "a"), "40 mm", "50 mm")
    assert not (tmp_path / "a").exists()
    with pytest.raises(FlexureError, match="40 deg is outside"):
        release(fit_joint(preset("leaf-spring"), held_out=0, max_force=0.3), np.radians(40), 1.0)
