"""Verdicts on shape and standing: what is refused, what is told."""

import numpy as np
import pytest

from tensegym.design.design import RobotDesign, paper_design
from tensegym.design.design_file import design_from_dict
from tensegym.design.shape import least_stiffness
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.standing import standing_verdict
from tensegym.structure.structure import six_rod


def prism(rods, radius, height, twist, **groups):
    """A prism: cables around both ends and up the sides, ring by ring."""
    angles = 2 * np.pi * np.arange(rods) / rods
    ends = ((0.0, 0.0), (twist, height))
    rings = [[[radius * np.cos(a + t), radius * np.sin(a + t), z] for a in angles] for t, z in ends]
    ring = [[i + 1, (i + 1) % rods + 1] for i in range(rods)]
    members = {
        "nodes": rings[0] + rings[1], "stiff_cables": [],
        "rods": [[i + 1, rods + (i + 1) % rods + 1] for i in range(rods)],
        "cables": ring + [[a + rods, b + rods] for a, b in ring] + [[i + 1, rods + i + 1] for i in range(rods)],
    }  # fmt: skip
    return {"structure": members, **groups}


def test_a_prism_that_form_finding_flattens_is_refused():
    with pytest.raises(DesignError, match="flattens"):
        design_from_dict(prism(6, 0.2, 0.35, 0.0))


def test_how_far_form_finding_moved_the_nodes_is_told():
    design = design_from_dict(prism(4, 0.3, 0.9, np.pi / 4))
    turned = design.standing.nodes - design.structure.nodes
    assert design.shape.moved == pytest.approx(np.linalg.norm(turned, axis=1).max())
    assert np.abs(turned[:, 2]).max() == pytest.approx(0.276, abs=5e-4)
    assert f"{design.shape.moved:.3g} m" in standing_verdict(design).text


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


def test_the_shipped_robot_stands_and_the_papers_is_not_judged_by_its_pretension():
    verdict = standing_verdict(RobotDesign())
    assert verdict.kind == "stands"
    assert verdict.shape.moved == 0
    paper = paper_design().shape
    assert not paper.flattened
    assert np.isnan(paper.least_stiffness)


@pytest.mark.parametrize("dt", [1e-3, 2e-3])
def test_spin_damping_over_what_the_time_step_holds_is_refused(dt):
    """The spin obeys w' = -(c / I) w explicitly: stable for dt c / I below 2, less what the cables' pull adds."""
    edge = 2 * RobotDesign().passive_rod.axial_inertia / dt
    with pytest.raises(DesignError, match=r"spin_damping.*rod.*below"):
        TensegrityRobot(RobotDesign(spin_damping=edge), dt=dt)
    with TensegrityRobot(RobotDesign(spin_damping=0.9 * edge), dt=dt) as robot:
        robot.step(1000)
        assert np.abs(robot.velocities_in_world()[:, 3:]).max() < 1.0


def test_a_heavy_prism_falls_and_is_told_the_tension_that_would_hold_it():
    design = design_from_dict(prism(3, 0.3, 0.3, 0.0, elastic_cable={"pretension": 1.0, "stiffness": 300.0},
                                    passive_rod={"end_mass": 0.6}))  # fmt: skip
    verdict = standing_verdict(design)
    assert verdict.kind == "falls"
    assert verdict.least_pretension > 1.0
    firmer = design.elastic_cable.__class__(pretension=1.2 * verdict.least_pretension, stiffness=300.0)
    assert not standing_verdict(design.with_(elastic_cable=firmer)).worst.fell
