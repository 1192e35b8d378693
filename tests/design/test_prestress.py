"""What a design's cables are in balance with: force densities, what is kept, and what is advised where nothing is."""

from pathlib import Path

import numpy as np
import pytest

from tensegym.design.design_file import design_from_dict, load_design
from tensegym.errors import DesignError, ShapeError
from tensegym.robot.standing import Verdict
from tensegym.structure.equilibrium import check_balance
from tensegym.tables import read_toml
from tests.design.prisms import prism

CASES = Path(__file__).parent / "cases"


def table(name, **changes):
    return {**read_toml(CASES / f"{name}.toml", "case", DesignError), **changes}


def densities(design):
    return design.rest_tensions / design.standing.lengths(design.standing.cables)


def upright(data):
    """A group of a prism's last third of cables, those between its ends."""
    cables = data["structure"]["cables"]
    return {"upright": {"pairs": cables[-len(cables) // 3 :]}}


def ratio(rods):
    """Force density of upright cables over that of those around, at any height (Connelly and Terrell 1995)."""
    return 2 * np.sin(np.pi / rods)


@pytest.mark.parametrize(("name", "rods"), [("tall_4prism", 4), ("prism4_sags", 4)])
def test_a_prism_that_is_kept_as_given_is_held_by_force_densities_of_the_closed_form(name, rods):
    design = design_from_dict(table(name, keep={"shape": True}))
    assert design.standing is design.structure
    found = densities(design)
    np.testing.assert_allclose(found / found[0], [1.0] * 2 * rods + [ratio(rods)] * rods, rtol=1e-4)
    check_balance(design.standing, design.rest_tensions)
    assert design.shape.least_stiffness > 0
    length = design.standing.lengths(design.standing.cables) - 2 * design.attachment_radius
    np.testing.assert_allclose(300.0 * (length - design.cable_natural_lengths), design.rest_tensions)
    # nearest to the pretension: no other self-stress of the only one there is
    assert found[0] == pytest.approx(np.sum(10 * design.rest_tensions) / np.sum(design.rest_tensions**2) * found[0])


@pytest.mark.parametrize(("name", "rods", "height"), [("tall_4prism", 4, 0.9), ("prism6_flat", 6, 0.35)])
def test_force_densities_in_the_ratio_of_the_closed_form_keep_a_prism_tall(name, rods, height):
    data = table(name, elastic_cable={"force_density": 30.0})
    data["cables"] = upright(data)
    data["cables"]["upright"]["force_density"] = 30.0 * ratio(rods)
    design = design_from_dict(data)
    assert np.ptp(design.standing.nodes[:, 2]) == pytest.approx(height, rel=0.01)
    np.testing.assert_allclose(densities(design)[[0, -1]], [30.0, 30.0 * ratio(rods)])


def test_a_kept_height_is_kept_and_the_groups_tension_found():
    data = table("prism6_flat", keep={"height": True})
    data["cables"] = upright(data)
    design = design_from_dict(data)
    assert np.ptp(design.standing.nodes[:, 2]) == pytest.approx(0.35, abs=1e-6)
    assert (design.rest_tensions[:12] == 10.0).all()
    assert densities(design)[-1] / densities(design)[0] == pytest.approx(1.0, rel=1e-5)
    free = design_from_dict(table("prism6_flat", keep={"height": True}))  # without groups the same, at the mean of 10 N
    assert densities(free)[-1] / densities(free)[0] == pytest.approx(1.0, rel=1e-5)
    assert np.exp(np.log(free.rest_tensions).mean()) == pytest.approx(10.0)


def test_kept_nodes_and_lengths_are_kept():
    design = design_from_dict(table("tall_4prism", keep={"nodes": [1, 2, 3], "lengths": [[5, 6]]}))
    moved = np.linalg.norm(design.standing.nodes - design.structure.nodes, axis=1)
    assert moved[:3].max() < 1e-8 < moved[3:].max()
    assert design.standing.lengths([[4, 5]]) == pytest.approx(design.structure.lengths([[4, 5]]), abs=1e-8)
    check_balance(design.standing, design.rest_tensions)


def test_a_symmetry_of_what_is_given_is_one_of_what_is_found():
    design = design_from_dict(prism(5, 0.3, 0.3, 0.2))
    nodes, turn = design.standing.nodes - design.standing.nodes.mean(axis=0), 2 * np.pi / 5
    c, s = np.cos(turn), np.sin(turn)
    turned = nodes @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    images = [1, 2, 3, 4, 0, 6, 7, 8, 9, 5]
    np.testing.assert_allclose(turned, nodes[images], atol=1e-8)


def test_a_straight_three_rod_prism_stands_twisted_with_upright_cables_shorter_by_sqrt_3():
    design = load_design(CASES / "ntrt_3prism.toml")
    lengths = design.standing.lengths(design.standing.cables)
    assert lengths[0] / lengths[-1] == pytest.approx(np.sqrt(3), rel=1e-6)


def test_a_cable_given_by_its_length_finds_its_tension_beside_those_given_by_theirs():
    data = table("tall_4prism")
    data["cables"] = upright(data)
    data["cables"]["upright"]["natural_length"] = 0.5
    design = design_from_dict(data)
    lengths = design.standing.lengths(design.standing.cables)
    np.testing.assert_allclose(design.rest_tensions, np.where(np.arange(12) < 8, 10.0, 300.0 * (lengths - 0.5)))
    check_balance(design.standing, design.rest_tensions)


@pytest.mark.parametrize(
    ("name", "said"),
    [("prism6_flat", r"flattens .*tried: \[keep\] height = true holds its height, by 6\.\d+ to 21\.\d N"),
     ("rods12_unstable", "tried: no tensions hold it or its height, and no ratio")],
)  # fmt: skip
def test_a_file_that_no_shape_is_found_for_is_told_what_was_tried(name, said):
    with pytest.raises(ShapeError, match=said):
        load_design(CASES / f"{name}.toml")


def test_what_form_finding_did_names_node_and_heights():
    design = load_design(CASES / "tall_4prism.toml")
    assert Verdict(design, [], None).moved == (
        "form finding moved the given nodes by up to 0.366 m (node 1), their height from 0.9 to 0.348 m")


@pytest.mark.parametrize(
    ("keep", "said"),
    [({"nodes": [99]}, "there is no node 99; give numbers from 1 to 8"), ({"nodes": [0]}, "outside"),
     ({"lengths": [[1, 2, 3]]}, r"lengths row 1 = \(1, 2, 3\) has 3 entries"),
     ({"shapes": True}, "did you mean 'shape'")],
)  # fmt: skip
def test_what_cannot_be_kept_is_refused_by_name(keep, said):
    with pytest.raises(DesignError, match=said):
        design_from_dict(table("tall_4prism", keep=keep))
