import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

import tensegym.search.evaluate as module
from tensegym.control.bearing import Bearing
from tensegym.control.cpg import Cpg, CpgController, drive_kinds, fitted_feedback
from tensegym.design.design import RobotDesign
from tensegym.design.symmetry import symmetries
from tensegym.errors import DesignError, SimulationError
from tensegym.robot.gait import GaitMeter
from tensegym.robot.robot import TensegrityRobot
from tensegym.search.evaluate import TrialSpec, evaluate, run_trial, try_all
from tensegym.tasks.roll import Roll

AHEAD = Bearing(np.array([1.0, 0.0]))


@pytest.fixture
def trial(tiny):
    problem = tiny()
    tables = problem.space.apply(problem.space.start)
    return TrialSpec(3, tables["design"], tables["controller"], problem.task, (5, 6))


def test_an_episode_is_a_pure_function_of_its_four_arguments(trial):
    alone = [evaluate(RobotDesign(), trial.controller, trial.task, seed) for seed in (5, 6)]
    assert alone == list(try_all(trial).episodes)
    assert alone[0] != alone[1]
    assert run_trial(trial).metrics["speed_lps"] == pytest.approx(np.mean([e["speed_lps"] for e in alone]), abs=0)


@pytest.mark.parametrize(("episodes", "half"), [(2, 1), (3, 2)])
def test_a_trial_that_is_hopeless_half_way_is_stopped(trial, episodes, half):
    trial = replace(trial, seeds=(5, 6, 7)[:episodes])
    whole, stopped = run_trial(trial), run_trial(replace(trial, bar=-10.0))
    assert (whole.episodes, whole.stopped) == (episodes, False)
    assert (stopped.episodes, stopped.stopped) == (half, True)


def test_an_episode_without_a_tip_is_given_up(trial):
    task = replace(trial.task, seconds=4.0, patience=0.8)
    still = trial.controller | {"gain": 0.0, "amplitudes": [0.0, 0.0]}
    assert evaluate(RobotDesign(), still, task, 5)["duration"] == pytest.approx(0.8)


def test_a_refused_design_costs_no_simulation(trial, monkeypatch):
    monkeypatch.setattr(module, "rollout", None)
    monkeypatch.setattr("tensegym.tasks.trials.TensegrityRobot", None)
    outcome = run_trial(replace(trial, design={"elastic_cable": {"pretension": 1e4}}))
    assert outcome.refused and "stretches a cable" in outcome.refused
    assert outcome.episodes == 0


def test_a_gait_that_breaks_the_audit_goes_nowhere(trial, monkeypatch):
    from tensegym.robot import gait

    monkeypatch.setattr(gait, "AUDIT_TOLERANCE", -1.0)  # below what any gait keeps
    metrics = run_trial(trial).metrics
    assert metrics["sound"] == metrics["speed_lps"] == metrics["tips"] == 0.0


def test_drives_that_rotations_map_onto_each_other_are_of_one_kind():
    assert drive_kinds(RobotDesign()).tolist() == [0, 1, 0, 1, 1, 0]


def test_commands_turn_with_the_robot():
    design = RobotDesign()
    with TensegrityRobot(design, dt=4e-3) as robot:
        robot.reset(2, 0.3)
        robot.step(40)
        bearing = Bearing(np.array([0.6, 0.8]))
        generator = CpgController()
        generator.begin(robot)
        angles = generator.angles(robot, bearing)
        turned = []
        for symmetry in symmetries(design):
            # the same pose with the names of the nodes exchanged
            nodes = robot.node_positions_in_world()[np.argsort(symmetry.nodes)]
            generator.begin(robot)
            robot.node_positions_in_world = lambda nodes=nodes: nodes  # type: ignore[method-assign]
            turned.append(generator.angles(robot, bearing)[symmetry.drives])
            del robot.node_positions_in_world
    assert len(turned) == 3
    assert np.ptp(angles) > 1
    for other in turned:
        np.testing.assert_allclose(other, angles, atol=1e-9)


def test_coupling_brings_phases_to_their_lags():
    with TensegrityRobot(RobotDesign(), dt=4e-3) as robot:
        parameters = Cpg(lags=(0.0, 1.0), coupling=5.0, frequency=0.7)
        controller = CpgController(parameters)
        controller.begin(robot)
        controller.phases = controller.phases + np.array([0.5, -0.4, 0.2, 0.3, -0.6, 0.0])
        for _ in range(50):
            controller.angles(robot, AHEAD)
        ahead = controller.phases - np.array([0.0, 1.0])[drive_kinds(robot.design)]
    assert np.ptp(ahead) < 1e-6
    assert ahead.mean() == pytest.approx(2 * math.pi * 0.7 * 50 * 0.4, rel=1e-6)


