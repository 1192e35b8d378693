"""Designs that vary: where they lie in their ranges, what is drawn, and what an environment does with them."""

import warnings
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stable_baselines3.common.env_checker import check_env

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design, design_to_dict
from tensegym.design.variation import parse_variation
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import DesignError
from tensegym.search.problem import load_problem
from tensegym.train.config import load_config

VARY = {
    "elastic_cable.stiffness": {"low": 200.0, "high": 800.0, "log": True},
    "stiff_cable.max_pull": {"low": 0.3, "high": 0.6},
}


def place(design):
    return parse_variation(VARY, RobotDesign()).normalised(design)


# -- ranges ------------------------------------------------------------------------------------------------------------


def test_a_design_outside_a_range_lies_at_its_nearer_end():
    design = RobotDesign()
    outside = design.with_(elastic_cable=design.elastic_cable.__class__(stiffness=5000.0))
    assert place(outside).tolist() == [1.0, pytest.approx(0.0)]


@settings(max_examples=20)
@given(st.lists(st.floats(0, 1), min_size=2, max_size=2))
def test_a_design_lies_where_it_was_put(parts):
    put = parse_variation(VARY, RobotDesign()).at(RobotDesign(), np.array(parts))
    np.testing.assert_allclose(place(put), 2 * np.array(parts) - 1, atol=1e-9)
    back = put.with_(elastic_cable=RobotDesign().elastic_cable, stiff_cable=RobotDesign().stiff_cable)
    assert design_to_dict(back) == design_to_dict(RobotDesign())


def test_draws_fill_the_ranges_and_repeat_with_their_seed():
    ranges = parse_variation(VARY, RobotDesign())
    rng = np.random.default_rng(0)
    places = np.array([ranges.normalised(ranges.draw(RobotDesign(), rng)) for _ in range(100)])
    assert places.min() < -0.9 and places.max() > 0.9
    assert np.abs(places.mean(axis=0)).max() < 0.25  # 4 standard errors of a uniform one
    again = ranges.draw(RobotDesign(), np.random.default_rng(0))
    np.testing.assert_array_equal(ranges.normalised(again), places[0])


def test_ranges_without_one_sound_design_say_so():
    # 30 N in cables of 1 to 2 N/m leave none of them a natural length
    hopeless = {"elastic_cable.stiffness": {"low": 1.0, "high": 2.0}}
    with pytest.raises(DesignError, match=r"were all refused, the last one: ElasticCable\.pretension"):
        parse_variation(hopeless, RobotDesign()).draw(RobotDesign(), np.random.default_rng(0))


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({}, "must map fields to ranges"),
        ("payload", "vary = 'payload' names no ranges; there are payload_body"),
        ([1], r"vary = \[1\] must map fields"),
        ({"elastic_cable.stiffness": {"low": 1.0, "high": 10**400}}, "is no finite number"),
        ({"elastic_cable.stiffness": {"low": 1.0}}, "must give low and high"),
        ({"elastic_cable.stiffness": {"low": 300.0, "high": 300.0}}, "from 300 to 300 is no range"),
        ({"elastic_cable.damping": {"low": 0.0, "high": 3.0, "log": True}}, "above 0 with log"),
        ({"elastic_cable.stiffness": {"low": -5.0, "high": 300.0}}, r"ElasticCable.stiffness = -5.0 is outside"),
        ({"elastic_cable.stifness": {"low": 1.0, "high": 2.0}}, "'elastic_cable.stifness' is no number of the design"),
        ({"elastic_cable.two_way": {"low": 0.0, "high": 1.0}}, "'elastic_cable.two_way' is no number"),
        ({"payload.mass": {"low": 0.1, "high": 1.0}}, "'payload.mass' is no number of the design 'six_rod'"),
    ],
)
def test_bad_ranges_are_refused(vary, words):
    with pytest.raises(DesignError, match=words):
        RollingEnv(vary=vary)


def test_a_negative_number_of_episodes_is_refused():
    with pytest.raises(DesignError, match="episodes_per_design = -1 must be a whole number, 0 or more"):
        RollingEnv(vary=VARY, episodes_per_design=-1)


# -- the environment ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["full", "onboard"])
def test_the_observation_ends_with_the_place_of_the_robot(kind):
    with RollingEnv(observation=kind, vary=VARY) as env, RollingEnv(observation=kind) as plain:
        observation, _ = env.reset(seed=1)
        assert design_to_dict(env.robot.design) != design_to_dict(RobotDesign())
        np.testing.assert_allclose(observation[-2:], place(env.robot.design), rtol=1e-6)
        without, _ = plain.reset(seed=2, options={"design": env.robot.design, "face": 3, "heading": 0.0,
                                                  "direction": 1.0})  # fmt: skip
        conditioned, _ = env.reset(options={"design": env.robot.design, "face": 3, "heading": 0.0, "direction": 1.0})
        np.testing.assert_array_equal(conditioned[:-2], without)


def test_sb3s_checker_finds_nothing():
    with RollingEnv(observation="onboard", vary=VARY) as env, warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env)


def test_a_robot_stays_for_its_episodes_and_a_seed_draws_it_anew():
    with RollingEnv(observation="onboard", vary=VARY, episodes_per_design=2, settle=0.0) as env:
        seen = [env.reset(seed=4)[0][-2:], *(env.reset()[0][-2:] for _ in range(3)), env.reset(seed=4)[0][-2:]]
    same = [np.array_equal(a, b) for a, b in pairwise(seen)]
    assert same == [True, False, True, False]
    np.testing.assert_array_equal(seen[4], seen[0])


def test_with_no_episodes_the_design_stays_as_given():
    with RollingEnv(observation="onboard", vary=VARY, episodes_per_design=0, settle=0.0) as env:
        for seed in (1, 2):
            np.testing.assert_allclose(env.reset(seed=seed)[0][-2:], place(RobotDesign()), rtol=1e-6)


def test_a_design_given_to_reset_is_not_drawn_over():
    stiff = RobotDesign().with_(stiff_cable=RobotDesign().stiff_cable.__class__(max_pull=0.5))
    with RollingEnv(observation="onboard", vary=VARY, settle=0.0) as env:
        observation, _ = env.reset(seed=1, options={"design": stiff})
        assert design_to_dict(env.robot.design) == design_to_dict(stiff)
        assert observation[-1] == pytest.approx(1 / 3, rel=1e-6)


@pytest.mark.parametrize("task", ["carry", "carry_conditioned"])
@pytest.mark.parametrize("config", ["conditioned", "carry"])
def test_a_policy_is_trained_on_the_designs_that_its_task_searches(config, task):
    env = load_config(config).env
    carry = load_problem(task)
    searched = {".".join(d.path[1:]): d.range for d in carry.space.dimensions if d.path[0] == "design"}
    found = parse_variation(env["vary"], as_design(env["design"]))
    assert list(found.ranges.items()) == list(searched.items())
    assert found == parse_variation("payload_body", as_design(env["design"]))
    assert env["design"]["payload"]["mass"] == carry.task.payload
