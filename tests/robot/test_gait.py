"""Gait metrics: each on a motion whose answer is known."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.control.tipping import Pull, run_pull, tip_from
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import load_design
from tensegym.robot.gait import AUDIT_TOLERANCE, GaitMeter, GaitMetrics
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import resting_rotation

X = np.array([1.0, 0.0])
TIPPING = Pull((0, 1, 2), 0.4)


def slide(friction, seconds=0.5, speed=1.0):
    """Metrics of a settled robot that is given a horizontal speed."""
    with TensegrityRobot(RobotDesign(friction=friction)) as robot:
        robot.reset(0)
        robot.step(2000)
        meter = GaitMeter(robot, X)
        robot.push([speed, 0, 0])
        for _ in range(round(seconds / 0.05)):
            robot.step(50)
            meter.update()
        return meter.metrics()


def test_skating_without_friction_is_all_slip_and_no_energy():
    gait = slide(friction=0.0)
    assert gait.slip_share == pytest.approx(1.0, abs=0.02)
    assert gait.slip_share_sum == pytest.approx(3.0, abs=0.06)  # on three feet
    assert gait.speed == pytest.approx(1.0, abs=0.01)
    assert gait.path == pytest.approx(0.5, abs=0.01)
    assert gait.tips == 0


def test_speed_is_along_the_wanted_direction_in_rod_lengths_too():
    with TensegrityRobot(RobotDesign(friction=0.0)) as robot:
        robot.reset(0)
        robot.step(1000)
        meters = [GaitMeter(robot, np.array([math.cos(a), math.sin(a)])) for a in (0.0, 2.0, math.pi)]
        robot.push([1.0, 0, 0])
        robot.step(500)
        ahead, aside, back = (m.metrics() for m in meters)
        assert aside.speed == pytest.approx(math.cos(2.0) * ahead.speed, abs=0.01)
        assert back.speed == pytest.approx(-ahead.speed)
        assert ahead.speed_lps * robot.design.length == pytest.approx(ahead.speed)
        assert math.isinf(back.cost_of_transport)


def test_feet_that_grip_slip_less_than_feet_on_ice():
    """One step by the drives: the robot tips over its edge, and its feet stay within a fraction of its way."""
    shares = {}
    for friction in (0.0, 0.8):
        with TensegrityRobot(RobotDesign(friction=friction), dt=2e-3) as robot:
            robot.reset(0)
            robot.step(250)
            meter = GaitMeter(robot, X)
            run_pull(robot, TIPPING, lambda _: meter.update())  # noqa: B023
            shares[friction] = meter.metrics().slip_share
    assert shares[0.8] < 0.7 * shares[0.0]


def _tipping_pull(robot, face=0):
    from tensegym.control.tipping import subsets

    for drives in subsets(6):
        tip = tip_from(robot, face, Pull(drives, 0.4))
        if tip.tipped:
            return tip
    raise AssertionError("nothing tips this face")


def test_a_step_counts_its_tips_and_its_energy():
    with TensegrityRobot(dt=2e-3) as robot:
        tip = _tipping_pull(robot)
        robot.reset(tip.from_face)
        robot.step(250)
        meter = GaitMeter(robot, X)
        assert meter.face == tip.from_face
        faces = [meter.face]
        begin = robot.totals()

        def watch(_):
            meter.update()
            faces.append(meter.face)

        again = run_pull(robot, tip.pull, watch)
        gait = meter.metrics()
        assert again == tip
        assert meter.face == tip.to_face
        assert gait.tips == np.count_nonzero(np.diff(faces)) >= 1
        along = gait.speed * gait.duration
        assert gait.energy == pytest.approx(robot.totals().electrical_energy - begin.electrical_energy)
        assert gait.energy > gait.drive_work > 0
        if along > 0:
            weight = robot.design.mass * robot.design.gravity
            assert gait.cost_of_transport == pytest.approx(gait.energy / (weight * along))
        assert gait.audit_passed


@pytest.mark.parametrize("face", [2, 3, 4])
def test_a_robot_at_rest_stays_where_it_is(face):
    """Undriven: friction holds the feet against the cables' pull."""
    with TensegrityRobot(dt=2e-3) as robot:
        robot.reset(face)
        robot.step(1500)
        meter = GaitMeter(robot, X)
        begin = robot.centre_of_mass_in_world()
        for _ in range(20):
            robot.step(50)
            meter.update()
        gait = meter.metrics()
        assert gait.tips == 0
        assert gait.energy < 0.1
        assert gait.audit_passed
        assert np.linalg.norm(robot.centre_of_mass_in_world() - begin) < 0.01 * robot.design.length  # in 2 s


