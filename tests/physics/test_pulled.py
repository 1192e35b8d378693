"""The pulled robot without a simulation, against one."""

import numpy as np
import pytest

from tensegym.design.design import ElasticCable, Payload, RobotDesign, flexible_design
from tensegym.physics.drives import COMMAND, STATE_SIZE, drive_constants, drive_step
from tensegym.physics.pulled import pulled_state, stall_tension
from tensegym.physics.robot_arrays import robot_model
from tensegym.robot.robot import TensegrityRobot


@pytest.mark.parametrize("design", [
    RobotDesign(), RobotDesign(payload=Payload()), RobotDesign(elastic_cable=ElasticCable(stiffness=1e4)),
    flexible_design(),
], ids=["six rods", "payload", "stiff", "flexible"])  # fmt: skip
def test_tensions_of_the_deepest_pull_are_those_of_a_simulation(design):
    model = robot_model(design)
    elastic = slice(0, model.first_driven)
    computed = pulled_state(design, model, 1.0)[2][elastic].max()
    with TensegrityRobot(design, dt=5e-4, ground=False) as robot:
        robot.command(robot.command_limit)
        largest = 0.0
        for _ in range(30):
            robot.step(200)
            largest = max(largest, robot.tensions[elastic].max())
    assert computed == pytest.approx(largest, rel=0.2)


def test_no_pull_leaves_the_standing_robot():
    design = RobotDesign(payload=Payload())
    model = robot_model(design)
    poses, _, tensions = pulled_state(design, model, 0.0)
    np.testing.assert_allclose(poses, model.rest_poses, atol=1e-9)
    assert tensions[: model.first_driven] == pytest.approx(10.0)


def test_a_drive_winds_a_cable_in_below_its_stall_tension_and_not_above():
    design = RobotDesign()
    constants = drive_constants(design.drive)
    for factor, moves in ((0.98, True), (1.02, False)):
        state = np.zeros(STATE_SIZE)
        state[COMMAND] = 100.0
        for _ in range(200):
            drive_step(constants, state, factor * stall_tension(design.drive), 1e-3)
        assert (state[1] > 1e-6) == moves
