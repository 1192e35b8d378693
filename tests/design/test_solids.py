"""What is drawn of a robot stands where its physics has it."""

import numpy as np
import pytest

from tensegym import RobotDesign, TensegrityRobot
from tensegym.design.parameters import Payload, RodFlexure
from tensegym.design.solids import middles, solids

DESIGNS = {
    "plain": RobotDesign(),
    "split and loaded": RobotDesign(payload=Payload(), flexure=RodFlexure(rods="all")),
}


@pytest.mark.parametrize("name", DESIGNS)
def test_end_masses_are_drawn_on_the_nodes_of_a_robot_that_moves(name):
    design = DESIGNS[name]
    shown = solids(design)
    with TensegrityRobot(design, dt=2e-3) as robot:
        robot.command(robot.command_limit)
        robot.step(200)
        poses, nodes = robot.poses_in_world.copy(), robot.node_positions_in_world()
    rows = len(poses) - len(design.flexible_rods) - (design.payload is not None)
    balls = [k for k, solid in enumerate(shown) if solid.kind == "sphere" and solid.colour[3] == 1]
    drawn = middles(shown, poses)[balls]
    assert len(drawn) == 2 * rows == len(nodes)
    distance = np.linalg.norm(nodes[:, None] - drawn, axis=2)
    assert distance.min(axis=0).max() < 1e-9
    assert len(set(distance.argmin(axis=0))) == len(nodes)  # each on a node of its own
    tubes = [solid for solid in shown if solid.kind == "cylinder"]
    assert sum(solid.size[1] for solid in tubes) == pytest.approx(
        design.standing.rod_lengths.sum() - (design.flexure.length * len(design.flexible_rods) if design.flexure else 0)
    )
