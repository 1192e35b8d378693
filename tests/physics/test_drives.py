from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.design.design import Drive
from tensegym.physics import drives as D
from tensegym.physics.drives import drive_step_limit, most_gains
from tensegym.robot.robot import TensegrityRobot


def run(drive, command, tension, seconds=1.0, dt=1e-3):
    """Final state of a drive against a constant or angle-dependent tension, and the whole history."""
    constants, state = D.drive_constants(drive), np.zeros(D.STATE_SIZE)
    state[D.COMMAND] = command
    history = []
    for _ in range(round(seconds / dt)):
        load = tension(state[D.ROTOR_ANGLE] / drive.gear_ratio) if callable(tension) else tension
        D.drive_step(constants, state, load, dt)
        history.append(state.copy())
    return state, np.array(history)


def test_reaches_the_commanded_angle_and_rests_there():
    state, history = run(Drive(), 10.0, 0.0)
    assert state[D.ROTOR_ANGLE] / 19 == pytest.approx(10.0, abs=1e-3)
    assert abs(state[D.ROTOR_SPEED]) < 1e-3
    assert history[:, D.ROTOR_ANGLE].max() / 19 < 10.5


@settings(max_examples=30, deadline=None)
@given(st.floats(0, 100), st.floats(-50, 200), st.sampled_from([5e-4, 1e-3, 2e-3]))
def test_limits_hold_whatever_the_load_and_command(tension, command, dt):
    drive = Drive()
    _, history = run(drive, command, tension, 0.5, dt)
    assert np.abs(history[:, D.CURRENT]).max() <= drive.current_limit
    assert np.abs(history[:, D.VOLTAGE]).max() <= drive.voltage_limit
    assert np.abs(history[:, D.ROTOR_SPEED]).max() <= drive.speed_limit


def test_load_torque_is_tension_times_spool_radius():
    state, _ = run(Drive(), 5.0, 20.0, 0.05)
    assert state[D.LOAD_TORQUE] == pytest.approx(0.06)


def test_gear_holds_a_small_load_by_friction_and_yields_to_a_large_one():
    """Between T r / (N eff) and T r eff / N of motor torque the rotor stays put."""
    drive = Drive(friction_current=0.05)
    idle, _ = run(drive, 0.0, 0.9 * 0.05 * 9.32e-3 * 19 / 0.003, 0.2)
    assert idle[D.ROTOR_ANGLE] == 0
    driven, _ = run(drive, 0.0, 60.0, 0.2)
    assert driven[D.ROTOR_ANGLE] < 0  # pulled out until the controller holds it


def test_backlash_shows_only_on_a_slack_cable():
    drive = Drive()
    constants, state = D.drive_constants(drive), np.zeros(D.STATE_SIZE)
    state[D.COMMAND] = 2.0
    for _ in range(500):
        D.drive_step(constants, state, 5.0, 1e-3)
    assert state[D.SPOOL_ANGLE] == state[D.ROTOR_ANGLE] / 19
    state[D.COMMAND] = 1.0
    play = []
    for _ in range(500):
        D.drive_step(constants, state, 0.0, 1e-3)
        play.append(state[D.SPOOL_ANGLE] - state[D.ROTOR_ANGLE] / 19)
    assert play[20] == pytest.approx(drive.backlash)  # turning out, the slack cable lets the spool lag by all of it
    assert min(play) >= -1e-12
    assert max(play) <= drive.backlash + 1e-12
    D.drive_step(constants, state, 5.0, 1e-3)
    assert state[D.SPOOL_ANGLE] == state[D.ROTOR_ANGLE] / 19


def test_electrical_power_covers_mechanical_power():
    drive = Drive()
    _, history = run(drive, 1e4, 30.0, 0.5)
    steady = history[-1]
    mechanical = 30.0 * steady[D.PULLED] / 1e-3
    electrical = steady[D.CURRENT] * steady[D.VOLTAGE]
    copper = drive.resistance * steady[D.CURRENT] ** 2
    assert electrical - copper == pytest.approx(mechanical / drive.gear_efficiency, rel=1e-6)


def test_speed_does_not_depend_on_the_step():
    speeds = [run(Drive(), 1e4, 20.0, 0.5, dt)[0][D.ROTOR_SPEED] for dt in (2e-3, 1e-3, 2.5e-4)]
    assert max(speeds) - min(speeds) < 1e-6 * max(speeds)


def test_each_drive_has_constants_of_its_own():
    """One that cannot turn, one without voltage, one as it is."""
    with TensegrityRobot(dt=2e-3, ground=False) as robot:
        names = [field.name for field in fields(Drive)]
        robot.model.drive_params[0, names.index("speed_limit")] = 0.0
        robot.model.drive_params[1, names.index("voltage_limit")] = 0.0
        robot.command(0.5 * robot.command_limit)
        robot.step(100)
        turned = robot.drive_angles / robot.command_limit
        assert turned[0] == 0
        assert turned[1] <= 1e-9
        assert turned[2:].min() > 0.05


@pytest.mark.parametrize("gains", [{"position_gain": 60.0}, {"velocity_gain": 0.08}])
def test_a_drive_settles_below_its_time_step_limit_and_hunts_above(gains):
    drive = replace(Drive(), backlash=0.0, gear_efficiency=1.0, **gains)
    limit = drive_step_limit(drive)
    for dt, settles in ((0.97 * limit, True), (1.03 * limit, False)):
        state, constants = np.zeros(D.STATE_SIZE), D.drive_constants(drive)
        state[D.COMMAND] = 1e-6  # small enough for no limit of the drive to be reached at once
        for _ in range(3000):
            D.drive_step(constants, state, 0.0, dt)
        assert (abs(state[D.ROTOR_SPEED]) < 1e-9) == settles
    position, velocity = most_gains(drive, limit)
    assert position == pytest.approx(drive.position_gain, rel=1e-9)
    assert velocity == pytest.approx(drive.velocity_gain, abs=1e-9)
