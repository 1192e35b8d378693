"""Closed forms of a parallelogram against the FEM, within the range that was published for them."""

import numpy as np
import pytest

from tensegym.errors import FlexureError
from tensegym.flexure.fem.travel import pushed
from tensegym.flexure.hinge import GROUND, TIP, Hinge, Leaf, preset
from tensegym.flexure.hinge.presets import parallel_guide
from tensegym.flexure.models.guide_comparison import axial_range, compare_guide
from tensegym.flexure.models.guide_models import CHARACTERISTIC, SPRING, BeamConstraint, PseudoRigid, guide_of

HINGE = parallel_guide()
GUIDE = guide_of(HINGE)
UNIT = GUIDE.bending / GUIDE.length**3


def test_the_guide_is_read_from_the_hinge():
    bending = 2.95e9 * 0.04 * 0.8e-3**3 / 12
    assert (GUIDE.length, GUIDE.height) == (0.04, 0.04)
    assert pytest.approx(bending) == GUIDE.bending
    swapped = Hinge("h", tuple(Leaf(TIP, leaf.end, GROUND, leaf.start, leaf.width, leaf.thickness)
                               for leaf in HINGE.leaves), 0.04)  # fmt: skip
    assert guide_of(swapped) == GUIDE


@pytest.mark.parametrize("hinge", [preset("leaf-spring"), preset("tfch"), preset("x-hinge"), Hinge("h", (
    HINGE.leaves[0], Leaf(GROUND, (0, 0.02), TIP, (0.04, 0.02), 0.04, 1e-3)), 0.04)])  # fmt: skip
def test_what_is_no_parallelogram_is_refused(hinge):
    with pytest.raises(FlexureError, match=r"is no parallelogram: .* take parallel-guide"):
        guide_of(hinge)


def test_at_rest_both_are_what_was_published():
    rest = np.zeros(1)
    assert BeamConstraint(GUIDE).across(rest)[0] == pytest.approx(24 * UNIT)
    assert BeamConstraint(GUIDE).along(rest)[0] == pytest.approx(2 * GUIDE.stretching / GUIDE.length)
    assert PseudoRigid(GUIDE).across(rest)[0] == pytest.approx(8 * SPRING / CHARACTERISTIC * UNIT)


@pytest.mark.parametrize("model", [BeamConstraint(GUIDE), PseudoRigid(GUIDE)], ids=lambda m: type(m).__name__)
@pytest.mark.parametrize("axial", [0.0, -20.0, 40.0])
def test_stiffness_is_the_slope_of_the_force(model, axial):
    force = np.linspace(-8, 8, 7)
    more, less = (model.poses(force + step, axial)[:, 1] for step in (1e-4, -1e-4))
    travel = model.poses(force, axial)[:, 1]
    assert 2e-4 / (more - less) == pytest.approx(model.across(travel, axial), rel=1e-6)


def test_beam_constraint_model_within_its_published_range():
    """Within 5 % to a tenth of the length while the axial force is moderate: travel, drop, turn, both stiffnesses."""
    model = BeamConstraint(GUIDE)
    for axial in (-10.0, 0.0, 30.0):
        path = pushed(HINGE, np.array([0.0, 0.002, 0.004]), axial=axial)
        x, y, turn = model.poses(path.states.force[:, 1], axial).T
        assert y == pytest.approx(path.states.tip[:, 1], rel=0.05, abs=1e-9)
        assert x[0] - x == pytest.approx(path.states.tip[0, 0] - path.states.tip[:, 0], rel=0.05, abs=1e-9)
        assert turn == pytest.approx(path.states.theta, rel=0.05, abs=1e-9)
        assert model.across(y, axial) == pytest.approx(path.drive_stiffness, rel=0.05)
        assert model.along(y) == pytest.approx(path.support_stiffness(0), rel=0.05)


def test_beam_constraint_model_leaves_its_range():
    """Beyond a tenth of the length, and beyond its axial bound, it is no longer within 5 %."""
    far = pushed(HINGE, np.array([0.006]))
    assert abs(BeamConstraint(GUIDE).across(np.array([0.006]))[0] / far.drive_stiffness[0] - 1) > 0.05
    inside = axial_range(HINGE, BeamConstraint(GUIDE), 0.004)
    euler = 2 * np.pi**2 * GUIDE.bending / GUIDE.length**2
    assert -euler < inside["y"][0] < inside["k x"][0] < 0 < inside["k x"][1] < inside["y"][1]


def test_comparison_holds_every_model():
    reference, columns, missing = compare_guide(HINGE, 0.004)
    assert missing == ""
    assert reference.states.tip[-1, 1] == pytest.approx(0.004, abs=1e-9)
    errors = {column.name: column.errors(reference) for column in columns}
    assert errors["FEM, 16 elements"]["y"] < errors["FEM, 8 elements"]["y"] / 8 < 1e-5
    assert errors["beam constraint model"]["y"] < 0.01 < errors["pseudo-rigid body"]["y"] < 0.05
    assert errors["potential, fitted"]["y"] < errors["planar spring, fitted"]["y"]
    assert all(column.seconds > 0 for column in columns)
