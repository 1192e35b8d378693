"""What broke is named: the element with the energy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.design.design import ElasticCable, Payload, RobotDesign, flexible_design
from tensegym.errors import SimulationError
from tensegym.robot.fault import element_energies, most_gained
from tensegym.robot.gait import AUDIT_TOLERANCE, GaitMeter
from tensegym.robot.robot import TensegrityRobot


@pytest.mark.parametrize("design", [RobotDesign(payload=Payload()), flexible_design()], ids=lambda d: d.name)
def test_the_elements_energies_are_the_robots(design):
    with TensegrityRobot(design, dt=1e-3) as robot:
        robot.command(0.5 * robot.command_limit)
        robot.step(200)
        energies = robot.energies()
        assert sum(element_energies(robot).values()) == pytest.approx(energies.kinetic + energies.elastic, rel=2e-3)


def test_the_rod_that_spins_the_payload_that_moves_and_the_cable_that_is_stretched_are_named():
    with TensegrityRobot(RobotDesign(payload=Payload()), ground=False) as robot:
        start = element_energies(robot)
        robot.reset_rotated(Rotation.identity(), _moving(robot, body=2, column=5, speed=300.0))
        assert most_gained(robot, start).startswith("the spin of rod 5-6, ")
        robot.reset_rotated(Rotation.identity(), _moving(robot, body=6, column=1, speed=9.0))
        assert most_gained(robot, start).startswith("the motion of the payload, ")
        robot.reset_rotated(Rotation.identity())
        robot.natural_lengths[3] -= 0.2
        a, b = robot.design.structure.cables[3] + 1
        assert most_gained(robot, start).startswith(f"the stretch of cable {a}-{b}, ")


def _moving(robot, body, column, speed):
    velocities = np.zeros((7, 6))
    if column == 5:
        velocities[body, 3:] = speed * Rotation.from_quat(robot.model.rest_poses[body, 3:]).as_matrix()[:, 2]
    else:
        velocities[body, column] = speed
    return velocities


def test_a_broken_audit_says_when_and_by_what():
    with TensegrityRobot(RobotDesign(elastic_cable=ElasticCable(stiffness=1e6)), dt=1e-3) as robot:
        meter = GaitMeter(robot, np.array([1.0, 0.0]))
        assert meter.fault is None
        for _ in range(5):
            robot.command(robot.command_limit)
            robot.step(100)
            meter.update()
        assert meter.metrics().audit_excess > AUDIT_TOLERANCE
        assert meter.fault is not None
        assert "the energy audit broke at t = 0.1 s" in meter.fault
        assert "most gained by the stretch of cable" in meter.fault


def test_a_drive_that_winds_in_more_than_its_cable_is_named():
    with TensegrityRobot() as robot:
        robot.natural_lengths[robot.model.driven.start + 1] = -1e4
        with pytest.raises(SimulationError, match=r"the drive of stiff cable \d+-\d+, which has wound in more than"):
            robot.step(200)
