"""The rolling environment: its contract with Gymnasium and SB3, what repeats, what is refused, what is reported."""

import json
import math
import multiprocessing
import pickle
import subprocess
import sys
import warnings

import gymnasium as gym
import numpy as np
import pybullet
import pytest
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.design.design import ElasticCable, Payload, RobotDesign
from tensegym.design.design_file import design_to_dict, save_design
from tensegym.envs import CONTROL_PERIOD, ROLLING
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import DesignError, SimulationError
from tensegym.robot.rendering import tension_colour

KINDS = ("full", "onboard")


@pytest.fixture(scope="module", params=KINDS)
def env(request):
    with RollingEnv(observation=request.param) as made:
        yield made


def actions(count, seed=0, width=6):
    return np.random.default_rng(seed).uniform(-1, 1, (count, width))


def rollout(env, steps, seed=3):
    """Observations (steps + 1, n) and rewards (steps,) of random actions."""
    observation, _ = env.reset(seed=seed)
    seen, rewards = [observation], []
    for action in actions(steps, seed):
        observation, reward, *_ = env.step(action)
        seen.append(observation)
        rewards.append(reward)
    return np.array(seen), np.array(rewards)


# -- contract ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_gymnasiums_checker_finds_nothing(kind, monkeypatch):
    # the checker opens every render mode; a window needs a display
    monkeypatch.setattr(RollingEnv, "metadata", {**RollingEnv.metadata, "render_modes": ["rgb_array"]})
    env = gym.make(ROLLING, observation=kind, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


@pytest.mark.parametrize("kind", KINDS)
def test_sb3s_checker_finds_nothing(kind):
    from stable_baselines3.common.env_checker import check_env as sb3_check_env

    env = gym.make(ROLLING, observation=kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sb3_check_env(env)
    env.close()


def test_the_id_registers_itself_in_a_fresh_process():
    code = (
        "import gymnasium as gym; env = gym.make('tensegym:tensegym/SixRodRolling-v0', observation='onboard'); "
        "print(env.spec.max_episode_steps, env.observation_space.shape, env.action_space.shape)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[0] == "50 (54,) (6,)"


def test_the_spec_goes_to_json_and_back():
    made = gym.make(ROLLING, design={"friction": 0.5}, reward={"slip": 0.1})
    again = gym.make(gym.envs.registration.EnvSpec.from_json(made.spec.to_json()))
    assert again.unwrapped.robot.design.friction == 0.5
    assert again.unwrapped.task.reward.slip == 0.1
    made.close()
    again.close()


def test_the_time_limit_truncates_at_20_seconds():
    env = gym.make(ROLLING)
    env.reset(seed=0)
    started, ends = env.unwrapped.robot.time, []
    while not ends or not ends[-1]:
        _, _, terminated, truncated, _ = env.step(np.full(6, -1.0))
        assert not terminated
        ends.append(truncated)
    assert len(ends) == 50
    assert env.unwrapped.robot.time - started == pytest.approx(20.0)
    env.close()


def test_spaces_have_the_documented_sizes():
    with RollingEnv() as full, RollingEnv(observation="onboard") as onboard:
        assert full.observation_space.shape == (36 + 36 + 12 + 3 * 6 + 30,)
        assert onboard.observation_space.shape == (18 + 18 + 3 * 6,)
        assert full.action_space == gym.spaces.Box(-1.0, 1.0, (6,), dtype=np.float32)
        assert full.metadata["render_fps"] * CONTROL_PERIOD == pytest.approx(1)


def test_random_actions_stay_within_bounds_and_move_the_robot(env):
    for seed in range(3):
        seen, rewards = rollout(env, 25, seed)
        assert all(observation in env.observation_space for observation in seen)
        assert np.ptp(rewards) > 0
        assert np.abs(np.diff(seen, axis=0)).max(axis=1).min() > 0.01


def test_a_slope_rises_along_the_wanted_direction():
    with RollingEnv(observation="onboard", slope=10.0) as env:
        for direction in (0.3, 2.0):
            env.reset(seed=1, options={"direction": direction})
            uphill = np.array([np.cos(direction), np.sin(direction)])
            np.testing.assert_allclose(env.robot.gravity[:2], -9.81 * np.sin(np.radians(10)) * uphill, rtol=1e-12)
            assert env.robot.gravity[2] == pytest.approx(-9.81 * np.cos(np.radians(10)))
            rows = [env.step(np.full(6, -1.0))[4]["gait"] for _ in range(5)]
            assert rows[-1]["audit_passed"] and abs(rows[-1]["speed_lps"]) < 0.02  # it stands: friction is 0.8


def test_a_slope_out_of_range_is_refused():
    with pytest.raises(DesignError, match=r"slope = 70 is outside \[0, 60\] deg"):
        RollingEnv(slope=70)


# -- what repeats ------------------------------------------------------------------------------------------------------


def test_a_seed_decides_the_start_and_another_seed_another_one(env):
    first, info = env.reset(seed=11)
    env.reset(seed=12)
    again, same = env.reset(seed=11)
    np.testing.assert_array_equal(again, first)
    assert same == info
    following = env.reset()[1]
    assert following != info
    env.reset(seed=11)
    assert env.reset()[1] == following


def test_every_face_comes_up(env):
    assert {env.reset(seed=seed)[1]["face"] for seed in range(120)} == set(range(20))


def test_a_pickled_env_has_its_own_client_and_rolls_out_the_same(env):
    other = pickle.loads(pickle.dumps(env))
    try:
        assert other.robot.world.client != env.robot.world.client
        for one, two in zip(rollout(env, 10), rollout(other, 10), strict=True):
            np.testing.assert_array_equal(one, two)
        other.close()
        env.reset(seed=0)  # closing the copy leaves the original alive
    finally:
        other.close()


def _rollout_in_a_new_env(steps):
    with RollingEnv() as env:
        return rollout(env, steps)


def test_500_steps_are_bitwise_the_same_in_two_processes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.apply_async(_rollout_in_a_new_env, (500,))
        here = _rollout_in_a_new_env(500)
        for one, two in zip(here, there.get(), strict=True):
            np.testing.assert_array_equal(one, two)


OPEN_AND_CLOSE = """
import gc, json, resource
import pybullet
from tensegym.envs.rolling import RollingEnv

def use():
    env = RollingEnv(observation="onboard", settle=0.0)
    env.reset(seed=0)
    env.step([0, 0, 0, 0, 0, 0])
    return env

for _ in range(20):  # warm: compiled kernels, allocator, caches
    use().close()
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for _ in range(100):
    use().close()
for _ in range(100):
    use()  # dropped, never closed
gc.collect()
grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
clients = sum(pybullet.isConnected(physicsClientId=c) for c in range(300))
print(json.dumps([grown, clients]))
"""


def test_200_envs_opened_and_closed_or_dropped_leave_no_client_and_no_memory():
    done = subprocess.run([sys.executable, "-c", OPEN_AND_CLOSE], capture_output=True, text=True, check=True)
    grown, clients = json.loads(done.stdout.splitlines()[-1])
    assert clients == 0
    assert grown < 10_000  # kB


@settings(max_examples=10, deadline=None)
@given(turn=st.floats(-math.pi, math.pi), face=st.integers(0, 19), kind=st.sampled_from(KINDS))
def test_turning_start_and_wanted_direction_together_changes_nothing_seen(turn, face, kind):
    with RollingEnv(observation=kind, settle=0.0) as env:
        starts = [{"face": face, "heading": 0.3 + extra, "direction": -0.6 + extra} for extra in (0, turn)]
        seen = [env.reset(options=start)[0] for start in starts]
        np.testing.assert_allclose(seen[1], seen[0], atol=1e-6)


@pytest.mark.parametrize("turn", [1.0, -2.2])
def test_turning_start_and_wanted_direction_together_turns_the_motion(turn):
    """As far as the engine's friction iterations, which work along the world's axes, converge."""
    with RollingEnv() as env:
        ways = []
        for extra in (0, turn):
            env.reset(options={"face": 3, "heading": 0.3 + extra, "direction": -0.6 + extra})
            for action in actions(3):
                gait = env.step(action)[4]["gait"]
            ways.append([gait["speed"], gait["path"], gait["energy"]])
        np.testing.assert_allclose(ways[1], ways[0], rtol=0.05, atol=1e-3)


def test_another_wanted_direction_is_seen(env):
    one, _ = env.reset(options={"face": 0, "heading": 0.0, "direction": 0.0})
    two, _ = env.reset(options={"face": 0, "heading": 0.0, "direction": 1.0})
    assert np.abs(one - two).max() > 0.1


# -- another design in the same env ------------------------------------------------------------------------------------


def test_reset_takes_another_design_and_equals_an_env_made_with_it(tmp_path):
    soft = RobotDesign(elastic_cable=ElasticCable(stiffness=200.0), friction=0.6)
    save_design(soft, tmp_path / "soft.toml")
    with RollingEnv() as env, RollingEnv(soft) as other:
        wanted, _ = other.reset(seed=5)
        for given_as in (soft, design_to_dict(soft), str(tmp_path / "soft.toml")):
            env.reset(seed=1, options={"design": "six_rod"})
            observation, _ = env.reset(seed=5, options={"design": given_as})
            np.testing.assert_array_equal(observation, wanted)
            assert env.observation_space == other.observation_space
        action = actions(1)[0]
        np.testing.assert_array_equal(env.step(action)[0], other.step(action)[0])
        assert env.robot.design.friction == 0.6  # and it stays until the next design
        env.reset()
        assert env.robot.design.friction == 0.6


def test_a_design_that_observes_more_is_refused_and_the_env_goes_on():
    with RollingEnv() as env:
        before, _ = env.reset(seed=2)
        with pytest.raises(DesignError, match=r"observes 138 values, this environment 132: tension 36 \(here 30\)"):
            env.reset(options={"design": RobotDesign(payload=Payload())})
        after, _ = env.reset(seed=2)
        np.testing.assert_array_equal(after, before)
        assert env.step(actions(1)[0])[0] in env.observation_space


def test_an_onboard_env_takes_a_payload_since_it_observes_as_much():
    with RollingEnv(observation="onboard") as env:
        observation, _ = env.reset(seed=2, options={"design": RobotDesign(payload=Payload())})
        assert observation in env.observation_space
        assert len(env.robot.tensions) == 36


def test_a_payload_env_observes_36_tensions():
    with RollingEnv({"payload": {}}) as env:
        observation, _ = env.reset(seed=0)
        assert observation.shape == (138,)
        assert env.step(actions(1)[0])[0] in env.observation_space


# -- what is refused ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"observation": "camera"}, "observation = 'camera' is not one of full, onboard"),
        ({"control_period": 0.0301}, r"control_period = 0.0301 s must be a whole number of steps of dt = 0.002 s"),
        ({"control_period": 0.0}, r"control_period = 0.0 is outside"),
        ({"control_period": math.inf}, r"control_period = inf is outside"),
        ({"control_period": "slow"}, r"control_period = 'slow' is outside"),
        ({"dt": 0.0}, r"dt = 0.0 is outside \[1e-06, 0.004\] s"),
        ({"dt": math.nan}, r"dt = nan is no finite number"),
        ({"settle": -0.1}, r"settle = -0.1 is outside \[0, 60\] s"),
        ({"reward": {"speed": 1.0}}, "unknown field 'speed' in reward; one of arrive, energy, progress, slip"),
        ({"reward": {"slip": -1.0}}, r"reward.slip = -1.0 is outside \[0, 1000\]"),
        ({"reward": {"slip": math.nan}}, "reward.slip = nan is no finite number"),
        ({"reward": {"slip": "much"}}, "reward.slip = 'much' is a text, no number"),
        ({"render_mode": "ansi"}, "render_mode = 'ansi' is not one of"),
        ({"design": "seven_rod"}, "unknown preset 'seven_rod'"),
    ],
)
def test_bad_arguments_name_the_argument(arguments, words):
    with pytest.raises(DesignError, match=words):
        RollingEnv(**arguments)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"faces": 1}, "unknown field 'faces' in reset options; did you mean 'face'"),
        ({"face": 20}, r"face = 20 is outside 0\.\.19"),
        ({"face": 1.5}, "face = 1.5 must be a whole number"),
        ({"heading": math.nan}, "heading = nan must be a finite angle"),
        ({"direction": "north"}, "direction = 'north' must be a finite angle"),
        ({"design": "nope"}, "unknown preset 'nope'"),
        ("face", "reset options = 'face' must be a table"),
        ([1], "must be a table"),
    ],
)
def test_bad_reset_options_name_the_option(env, options, words):
    with pytest.raises(DesignError, match=words):
        env.reset(options=options)
    assert env.reset(seed=0)[0] in env.observation_space


