"""Disturbed episodes: what is drawn is within its range, from the seed alone, and does what it says."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from tensegym import RobotDesign, as_task
from tensegym.errors import DesignError, TensegymError
from tensegym.physics.drives import CURRENT
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.sensors import Error, Sensors
from tensegym.tasks.disturbance import Disturbance
from tensegym.tasks.episode import Episode
from tensegym.tasks.trials import Setup, check_setup, run_trials

ID = "tensegym/SixRodRolling-v0"


def begun(robot: TensegrityRobot, seed: int = 4, **disturb) -> Episode:
    task = as_task({"motion": "roll", "disturb": disturb})
    return Episode(robot, task, np.random.default_rng(seed), {"face": 3, "heading": 0.0, "direction": 0.0})


@pytest.fixture(scope="module")
def robot():
    with TensegrityRobot(dt=2e-3) as robot:
        yield robot


def test_off_changes_nothing_and_draws_nothing():
    assert not Disturbance().on
    assert not Disturbance(push=1.0, weak_to=0.2, snap_by=3.0, faulty=0.5).on
    plain, off = gym.make(ID).unwrapped, gym.make(ID, disturb={}).unwrapped
    for env in (plain, off):
        env.reset(seed=5)
        env.step(np.ones(6))
    assert plain.np_random.bit_generator.state == off.np_random.bit_generator.state
    np.testing.assert_array_equal(plain.robot.poses_in_world, off.robot.poses_in_world)
    plain.close(), off.close()


def test_a_robot_is_built_within_its_ranges_and_named_in_info():
    env = gym.make(ID, disturb={"mass": 0.2, "stiffness": 0.1, "friction": 0.5, "voltage": 0.3}).unwrapped
    designed = RobotDesign()
    masses = []
    for seed in range(4):
        _, info = env.reset(seed=seed)
        drawn, built = info["disturbed"], env.robot.design
        assert built.mass == pytest.approx(designed.mass * drawn["mass"])
        assert built.elastic_cable.stiffness == pytest.approx(300 * drawn["stiffness"])
        assert built.friction == pytest.approx(designed.friction * drawn["friction"])
        assert built.drive.voltage_limit == pytest.approx(designed.drive.voltage_limit * drawn["voltage"])
        assert abs(drawn["mass"] - 1) <= 0.2
        assert drawn["pretension"] == 1
        masses.append(built.mass)
    assert len(set(masses)) == 4
    env.close()


def test_a_snapped_cable_pulls_no_more_until_the_robot_is_reset(robot):
    episode = begun(robot, cables=[1, 7])
    episode.advance(np.zeros(6), 200)
    assert robot.tensions[[0, 6]].max() == 0
    assert np.delete(robot.tensions[:24], [0, 6]).min() >= 0
    assert robot.tensions[:24].max() > 1
    robot.reset(3)
    robot.step(100)
    assert robot.tensions[[0, 6]].min() > 1


def test_a_cable_that_snaps_takes_its_energy_out_of_the_audit(robot):
    episode = begun(robot, snapped=3)
    elastic = robot.energies().elastic
    for _ in range(3):
        episode.advance(np.zeros(6), 200)
    assert robot.energies().elastic < elastic
    assert episode.sound


def test_drives_that_fail_stand_still_or_give_less(robot):
    episode = begun(robot, stuck=2, dead=1, weak=1, weak_to=0.25)
    limit = robot.design.drive.current_limit
    peak, before = np.zeros(6), robot.drive_angles.copy()
    for _ in range(10):
        episode.advance(robot.angles_of(np.ones(6)), 20)
        peak = np.maximum(peak, np.abs(robot.drives[:, CURRENT]))
    named = episode.faults.as_dict()
    stuck, dead, weak = (np.array(named[name]) - 1 for name in ("stuck", "dead", "weak"))
    assert len({*stuck, *dead, *weak}) == 4
    np.testing.assert_array_equal(robot.drive_angles[stuck], before[stuck])
    assert robot.drive_angles[dead].max() <= 1e-9
    assert peak[weak].max() <= 0.25 * limit + 1e-12
    assert peak.max() > 0.5 * limit


def test_parts_fail_as_often_as_the_task_says(robot):
    """Each of the four by itself: binomial, so within 4 standard deviations of its share in 400 episodes."""
    fields = {"weak": 1, "stuck": 1, "dead": 1, "snapped": 1, "snap_by": 1.0}
    named = [begun(robot, seed, **fields, faulty=0.3).faults.as_dict() for seed in range(400)]
    for part in ("weak", "stuck", "dead", "snapping"):
        assert abs(np.mean([len(drawn[part]) for drawn in named]) - 0.3) < 4 * np.sqrt(0.3 * 0.7 / 400)
    alone = [drawn for drawn in named if len(drawn["dead"]) and not len(drawn["stuck"])]
    assert len(alone) > 20
    assert not any(begun(robot, seed, **fields, faulty=0.0).faults.as_dict()["snapping"] for seed in range(20))


def test_commands_come_late_by_whole_control_steps(robot):
    for seed in range(20):
        episode = begun(robot, seed, done_late=2)
        if episode.faults.late == 2:
            break
    commands = [robot.angles_of(np.full(6, level)) for level in (0.2, 0.4, 0.6)]
    for command in commands:
        episode.advance(command, 10)
    np.testing.assert_array_equal(robot.drives[:, 0], commands[0])


def test_a_push_gives_the_robot_its_velocity_and_the_audit_knows(robot):
    episode = begun(robot, pushes=600.0, push=0.5)
    before = robot.momentum_in_world()[0]
    episode.faults.strike(robot, 0.1)  # at 600 a minute one comes in every tenth of a second
    gained = (robot.momentum_in_world()[0] - before) / robot.design.mass
    assert np.linalg.norm(gained) == pytest.approx(0.5, rel=1e-6)
    assert gained[2] == pytest.approx(0, abs=1e-9)
    for _ in range(5):
        episode.advance(np.zeros(6), 50)
    assert episode.gait.audit_excess < 0.05


class Entry:
    def __init__(self, name, size, scale=1.0, bound=10.0):
        self.name, self.size, self.scale, self.bound = name, size, scale, bound


def test_noise_and_bias_have_their_size_and_spare_what_is_exact():
    parts = [Entry("node position", 2), Entry("rod rate", 2000, scale=5.0)]
    values = np.full(2002, 0.5)
    seen = Sensors({"rod rate": Error(noise=0.5, bias=0.0)}, 0, np.random.default_rng(0)).through(values, parts)
    np.testing.assert_array_equal(seen[:2], 0.5)
    assert seen[2:].std() == pytest.approx(0.5 / 5, rel=0.05)
    biased = Sensors({"rod rate": Error(noise=0.0, bias=1.0)}, 0, np.random.default_rng(0))
    first, second = biased.through(values, parts), biased.through(values, parts)
    np.testing.assert_array_equal(first, second)
    assert first[2:].std() == pytest.approx(1 / 5, rel=0.05)


def test_readings_come_late():
    sensors, parts = Sensors({}, 2, np.random.default_rng(0)), [Entry("drive angle", 1)]
    assert [float(sensors.through(np.array([value]), parts)[0]) for value in (1.0, 2.0, 3.0, 4.0)] == [1, 1, 1, 2]


def test_the_observation_goes_through_the_sensors_and_keeps_its_bounds():
    env = gym.make(ID, observation="onboard", disturb={"attitude_noise": 0.5, "encoder_bias": 2.0}).unwrapped
    exact = gym.make(ID, observation="onboard").unwrapped
    seen, _ = env.reset(seed=2)
    true, _ = exact.reset(seed=2)
    assert np.abs(seen - true)[:18].max() > 0.1
    np.testing.assert_array_equal(seen[18:36], true[18:36])  # the turn rates
    assert env.observation_space.contains(seen)
    env.close(), exact.close()


def test_the_same_seed_draws_the_same_in_an_evaluation():
    disturb = {"mass": 0.2, "friction": 0.2, "snapped": 1, "snap_by": 1.0, "attitude_noise": 0.05, "seen_late": 2}
    task = as_task({"motion": "roll", "seconds": 2.0, "disturb": disturb})
    setup = Setup("onboard", task, {"kind": "policy", "policy": "onboard"})
    both, one = run_trials(setup, [1, 2], jobs=1, quiet=True), run_trials(setup, [2], jobs=1, quiet=True)
    assert both[1] == one[0]
    assert both[0] != both[1]


@pytest.mark.parametrize(
    ("disturb", "words"),
    [
        ({"mass": -0.1}, "mass"),
        ({"friction": 2}, "friction"),
        ({"cables": [25]}, "no elastic cable 25 .* 1 to 24"),
        ({"cables": [0]}, "cables"),
        ({"snapped": 30}, "snapped = 30, but .* has 24 elastic cables"),
        ({"stuck": 4, "dead": 3}, "= 7, but .* has 6 drives"),
        ({"seen_late": 1.5}, "seen_late"),
        ({"wind": 1}, "unknown field 'wind' in disturb"),
        ({"pushes": float("nan")}, "pushes"),
    ],
)
def test_bad_ranges_are_named_before_anything_is_built(disturb, words):
    with pytest.raises(TensegymError, match=words):
        gym.make(ID, disturb=disturb)
    if "wind" not in disturb:
        with pytest.raises(TensegymError, match=words):
            run_trials(Setup("x", as_task({"motion": "roll", "disturb": disturb}), {"kind": "random"}), [1], jobs=1)


def test_errors_of_what_is_not_observed_are_refused():
    with pytest.raises(DesignError, match="errors of the rod axis are given, which this observation does not have"):
        gym.make(ID, observation="full", disturb={"attitude_noise": 0.1})
    task = as_task({"motion": "roll", "disturb": {"rate_bias": 0.1}})
    with pytest.raises(DesignError, match="rod rate"):
        check_setup(Setup("rolling", task, {"kind": "policy", "policy": "rolling"}))
