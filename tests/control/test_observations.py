"""What is put beside an observation."""

import gymnasium as gym
import numpy as np

import tensegym  # noqa: F401  # registers the environments


def test_a_memory_holds_what_was_seen_before_and_forgets_it_at_a_reset():
    plain, remembers = (
        gym.make("tensegym/SixRodRolling-v0", observation=kind, dt=0.004, control_period=0.04,
                 disturb={"attitude_noise": 0.01})  # what is remembered came through the sensors
        for kind in ("onboard", "onboard-memory")
    )  # fmt: skip
    for seed in (1, 2):
        seen = [plain.reset(seed=seed)[0]] * 3
        memory = remembers.reset(seed=seed)[0]
        for turn in range(4):
            np.testing.assert_array_equal(memory, np.concatenate(seen[: -4 : -1]))
            action = np.full(6, 0.2 * turn, dtype=np.float32)
            seen.append(plain.step(action)[0])
            memory = remembers.step(action)[0]
    assert remembers.observation_space.contains(memory)
    plain.close(), remembers.close()


def test_a_memory_is_symmetric_as_what_it_remembers():
    from tensegym.train.symmetric_policy import symmetry_arguments

    env = gym.make("tensegym/SixRodRolling-v0", observation="onboard-memory")
    single = gym.make("tensegym/SixRodRolling-v0", observation="onboard")
    whole, one = (symmetry_arguments(each.unwrapped) for each in (env, single))
    size = single.observation_space.shape[0]
    for name, factor in (("observation_index", size), ("observation_sign", 0)):
        for image, first in zip(whole[name], one[name], strict=True):
            assert image == [entry + moment * factor for moment in range(3) for entry in first]
    env.close(), single.close()
