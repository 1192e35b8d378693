"""The two example robots: a leg with a flexure knee lands, a gripper's fingers give."""

import numpy as np
import pytest

from tensegym.bullet import packaged_urdf
from tensegym.errors import FlexureError
from tensegym.flexible import FlexibleRobot, Load, load_robot

HIP, GRAVITY = 0.012, 9.81  # kg, m/s^2


@pytest.mark.filterwarnings("ignore:flexure .* left its fitted domain:UserWarning")  # the blow of the landing does
@pytest.mark.parametrize("dt", [1e-3, 2e-3])
def test_the_leg_lands_and_its_knee_carries_the_hip(dt):
    """It rests, the leaf's transverse force is the hip's weight whatever the step, and the energy has only fallen."""
    with load_robot(packaged_urdf("flexure_leg.toml"), fixed_base=True, ground=True, dt=dt) as robot:
        knee = robot.flexures["knee"]
        robot.place({"rail": 0.234})
        start, highest = robot.energies().total, -np.inf
        for _ in range(round(0.5 / dt)):
            robot.step()
            highest = max(highest, robot.energies().total)
        assert highest < start + 1e-5
        assert np.abs(robot.velocities).max() < 1e-3
        assert knee.wrench[1] == pytest.approx(-HIP * GRAVITY, rel=2e-3)
        assert abs(knee.wrench[0]) < 0.2  # friction at the foot, within its cone
        assert knee.margin > 0.5
        # 120 mm of leg between rail and ground, less its bend: the foot is on the ground
        foot, turn = robot.link_pose("shin")
        assert (foot + turn @ [-0.06, 0, -0.104])[2] == pytest.approx(0.01, abs=2e-4)


def test_the_leg_falls_freely_before_it_lands():
    with load_robot(packaged_urdf("flexure_leg.toml"), fixed_base=True, ground=True) as robot:
        robot.place({"rail": 0.4})
        robot.step(100)
        assert robot.positions[robot.joints["rail"]] == pytest.approx(0.4 - 0.5 * GRAVITY * 0.1**2, abs=1e-6)


def test_the_grippers_fingers_give_alike_and_as_their_springs_say():
    with load_robot(packaged_urdf("flexure_gripper.toml"), fixed_base=True, gravity=(0, 0, 0)) as robot:
        left, right = robot.flexures["left"], robot.flexures["right"]
        tip = (0.0, 0.0, 0.07)
        robot.loads = [Load("left_finger", (-0.2, 0, 0), tip), Load("right_finger", (0.2, 0, 0), tip)]
        robot.step(4000)
        assert np.abs(robot.velocities).max() < 1e-3
        np.testing.assert_allclose(left.pose * [1, -1, -1], right.pose, atol=1e-6)
        for flexure, name, sign in ((left, "left_finger", -1), (right, "right_finger", 1)):
            # hinge axes: x down the finger (world z), y to the right (world x); the joint's origin is half a leaf up
            assert flexure.wrench[1] == pytest.approx(sign * 0.2, abs=1e-3)
            assert flexure.wrench[0] == pytest.approx(0.0, abs=2e-3)
            theta = flexure.pose[2]
            lever = 0.05 * np.cos(theta)  # from the leaf's end, 20 mm below the joint, to the load
            assert flexure.wrench[2] == pytest.approx(sign * 0.2 * lever, rel=5e-3)
            assert name in robot.links


def test_a_robot_that_nothing_could_move_is_refused():
    with pytest.raises(FlexureError, match="no joint that moves"):
        FlexibleRobot(packaged_urdf("passive_rod.urdf"), fixed_base=True)
    with FlexibleRobot(packaged_urdf("passive_rod.urdf")) as free:
        free.step(10)
        assert free.time == pytest.approx(0.01)
