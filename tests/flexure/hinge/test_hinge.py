"""Hinges: validation, presets, TOML in and out."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import (
    GROUND,
    PRESETS,
    TIP,
    Hinge,
    Leaf,
    Material,
    as_hinge,
    hinge_from_dict,
    hinge_to_dict,
    hinge_to_toml,
    preset,
    symmetry_of,
)
from tensegym.flexure.hinge.presets import leaf_spring, notch_hinge, tapered_leaf, trls2

LOOSE = Leaf("a", (0, 0), "b", (0.01, 0), 0.01, 1e-4)
PLAIN = Leaf(GROUND, (0, 0), TIP, (0.04, 0), 0.04, 0.0008)


@pytest.mark.parametrize(("make", "words"), [
    (lambda: leaf_spring(thickness=0), "thickness = 0 m"),
    (lambda: leaf_spring(thickness=math.nan), "thickness = nan"),
    (lambda: leaf_spring(thickness=0.02), "thickness = 0.02 m at a length of 0.04 m"),
    (lambda: leaf_spring(width=-1), "width = -1 m"),
    (lambda: leaf_spring(length=0), "length"),
    (lambda: Material(poisson_ratio=0.6), r"poisson_ratio = 0.6 is outside \(-1, 0.5\)"),
    (lambda: Material(youngs_modulus=0), "youngs_modulus = 0 Pa"),
    (lambda: Material(modulus="shell"), "modulus = 'shell'; one of beam, plate, factor"),
    (lambda: Material(factor=1.2), "no effect with modulus = beam"),
    (lambda: Hinge("h", (), 0.04), "body 'tip' is disconnected"),
    (lambda: Hinge("h", (PLAIN,), 0.04, (GROUND, TIP, "loose")), "body 'loose' is disconnected"),
    (lambda: Hinge("h", (LOOSE, PLAIN), 0.04, (GROUND, "a", "b", TIP)), "body 'a' is disconnected"),
    (lambda: Hinge("h", (PLAIN,), 0.04, (GROUND,)), "bodies"),
    (lambda: Hinge("h", (Leaf(GROUND, (0, 0), "top", (0.04, 0), 0.04, 0.0008),), 0.04), "names body 'top'"),
    (lambda: Leaf(TIP, (0, 0), TIP, (0.04, 0), 0.04, 0.0008), "joins 'tip' to itself"),
    (lambda: Leaf(GROUND, (0, math.inf), TIP, (0.04, 0), 0.04, 0.0008), r"start = \(0, inf\); give 2 finite values"),
    (lambda: Hinge("h", (PLAIN,), 0.04, arm=-0.1), "arm = -0.1 m"),
    (lambda: Hinge("h", (PLAIN,), 0.04, max_angle=2), "max_angle = 2 rad"),
    (lambda: preset("cross-spring", crossing=1.5), "crossing = 1.5 is outside"),
    (lambda: preset("leafspring"), "did you mean 'leaf-spring'"),
    (lambda: preset("leaf-spring", height=0.1), "has no 'height'"),
    (lambda: trls2(rib=0.02), "rib = 0.02 m"),
    (lambda: preset("trls2", rib=0), "rib = 0 m"),
    (lambda: tapered_leaf(end_thickness=0.0), "end_thickness = 0 m, the leaf would end in an edge"),
    (lambda: tapered_leaf(end_thickness=0.02), "end_thickness = 0.02 m at a length of 0.04 m"),
    (lambda: notch_hinge(radius=0.006), r"radius 0.006 m along the leaf is above half of the web's length 0.01 m"),
    (lambda: notch_hinge(depth=0), "depth across the leaf = 0 m"),
    (lambda: notch_hinge(thickness=0.003), "thickness = 0.003 m at a length of 0.01 m"),
])  # fmt: skip
def test_refused(make, words):
    with pytest.raises(FlexureError, match=words):
        make()


def test_modulus_is_named():
    assert "beam modulus E" in leaf_spring().describe()
    plate = Material(modulus="plate")
    assert plate.effective_modulus == pytest.approx(2.95e9 / (1 - 0.38**2))
    assert "plate modulus" in leaf_spring(material=plate).describe()
    assert "1.15 E" in leaf_spring(material=Material(modulus="factor", factor=1.15)).describe()


@pytest.mark.parametrize("name", PRESETS)
def test_toml_round_trip(name, tmp_path):
    hinge = preset(name)
    file = tmp_path / "hinge.toml"
    file.write_text(hinge_to_toml(hinge))
    again = as_hinge(file)
    assert hinge_to_dict(again) == hinge_to_dict(hinge)
    assert again.max_angle == pytest.approx(hinge.max_angle, rel=1e-11)


@settings(deadline=None)
@given(st.floats(0.01, 0.2), st.floats(1e-4, 2e-3), st.floats(0.05, 0.95))
def test_dict_round_trip_keeps_dimensions(length, thickness, crossing):
    hinge = preset("cross-spring", length=length, thickness=thickness, height=length, crossing=crossing)
    again = hinge_from_dict(hinge_to_dict(hinge))
    for a, b in zip(hinge.leaves, again.leaves, strict=True):
        assert b.start == pytest.approx(a.start, rel=1e-9, abs=1e-15)
        assert b.end == pytest.approx(a.end, rel=1e-9, abs=1e-15)
        assert (b.width, b.thickness) == pytest.approx((a.width, a.thickness), rel=1e-9)


def test_preset_with_other_dimensions():
    hinge = hinge_from_dict(
        {"preset": "cross-spring", "thickness_mm": 0.5, "crossing": 0.2, "material": {"modulus": "plate"}}
    )
    assert hinge.leaves[0].thickness == pytest.approx(0.0005)
    assert hinge.leaves[0].start[1] == pytest.approx(0.2 * 0.04)
    assert hinge.material.modulus == "plate"


GOOD = {"length_mm": 40.0, "leaf": [{"from": "ground", "from_mm": [0, 0], "to": "tip", "to_mm": [40, 0], "width_mm": 40,
                                     "thickness_mm": 0.8}]}  # fmt: skip


@pytest.mark.parametrize(("change", "words"), [
    ({"leaf": []}, "no leaf"),
    ({"length_mm": "long"}, "length_mm = 'long' is a text, no number"),
    ({"colour": 1}, "unknown field 'colour' in the hinge"),
    ({"leaf": [{"from": "ground"}]}, "leaf 1 has no"),
    ({"leaf": [GOOD["leaf"][0] | {"from_mm": [0]}]}, "from_mm"),
    ({"leaf": [GOOD["leaf"][0] | {"thickness_mm": 0}]}, "thickness = 0 m"),
    ({"material": {"poisson_ratio": 0.6}}, "poisson_ratio = 0.6"),
    ({"material": {"density": 1}}, "unknown field 'density' in material"),
    ({"bodies": ["ground", "tip", "loose"]}, "'loose' is disconnected"),
    ({"max_angle_deg": 100}, "max_angle"),
    ({"name": 3}, "name = 3"),
    ({"leaf": [GOOD["leaf"][0] | {"end_thickness_mm": 0}]}, "end_thickness = 0 m"),
    ({"leaf": [GOOD["leaf"][0] | {"notch_mm": [25, 5]}]}, "above half of the web's length 0.04 m; give 0.02 m"),
    ({"leaf": [GOOD["leaf"][0] | {"notch_mm": [5]}]}, "leaf 1: notch_mm"),
    ({"leaf": [GOOD["leaf"][0] | {"notch_mm": [5, 5], "end_thickness_mm": 1}]}, "tapers or is notched, give one"),
])  # fmt: skip
def test_bad_dicts(change, words):
    hinge_from_dict(GOOD)
    with pytest.raises(FlexureError, match=words):
        hinge_from_dict(GOOD | change)


def test_bad_presets_and_files(tmp_path):
    with pytest.raises(FlexureError, match="no unit"):
        hinge_from_dict({"preset": "tfch", "thickness": 0.8})
    with pytest.raises(FileNotFoundError):
        as_hinge(tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("length_mm = ")
    with pytest.raises(FlexureError, match="is not TOML"):
        as_hinge(broken)


def test_symmetry():
    assert [symmetry_of(preset(name)) for name in ("x-hinge", "trls2", "tfch", "cross-spring")] == ["both"] * 4
    assert symmetry_of(preset("cross-spring", crossing=0.2)) == "axis"
    assert [symmetry_of(preset(name)) for name in ("notch-hinge", "tapered-leaf")] == ["both", "axis"]
    assert symmetry_of(Hinge("h", (Leaf(GROUND, (0, 0), TIP, (0.04, 0.01), 0.04, 0.0008),), 0.04)) == "none"
