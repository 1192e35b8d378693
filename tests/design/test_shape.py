"""What form finding makes of a structure: closed forms of prisms, what is refused, what is told."""

from pathlib import Path

import numpy as np
import pytest

from tensegym.design.design import paper_design
from tensegym.design.design_file import design_from_dict, load_design
from tensegym.design.shape import least_stiffness
from tensegym.errors import DesignError
from tensegym.structure.structure import six_rod
from tests.design.prisms import prism

CASES = Path(__file__).parent / "cases"


@pytest.mark.parametrize("rods", [3, 4, 5])
def test_a_prism_stands_twisted_by_90_degrees_less_half_the_angle_between_its_rods(rods):
    """Its cables pull alike at 90 - 180 / n degrees, where the upright ones are 1 / (2 sin(180 / n)) of those around
    (Connelly and Terrell 1995, "Globally rigid symmetric tensegrities")."""
    design = design_from_dict(prism(rods, 0.3, 0.3, 0.2))
    nodes, shape = design.standing.nodes, design.shape
    ends = nodes[:rods] - nodes[:rods].mean(axis=0), nodes[rods:] - nodes[rods:].mean(axis=0)
    cosine = (ends[0] * ends[1]).sum(axis=1) / (np.linalg.norm(ends[0], axis=1) * np.linalg.norm(ends[1], axis=1))
    assert np.degrees(np.arccos(cosine)) == pytest.approx(90 - 180 / rods, abs=1e-4)
    around, upright = design.standing.lengths(design.standing.cables)[[0, -1]]
    assert upright / around == pytest.approx(0.5 / np.sin(np.pi / rods), rel=1e-6)
    assert shape.least_stiffness > 0
    assert not shape.flattened


@pytest.mark.parametrize("rods", [6, 7, 8])
def test_a_prism_of_more_than_five_rods_is_refused_as_flat(rods):
    """Upright cables of 1 / (2 sin(180 / n)) no longer reach from one end to the other at that twist."""
    with pytest.raises(DesignError, match="flattens"):
        design_from_dict(prism(rods, 0.2, 0.35, 0.0))
    with pytest.raises(DesignError, match="flattens"):
        load_design(CASES / "prism6_flat.toml")


def test_a_saddle_is_refused_with_the_nodes_that_leave_it(tmp_path):
    """However long the file's path is: of a message that is too long the path is cut first."""
    file = tmp_path / ("deep" * 20) / "rods12_unstable.toml"
    file.parent.mkdir()
    file.write_bytes((CASES / file.name).read_bytes())
    with pytest.raises(DesignError, match=r"does not hold.* -\d.* N/m, below 0, along a motion of nodes \d+, \d+, \d"):
        load_design(file)


def test_how_far_form_finding_moved_the_nodes():
    design = load_design(CASES / "tall_4prism.toml")
    turned = design.standing.nodes - design.structure.nodes
    assert design.shape.moved == pytest.approx(np.linalg.norm(turned, axis=1).max())
    assert np.abs(turned[:, 2]).max() == pytest.approx(0.276, abs=5e-4)


def test_a_given_natural_length_has_no_stiffness_at_rest():
    assert not paper_design().shape.flattened
    assert np.isnan(paper_design().shape.least_stiffness)


def test_stiffness_is_the_second_difference_of_the_cables_energy():
    """Along the softest mode the elastic energy of rigid rods grows as half the stiffness times the motion squared."""
    structure, tension, stiffness = six_rod(), 10.0, 300.0
    least, mode = least_stiffness(structure, tension, stiffness, 0.0)
    natural = structure.lengths(structure.cables) - tension / stiffness

    def energy(step):
        moved = structure.nodes + step * mode
        ends = moved[structure.rods]
        middles, spans = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
        spans *= (structure.rod_lengths / np.linalg.norm(spans, axis=1))[:, None]
        for side, sign in ((0, -0.5), (1, 0.5)):
            moved[structure.rods[:, side]] = middles + sign * spans
        stretch = np.linalg.norm(moved[structure.cables[:, 1]] - moved[structure.cables[:, 0]], axis=1) - natural
        return 0.5 * stiffness * float((stretch**2).sum())

    step = 1e-4
    second = (energy(step) - 2 * energy(0) + energy(-step)) / step**2
    assert second == pytest.approx(least * float((mode**2).sum()), rel=1e-5)