def test_commands_stay_within_the_deepest_pull():
    with TensegrityRobot(RobotDesign(), dt=4e-3) as robot:
        generator = CpgController(Cpg(gain=100.0))
        generator.begin(robot)
        angles = generator.angles(robot, AHEAD)
        assert ((angles >= 0) & (angles <= robot.command_limit)).all()


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"gain": -1.0}, "Cpg.gain = -1.0 is outside"),
        ({"lags": (0.0,)}, "want as many lags"),
        ({"amplitudes": (math.nan, 0.0)}, r"amplitudes\[1\] = nan is no finite number"),
        ({"amplitudes": (0.0,), "lags": (0.0,), "feedback": fitted_feedback()[:28]}, "the robot has 2"),
    ],
)
def test_bad_generators_are_refused(fields, words):
    with pytest.raises(DesignError, match=words), TensegrityRobot(RobotDesign(), dt=4e-3) as robot:
        CpgController(Cpg(**fields)).begin(robot)


def test_without_friction_a_robot_slides_down_a_slope_as_a_block_does():
    angle, uphill = math.radians(10), np.array([0.6, 0.8])
    with TensegrityRobot(RobotDesign(friction=0.0), dt=2e-3) as robot:
        robot.reset(0)
        robot.slope(angle, uphill)
        robot.step(100)
        meter, first, speed = GaitMeter(robot, uphill), robot.centre_of_mass_in_world(), robot.momentum_in_world()[0]
        robot.step(250)
        meter.update()
        way, excess = (robot.centre_of_mass_in_world() - first)[:2] @ uphill, meter.metrics().audit_excess
    begun = speed[:2] @ uphill / robot.design.mass
    assert way == pytest.approx(0.5 * begun - 0.5 * 9.81 * math.sin(angle) * 0.5**2, rel=0.01)
    assert excess < 1e-3  # what it gains in speed it loses in height


def test_crossing_is_tried_on_the_same_bumps_by_every_worker(tiny):
    task = tiny(('motion = "roll"', 'motion = "cross"'), ("seconds = 0.8", "seconds = 1.5")).task
    control = {"gain": 2.0}
    first, again = (evaluate(RobotDesign(), control, task, 7) for _ in range(2))
    assert first == again
    assert first["path"] > 0.2 and first["sound"] == 1.0
    assert first != evaluate(RobotDesign(), control, replace(task, roughness=0.0), 7)


def test_a_step_is_judged_by_the_face_it_was_to_reach(tiny):
    task = tiny(('motion = "roll"', 'motion = "step"'), ("seconds = 0.8", "seconds = 4.0")).task
    control = {"policy": "", "gain": 2.0}
    seeds = range(40, 52)
    reached = [evaluate(RobotDesign(), control, task, seed) for seed in seeds]
    assert {e["tips"] for e in reached} == {0.0, 1.0}
    assert all(e["arrived"] <= e["tips"] for e in reached)
    assert sum(e["arrived"] for e in reached) > 0


@pytest.mark.parametrize(
    ("design", "why"),
    [
        ({"flexure": {"hinge": "nonsense"}}, "nonsense"),  # a FlexureError
        ({"flexure": {"thickness": 1e-5}, "elastic_cable": {"pretension": 40.0}}, "buckles"),
    ],
)
def test_what_a_trial_raises_is_its_result(trial, design, why):
    outcome = run_trial(replace(trial, design=design))
    assert why in outcome.refused and outcome.episodes == 0


@dataclass(frozen=True, kw_only=True)
class Breaks(Roll):
    def begin(self, robot, start, rng):
        raise SimulationError("diverged, as some robots do")


def test_a_trial_that_diverges_while_it_settles_is_no_way_and_no_error(trial):
    outcome = run_trial(replace(trial, task=Breaks(seconds=0.8, dt=0.004)))
    assert outcome.refused is None
    assert (outcome.metrics["sound"], outcome.metrics["speed_lps"]) == (0.0, 0.0)


def test_without_gravity_there_is_no_cost_of_transport(trial):
    outcome = run_trial(replace(trial, design={"gravity": 0.0}))
    assert outcome.refused is None and outcome.metrics["cost_of_transport"] == 1e3