@pytest.mark.parametrize("seed", [1.5, -1, "one", True])
def test_a_seed_that_is_none_is_refused(env, seed):
    with pytest.raises(DesignError, match="seed = "):
        env.reset(seed=seed)


@pytest.mark.parametrize("width", [1, 5, 7])
def test_an_action_of_another_length_is_refused(env, width):
    env.reset(seed=0)
    with pytest.raises(DesignError, match=rf"an action has shape \(6,\).*given \({width},\)"):
        env.step(np.zeros(width))


def test_a_window_without_a_display_is_refused(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(SimulationError, match="no display"):
        gym.make(ROLLING, render_mode="human")


# -- what is reported --------------------------------------------------------------------------------------------------


def test_reward_is_the_sum_of_its_terms_and_its_terms_those_of_the_gait():
    weights = {"progress": 2.0, "slip": 0.5, "energy": 1e-3}
    with RollingEnv(reward=weights) as env:
        env.reset(seed=4)
        sums = dict.fromkeys(weights, 0.0)
        for action in actions(10, 4):
            _, reward, _, _, info = env.step(action)
            assert reward == sum(info["reward_terms"].values())
            for name, value in info["reward_terms"].items():
                sums[name] += value
        gait, length = info["gait"], env.robot.design.length
        assert sums["progress"] == pytest.approx(2.0 * gait["speed_lps"] * gait["duration"])
        assert sums["slip"] == pytest.approx(-0.5 * gait["slip_share"] * gait["path"] / length)
        assert sums["energy"] == pytest.approx(-1e-3 * gait["energy"])
        assert gait["duration"] == pytest.approx(4.0)
        assert gait["path"] > 0.05
        assert gait["energy"] > 0


def _check_ended(env, ended, words, gait):
    observation, reward, terminated, truncated, info = ended
    assert terminated and not truncated
    assert words in info["termination"]
    assert reward == 0
    assert (observation == 0).all()
    assert info["gait"] == gait  # of the last sound step
    assert set(info["reward_terms"]) == {"progress", "slip", "energy"}
    observation, _ = env.reset(seed=0)
    assert observation in env.observation_space
    assert not env.step(actions(1)[0])[2]


def test_a_diverged_simulation_ends_with_its_reason_and_the_env_goes_on(env):
    env.reset(seed=0)
    gait = env.step(actions(1)[0])[4]["gait"]
    env.robot.natural_lengths[24:] = -1e4
    _check_ended(env, env.step(np.zeros(6)), "diverged at t = ", gait)


@pytest.mark.parametrize("action", [np.full(6, np.nan), [0, 0, 0, 0, 0, np.inf], None, "left", [[0] * 6], [0, [1]], {}])
def test_what_is_no_action_is_refused_and_the_env_is_as_it_was(env, action):
    wanted = rollout(env, 3)[0]
    env.reset(seed=3)
    for number, sound in enumerate(actions(3, 3)):
        with pytest.raises(DesignError, match="action"):
            env.step(action)
        np.testing.assert_array_equal(env.step(sound)[0], wanted[number + 1])


def test_a_step_before_the_first_reset_or_after_the_end_says_what_to_do():
    env = RollingEnv(observation="onboard")
    with pytest.raises(SimulationError, match=r"call reset\(\)"):
        env.step(np.zeros(6))
    env.reset(seed=0)
    env.robot.natural_lengths[24:] = -1e4
    assert env.step(np.zeros(6))[2]
    with pytest.raises(SimulationError, match=r"has ended \(diverged .*call reset\(\)"):
        env.step(np.zeros(6))
    env.close()
    for call in (lambda: env.step(np.zeros(6)), env.reset):
        with pytest.raises(SimulationError, match="is closed"):
            call()


def test_a_robot_that_comes_apart_leaves_the_bounds_and_ends():
    """With every cable slack a thrown rod flies off: slow enough for the integrator, too far for the nodes' bound."""
    with RollingEnv() as env:
        env.reset(seed=0)
        gait = env.step(actions(1)[0])[4]["gait"]
        env.robot.natural_lengths[:] = 1e3
        rod, client = env.robot.world.body_ids[0], env.robot.world.client
        pybullet.resetBaseVelocity(rod, [8, 0, 4], [0, 0, 0], physicsClientId=client)
        _check_ended(env, env.step(-np.ones(6)), "a node left its bound, 2 rod lengths", gait)


def test_pictures_show_the_cables_in_the_colour_of_their_tension():
    with RollingEnv(render_mode="rgb_array") as env:
        env.reset(seed=0)
        picture = env.render()
        assert picture.shape == (360, 480, 3)
        assert picture.dtype == np.uint8
        colours = {tuple(pixel) for pixel in picture.reshape(-1, 3).tolist()}
        seen = [tension_colour(tension) in colours for tension in env.robot.tensions]
        assert sum(seen) >= 20  # a cable may lie behind others
        env.robot.tensions[:] = 60.0
        red = (env.render() == tension_colour(60.0)).all(axis=2).sum()
        assert red > 500
        assert (picture == tension_colour(60.0)).all(axis=2).sum() == 0


def test_no_render_mode_renders_nothing(env):
    env.reset(seed=0)
    assert env.render() is None
