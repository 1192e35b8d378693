"""The environments of a training against stable-baselines3's own way of holding them."""

from functools import partial

import gymnasium as gym
import numpy as np
from stable_baselines3.common.vec_env import DummyVecEnv

from tensegym.train.vec_env import RollingVecEnv

SHORT = {"control_period": 0.02, "settle": 0.0, "observation": "onboard"}


def test_it_gives_what_sb3s_own_gives():
    ours = RollingVecEnv(3, 4, SHORT, processes=2)
    make = partial(gym.make, "tensegym/SixRodRolling-v0", max_episode_steps=4, **SHORT)
    theirs = DummyVecEnv([make] * 3)
    rng = np.random.default_rng(0)
    try:
        for seed in (1, 2):  # the second seed comes in the middle of episodes
            for env in (ours, theirs):
                env.seed(seed)
            np.testing.assert_array_equal(ours.reset(), theirs.reset())
            for _ in range(6):
                actions = rng.uniform(-1, 1, (3, 6)).astype(np.float32)
                (a, rewards, ended, infos), (b, r, e, i) = ours.step(actions), theirs.step(actions)
                np.testing.assert_array_equal(a, b)
                np.testing.assert_allclose(rewards, r, rtol=1e-6)
                np.testing.assert_array_equal(ended, e)
                for mine, own in zip(infos, i, strict=True):
                    assert mine["gait"] == own["gait"]
                    assert mine.get("TimeLimit.truncated", False) == own["TimeLimit.truncated"]
                    if "terminal_observation" in own:
                        np.testing.assert_array_equal(mine["terminal_observation"], own["terminal_observation"])
                assert [x["face"] for x in ours.reset_infos] == [x["face"] for x in theirs.reset_infos]
        assert ours.get_attr("dt", [1]) == [2e-3]
    finally:
        ours.close()
        theirs.close()
