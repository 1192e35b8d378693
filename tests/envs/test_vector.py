"""Many environments as one: against single ones, whatever the number of processes."""

import os
import signal
import subprocess
import sys
import time

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from tensegym.envs.vector import RollingVectorEnv
from tensegym.errors import DesignError, SimulationError

SHORT = {"control_period": 0.02, "settle": 0.0}


def run(env: RollingVectorEnv, steps: int) -> list[np.ndarray]:
    """Seeded episodes under seeded actions; everything the environment gives but infos."""
    seen = [env.reset(seed=3)[0]]
    rng = np.random.default_rng(0)
    for _ in range(steps):
        observations, rewards, terminated, truncated, _ = env.step(rng.uniform(-1, 1, env.action_space.shape))
        seen += [observations, rewards, terminated, truncated]
    return seen


def test_the_number_of_processes_changes_nothing():
    with_one, with_two = (RollingVectorEnv(3, processes, 4, **SHORT) for processes in (1, 2))
    try:
        for one, two in zip(run(with_one, 6), run(with_two, 6), strict=True):
            np.testing.assert_array_equal(one, two)
    finally:
        with_one.close()
        with_two.close()


def test_rows_are_single_environments_that_start_anew_in_the_step_that_ends_them():
    vector = gym.make_vec("tensegym/SixRodRolling-v0", num_envs=2, processes=1, max_episode_steps=3, **SHORT)
    single = gym.make("tensegym/SixRodRolling-v0", max_episode_steps=3, **SHORT)
    assert isinstance(vector, RollingVectorEnv)
    assert vector.metadata["autoreset_mode"] == AutoresetMode.SAME_STEP
    observations, _ = vector.reset(seed=5)
    observation, _ = single.reset(seed=6)  # the second row's seed
    rng = np.random.default_rng(1)
    for step in range(1, 5):
        np.testing.assert_array_equal(observations[1], observation)
        assert observations in vector.observation_space
        actions = rng.uniform(-1, 1, (2, 6)).astype(np.float32)
        observations, rewards, terminated, truncated, infos = vector.step(actions)
        observation, reward, _, ended, info = single.step(actions[1])
        assert rewards[1] == reward
        assert truncated[1] == ended == (step == 3)
        assert not terminated.any()
        if ended:
            np.testing.assert_array_equal(infos["final_obs"][1], observation)
            assert infos["final_info"]["gait"]["tips"][1] == info["gait"]["tips"]
            observation, start = single.reset()
            assert infos["face"][1] == start["face"]
    vector.close()
    single.close()


def test_the_registered_time_limit_holds():
    vector = gym.make_vec("tensegym/FlexibleSixRodRolling-v0", num_envs=1, control_period=0.002, settle=0.0)
    assert vector.metadata["render_fps"] == pytest.approx(1 / 0.002)
    vector.reset(seed=0)
    ends = [bool(vector.step(np.zeros((1, 6)))[3][0]) for _ in range(101)]
    assert np.flatnonzero(ends).tolist() == [49, 99]
    vector.close()


def test_bad_input_is_an_error_here_and_leaves_the_processes_at_work():
    vector = RollingVectorEnv(2, 2, **SHORT)
    with pytest.raises(DesignError, match="colour"):
        vector.reset(options={"colour": 1})
    assert vector.reset(seed=0)[0].shape == vector.observation_space.shape
    vector.close()
    for arguments in ({"num_envs": 0}, {"processes": 0}, {"num_envs": 2, "processes": 2, "observation": "none"},
                      {"render_mode": "human"}):  # fmt: skip
        with pytest.raises(DesignError):
            RollingVectorEnv(**arguments)


@pytest.mark.parametrize("processes", [1, 2])
def test_actions_and_seeds_that_do_not_fit_are_refused_before_any_environment_steps(processes):
    vector, twin = (RollingVectorEnv(3, processes, **SHORT) for _ in range(2))
    for env in (vector, twin):
        env.reset(seed=0)
    nan = np.zeros((3, 6))
    nan[2, 1] = np.nan
    for actions, words in (
        (np.zeros((4, 6)), r"\(3, 6\).*\(4, 6\)"), (np.zeros((2, 6)), r"\(2, 6\)"), (np.zeros((3, 7)), r"\(3, 7\)"),
        (np.zeros(18), r"\(18,\)"), (None, "shape"), ("no", "no"), (nan, "row 2"),
    ):  # fmt: skip
        with pytest.raises(DesignError, match=words):
            vector.step(actions)
    with pytest.raises(DesignError, match="seed has 2 entries"):
        vector.reset(seed=[1, 2])
    for one, two in zip(vector.step(np.ones((3, 6)))[:4], twin.step(np.ones((3, 6)))[:4], strict=True):
        np.testing.assert_array_equal(one, two)
    for env in (vector, twin):
        env.close()


def test_a_dead_process_is_an_error_and_none_is_left():
    vector = RollingVectorEnv(2, 2, **SHORT)
    vector.reset(seed=0)
    workers = [worker.process for worker in vector.batch.workers]
    os.kill(workers[0].pid, signal.SIGKILL)
    workers[0].join()
    with pytest.raises(SimulationError, match="died"):
        for _ in range(2):
            vector.step(np.zeros((2, 6)))
            time.sleep(0.1)
    vector.close()
    assert not any(worker.is_alive() for worker in workers)


def test_every_robot_has_its_picture():
    vector = RollingVectorEnv(2, 1, render_mode="rgb_array", **SHORT)
    vector.reset(seed=0)
    pictures = vector.render()
    assert [picture.shape for picture in pictures] == [(360, 480, 3)] * 2
    assert (pictures[0] != pictures[1]).any()
    vector.close()


def test_a_script_without_a_main_guard_is_told_so(tmp_path):
    script = tmp_path / "bare.py"
    script.write_text('import gymnasium, tensegym\ngymnasium.make_vec("tensegym/SixRodRolling-v0", 2, processes=2)\n')
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True)
    assert done.returncode != 0
    assert "did not start; a script starts workers under `if __name__" in done.stderr
