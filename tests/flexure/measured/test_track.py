"""`track`: known poses come back, and pictures that cannot give one are refused by name."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from stand_pictures import ARM_MM, Picture, save, stand

from tensegym.errors import FlexureError
from tensegym.flexure.measured.sighting import sight
from tests.conftest import assert_refused

pytest.importorskip("PIL")

ANGLE_DEG, POSITION = 0.1, 0.005  # the acceptance: 0.1 deg and 0.5 % of the arm

LIGHT = {
    "clean": Picture(),
    "noisy, uneven, soft": Picture(blur=1.2, noise=6.0, uneven=0.6),
    "round ends, square marker": Picture(round_ends=True, square_marker=True, blur=0.8, noise=4.0, uneven=0.4),
}


@pytest.mark.parametrize("scale", [0.6, 1.0, 2.0])
@pytest.mark.parametrize("name", LIGHT)
def test_a_known_pose_comes_back_in_any_light_at_any_size(name, scale):
    rng = np.random.default_rng(7)
    for seed in range(4 if scale < 2.0 else 2):
        angle = rng.uniform(-38.0, 38.0)
        picture = LIGHT[name].scaled(scale)
        moved = (picture.tip[0] + rng.uniform(-4, 4), picture.tip[1] + rng.uniform(-4, 4))
        picture = replace(picture, angle_deg=angle, tip=moved, seed=seed)
        seen = sight(picture.drawn())
        assert np.degrees(seen.angle) == pytest.approx(angle, abs=ANGLE_DEG)
        error_mm = 1e3 * seen.from_marker(ARM_MM * 1e-3) - picture.tip_from_marker_mm()
        assert np.linalg.norm(error_mm) < POSITION * ARM_MM
        assert seen.width == pytest.approx(picture.width, rel=0.05)


def test_the_arm_may_point_anywhere():
    picture = Picture(rows=400, columns=400, tip=(200.0, 200.0), length=150.0, blur=0.7, noise=3.0)
    for angle in (-170.0, -90.0, 90.0, 135.0, 180.0):
        back = np.radians(angle)
        marker = (200.0 - 45.0 * np.cos(back), 200.0 + 45.0 * np.sin(back))
        seen = sight(replace(picture, angle_deg=angle, marker=marker).drawn())
        turn = (np.degrees(seen.angle) - angle + 180.0) % 360.0 - 180.0
        assert abs(turn) < ANGLE_DEG


def test_the_stated_angle_error_is_the_scatter_of_repeated_pictures():
    picture = Picture(blur=1.0, noise=10.0)
    seen = [sight(replace(picture, seed=seed).drawn()) for seed in range(24)]
    scatter = np.std([s.angle for s in seen], ddof=1)
    stated = np.mean([s.angle_error for s in seen])
    assert 0.5 < stated / scatter < 2.0


def test_specks_of_dirt_change_nothing():
    grey = Picture(noise=3.0).drawn()
    clean = sight(grey)
    grey[30:33, 200:203] = grey[200:204, 60:63] = 20.0
    grey[150, 20:30] = 20.0
    dirty = sight(grey)
    assert dirty.angle == pytest.approx(clean.angle, abs=1e-4)
    assert dirty.marker == pytest.approx(clean.marker, abs=0.02)


@pytest.mark.parametrize("bend_deg", [0.0, 15.0])
def test_a_dark_leaf_that_hangs_on_to_the_arm_is_not_part_of_it(bend_deg):
    picture = Picture(blur=0.8, noise=3.0, tip=(124.3, 121.6), marker=(38.7, 180.0))
    turn = np.radians(picture.angle_deg + bend_deg)
    leaf_end = (124.3 - 50.0 * np.cos(turn), 121.6 + 50.0 * np.sin(turn))
    leaf = Picture(tip=leaf_end, angle_deg=picture.angle_deg + bend_deg, length=50.0, width=2.5, marker=GONE, blur=0.8)
    seen = sight(np.minimum(picture.drawn(), leaf.drawn()))
    assert np.degrees(seen.angle) == pytest.approx(picture.angle_deg, abs=ANGLE_DEG)
    error_mm = 1e3 * seen.from_marker(ARM_MM * 1e-3) - picture.tip_from_marker_mm()
    assert np.linalg.norm(error_mm) < POSITION * ARM_MM


GONE = (-500.0, -500.0)
REFUSED = {
    "no marker": (Picture(marker=GONE), "no marker"),
    "marker on the arm": (Picture(marker=(110.0, 121.0)), "no marker"),
    "no arm": (Picture(tip=GONE), "no arm"),
    "blank": (Picture(tip=GONE, marker=GONE), "nothing dark"),
    "blank and noisy": (Picture(tip=GONE, marker=GONE, noise=25.0, uneven=0.5), "nothing dark"),
    "cut": (Picture(tip=(180.0, 121.0)), "runs out of the picture"),
    "short": (Picture(length=40.0, width=8.0), "40 px"),
    "marker half way": (Picture(marker=(184.0, 200.0), angle_deg=0.0), "hinge end"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_picture_that_cannot_be_measured_is_refused_by_name(name, cli, tmp_path):
    picture, words = REFUSED[name]
    good = save(Picture().drawn(), tmp_path / "good.png")
    bad = save(picture.drawn(), tmp_path / "bad.png")
    out = tmp_path / "out.csv"
    assert_refused(cli("flexure", "track", good, bad, "--arm-length-mm", 120, "--out", out), "bad.png", words)
    assert not out.exists()


def test_two_arms_and_two_markers_are_refused():
    one, other = Picture().drawn(), Picture(marker=(60.0, 30.0)).drawn()
    with pytest.raises(FlexureError, match="more than one dark spot"):
        sight(np.minimum(one, other))
    with pytest.raises(FlexureError, match="more than one dark bar"):
        sight(np.minimum(one, Picture(tip=(100.0, 190.0), angle_deg=0.0).drawn()))


def test_a_bent_shape_is_no_arm():
    grey = np.full((240, 320), 200.0)
    column = np.arange(60, 300)
    for c in column:
        middle = 60 + int(0.0022 * (c - 180) ** 2)
        grey[middle - 5 : middle + 5, c] = 20.0
    grey[150:166, 40:56] = 20.0
    with pytest.raises(FlexureError, match="straight"):
        sight(grey)


POSES = [(0.0, (40.0, 0.0)), (-21.0, (39.1, -7.2)), (8.5, (39.9, 2.9)), (17.0, (39.4, 5.8))]


@pytest.fixture
def photos(tmp_path):
    """Four states under a tilted camera, in several formats."""
    names = ["rest.png", "a.jpg", "b.tif", "c.bmp"]
    pictures = [stand(theta, tip, blur=0.8, noise=4.0, uneven=0.5, seed=k) for k, (theta, tip) in enumerate(POSES)]
    return [save(p.drawn(), tmp_path / name) for p, name in zip(pictures, names, strict=True)]


def test_the_csv_holds_the_poses_in_base_axes_and_the_loads(cli, photos, tmp_path):
    out, loads, overlay = tmp_path / "out.csv", tmp_path / "loads.csv", tmp_path / "overlay"
    loads.write_text("force_N,image\n0.42,c.bmp\n0,rest.png\n-0.51,a.jpg\n0.2,b.tif\n")
    status, text, err = cli("flexure", "track", *photos, "--arm-length-mm", 120, "--rest", photos[0],
                            "--loads", loads, "--overlay", overlay, "--out", out, "--json")  # fmt: skip
    assert (status, err) == (0, "")
    with out.open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["image", "angle_deg", "x_mm", "y_mm", "force_N"]
    assert [row["force_N"] for row in rows] == ["0", "-0.51", "0.2", "0.42"]
    for row, (theta, tip), told in zip(rows, POSES, json.loads(text)["pictures"], strict=True):
        assert float(row["angle_deg"]) == pytest.approx(theta, abs=ANGLE_DEG)
        assert np.hypot(float(row["x_mm"]) - tip[0], float(row["y_mm"]) - tip[1]) < POSITION * ARM_MM
        assert told["mm_per_px"] == pytest.approx(0.4, rel=0.003)
    assert sorted(p.name for p in overlay.iterdir()) == ["001-rest.png", "002-a.png", "003-b.png", "004-c.png"]


def test_without_a_rest_picture_the_marker_gives_the_origin(cli, tmp_path):
    picture = save(stand(14.0, (39.5, 4.9), tilt_deg=0.0, blur=0.7).drawn(), tmp_path / "p.png")
    status, text, _ = cli("flexure", "track", picture, "--arm-length-mm", 120, "--marker-x-mm", -8,
                          "--marker-y-mm", 11, "--out", tmp_path / "out.csv", "--json")  # fmt: skip
    told = json.loads(text)["pictures"][0]
    assert status == 0
    assert (told["x_mm"], told["y_mm"]) == pytest.approx((39.5, 4.9), abs=POSITION * ARM_MM)


def test_an_arm_painted_only_beyond_a_clamp_still_gives_the_tip(cli, tmp_path):
    theta = np.radians(14.0)
    painted = (39.5 + 6.0 * np.cos(theta), 4.9 + 6.0 * np.sin(theta))
    rest = save(stand(0.0, (46.0, 0.0), blur=0.7).drawn(), tmp_path / "rest.png")
    picture = save(stand(14.0, painted, blur=0.7).drawn(), tmp_path / "p.png")
    _, text, _ = cli("flexure", "track", picture, "--arm-length-mm", 120, "--arm-start-mm", 6, "--rest", rest,
                     "--out", tmp_path / "out.csv", "--json")  # fmt: skip
    told = json.loads(text)["pictures"][0]
    assert (told["x_mm"], told["y_mm"]) == pytest.approx((39.5, 4.9), abs=POSITION * ARM_MM)


def test_files_that_are_no_pictures_and_loads_that_do_not_fit(cli, photos, tmp_path):
    out, text = tmp_path / "out.csv", tmp_path / "note.png"
    text.write_text("not a picture")
    base = ["flexure", "track", photos[0], "--arm-length-mm", 120, "--out", out]
    assert_refused(cli("flexure", "track", text, "--arm-length-mm", 120, "--out", out), "note.png", "not a picture")
    assert_refused(cli("flexure", "track", tmp_path / "gone.png", "--arm-length-mm", 120, "--out", out), "gone.png")
    assert_refused(cli("flexure", "track", photos[0], "--arm-length-mm", 0, "--out", out), "arm_length_mm")
    loads = tmp_path / "loads.csv"
    for content, words in (
        ("image,force\nrest.png,1\n", ("'force' has no unit", "force_N")),
        ("picture,force_N\nrest.png,1\n", ("no column image",)),
        ("image,force_N\nother.png,1\n", ("no load for picture rest.png",)),
        ("image,force_N\nrest.png,1\nrest.png,2\n", ("named twice",)),
        ("image,note\nrest.png,1\n", ("no load",)),
    ):
        loads.write_text(content)
        assert_refused(cli(*base, "--loads", loads), "loads.csv", *words)
    assert not out.exists()
