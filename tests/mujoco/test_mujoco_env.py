"""Environments and searches on MuJoCo."""

import pickle

import gymnasium as gym
import numpy as np
import pytest

from tensegym.errors import DesignError
from tensegym.search.evaluate import TrialSpec, run_trial
from tensegym.search.problem import load_problem
from tensegym.tasks import as_task


def play(env, seed=3, steps=3):
    observation, _ = env.reset(seed=seed)
    rng, seen = np.random.default_rng(0), [observation]
    for _ in range(steps):
        observation, reward, terminated, _, _ = env.step(rng.uniform(-1, 1, env.action_space.shape))
        assert not terminated
        seen.append([*observation, reward])
    return np.concatenate(seen)


@pytest.mark.parametrize("name", ["tensegym/SixRodRolling-v0", "tensegym/FlexibleSixRodRolling-v0"])
def test_an_environment_pickles_with_its_engine_and_repeats_its_bits(name):
    env = gym.make(name, engine="mujoco")
    other = pickle.loads(pickle.dumps(env))
    assert other.unwrapped.robot.engine == "mujoco"
    first = play(env)
    np.testing.assert_array_equal(play(other), first)
    np.testing.assert_array_equal(play(env), first)
    plain = gym.make(name)
    assert np.abs(play(plain) - first).max() > 0
    for each in (env, other, plain):
        each.close()


def test_many_environments_at_once_are_on_it():
    vector = gym.make_vec("tensegym/SixRodRolling-v0", num_envs=2, engine="mujoco", processes=1)
    single = gym.make("tensegym/SixRodRolling-v0", engine="mujoco")
    observations, _ = vector.reset(seed=5)
    np.testing.assert_array_equal(observations[0], single.reset(seed=5)[0])
    for each in (vector, single):
        each.close()


@pytest.mark.parametrize(("arguments", "words"), [
    ({"engine": "bulet"}, "'bulet'.*pybullet, mujoco"), ({"engine": "mujoco", "render_mode": "human"}, "has no window"),
])  # fmt: skip
def test_what_an_engine_has_not_is_refused(arguments, words):
    with pytest.raises(DesignError, match=words):
        gym.make("tensegym/SixRodRolling-v0", **arguments)


def test_a_search_takes_its_engine_from_the_task_or_the_command():
    problem = load_problem("carry").with_settings("mujoco", seed=4)
    assert (problem.task.engine, problem.settings.seed) == ("mujoco", 4)
    assert problem.with_settings().task.engine == "mujoco"
    task = as_task({"motion": "roll", "engine": "mujoco", "seconds": 1.0})
    both = task, task.changed(engine="pybullet")
    results = [run_trial(TrialSpec(0, {}, {"kind": "random"}, each, (1,))) for each in both]
    assert [result.refused for result in results] == [None, None]
    assert results[0].metrics["path"] != results[1].metrics["path"]
