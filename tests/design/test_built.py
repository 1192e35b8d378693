"""A design file that names a builder: what it makes stands as it was built, and its groups may be given values."""

import numpy as np
import pytest

from tensegym.design.design_file import design_from_dict, design_to_dict
from tensegym.errors import DesignError, StructureError


def built(builder, **rest):
    parameters = rest.pop("parameters", {})
    return design_from_dict({"structure": {"builder": builder, **parameters}, **rest})


@pytest.mark.parametrize(("builder", "parameters"), [
    ("prism", {"rods": 4, "height": 0.9}), ("prism", {"rods": 6, "radius": 0.2, "height": 0.35}), ("octahedron", {}),
    ("truncated", {"solid": "cube"}), ("tower", {"rods": 4}), ("three_rod_robot", {}),
])  # fmt: skip
def test_form_finding_leaves_what_a_builder_made(builder, parameters):
    """A tall prism stays tall, and one of six rods is no plane figure, since their groups pull as they ought."""
    design = built(builder, parameters=parameters)
    assert design.shape.moved < 1e-9
    assert design.shape.least_stiffness > 0
    assert design.name == {"prism": f"prism_{parameters.get('rods')}", "truncated": "truncated_cube",
                           "tower": "tower_4"}.get(builder, builder)  # fmt: skip


def test_pretension_is_that_of_the_first_group_and_the_others_have_their_share():
    design = built("prism", elastic_cable={"pretension": 20.0})
    around, upright = design.rest_tensions[[0, -1]]
    lengths = design.structure.lengths(design.structure.cables)[[0, -1]]
    assert around == pytest.approx(20)
    assert upright / around == pytest.approx(np.sqrt(3) * lengths[1] / lengths[0])


def test_values_of_a_group_go_by_its_name():
    design = built("prism", cables={"upright": {"stiffness": 777.0}})
    assert [cable.stiffness for cable in design.each_cable] == 6 * [300.0] + 3 * [777.0]
    single = built("tower", cables={"all": {"damping": 2.0}})
    assert {cable.damping for cable in single.each_cable} == {2.0}
    assert built("tower").cables == ()


def test_a_design_of_a_builder_comes_back_from_its_file():
    design = built("prism", parameters={"rods": 5, "wound": "across"}, name="walker")
    assert design.name == "walker"
    assert design_to_dict(design_from_dict(design_to_dict(design))) == design_to_dict(design)


def test_a_given_natural_length_leaves_no_pretension_to_share():
    design = built("prism", elastic_cable={"natural_length": 0.3})
    assert np.isnan(design.rest_tensions).all()


def test_what_a_builder_does_not_have_is_refused():
    with pytest.raises(StructureError, match=r"structure\.rods = 0 is outside \[3, 60\]"):
        built("prism", parameters={"rods": 0})
    with pytest.raises(DesignError, match="upward"):
        built("prism", cables={"upward": {"stiffness": 777.0}})
    with pytest.raises(DesignError, match=r"elastic_cable\.pretension"):
        built("prism", elastic_cable={"pretension": "much"})
    with pytest.raises(DesignError, match=r"cables.upright = 3"):
        built("prism", cables={"upright": 3})