@pytest.mark.parametrize("direction", [[1, 0, 0], [0, 0, 1]])
def test_the_audit_finds_energy_put_in_by_nobody(direction):
    """A push of 3 % of the energy is found, one of half the tolerance is not."""
    for share, passes in ((0.03, False), (0.5 * AUDIT_TOLERANCE, True)):
        with TensegrityRobot(dt=2e-3) as robot:
            robot.reset(0)
            robot.step(1500)
            meter = GaitMeter(robot, X)
            for _ in range(5):
                robot.step(50)
                meter.update()
            assert meter.metrics().audit_passed
            speed = math.sqrt(2 * share * robot.energies().total / robot.design.mass)
            robot.push(speed * np.array(direction))
            meter.update()
            assert meter.metrics().audit_passed is passes
            assert meter.metrics().audit_excess == pytest.approx(share, abs=0.003)
            for _ in range(20):  # and it is not forgotten when friction has eaten it
                robot.step(50)
                meter.update()
            assert meter.metrics().audit_passed is passes


def test_the_audit_allows_what_the_drives_put_in():
    with TensegrityRobot(dt=2e-3) as robot:
        robot.reset(0)
        robot.step(500)
        meter = GaitMeter(robot, X)
        start = robot.energies().total
        robot.command(0.6 * robot.command_limit)
        for _ in range(20):
            robot.step(50)
            meter.update()
        assert robot.energies().total > 1.1 * start
        assert meter.metrics().audit_passed


def test_a_faces_turn_under_the_centre_counts_as_a_tip():
    """Laid down on one face after another by hand: one tip each."""
    with TensegrityRobot() as robot:
        robot.reset(0)
        meter = GaitMeter(robot, X)
        for face in (1, 1, 4, 0):
            nodes = robot.design.standing.nodes
            robot.reset_rotated(Rotation.from_matrix(resting_rotation(nodes, robot.faces.triangles[face])))
            meter.update()
            assert meter.face == face
        assert meter.tips == 3


def test_plain_types_for_json_with_none_for_infinite():
    gait = GaitMetrics(1.0, -0.1, -0.14, 0.1, 2, 0.3, 0.9, 5.0, 1.0, math.inf, 0.02, 50.0)
    data = json.loads(json.dumps(gait.as_dict(), allow_nan=False))
    assert data["cost_of_transport"] is None
    assert data["audit_passed"] is False
    assert data["tips"] == 2


def test_a_robot_at_rest_on_a_square_does_not_tip():
    """The foot of its centre of mass wanders over the diagonal between the two triangles of the square."""
    with TensegrityRobot(load_design(Path(__file__).parents[1] / "design" / "cases" / "tall_4prism.toml")) as robot:
        robot.reset(robot.faces.names().index("1-2-4"))
        meter = GaitMeter(robot, X)
        for _ in range(50):
            robot.step(20)
            meter.update()
        assert meter.tips == 0


def test_the_peak_tension_is_the_most_of_all_time_steps_since_the_trial_began():
    with TensegrityRobot(dt=2e-3) as robot:
        robot.reset(0, height=1.0)  # an impact before the trial, which does not count
        robot.step(1000)
        meter, most = GaitMeter(robot, X), 0.0
        robot.command(robot.command_limit)
        for _ in range(200):
            robot.step(1)
            most = max(most, robot.tensions.max())
        assert meter.metrics().peak_tension == most > 10.0
