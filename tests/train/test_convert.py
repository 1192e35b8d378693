"""Policies of Stable-Baselines3's files: the same actions and the same training, for who trusts their maker."""

import json
import pickle
import shlex
import shutil
from collections import OrderedDict

import numpy as np
import pytest
import yaml
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

from tensegym.control.policy import load_policy
from tensegym.control.policy_file import read_arrays, read_policy
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.train.checkpoint import put_statistics, read_training
from tensegym.train.config import load_config
from tensegym.train.convert import Convert
from tensegym.train.ppo import _new_model
from tests.conftest import assert_refused


@pytest.fixture
def env():
    env = DummyVecEnv([lambda: RollingEnv(observation="onboard", settle=0.0)])
    yield env
    env.close()


def observations(env, count=5):
    size, rng = env.observation_space.shape[0], np.random.default_rng(0)
    return (rng.normal(size=(count, size)) * rng.choice([0.1, 1, 10], size=(count, 1))).astype(np.float32)


@pytest.mark.parametrize("normalised", [False, True])
def test_a_plain_policy_acts_as_it_did(env, normalised, tmp_path):
    if normalised:
        env = VecNormalize(env)
        env.obs_rms.mean[:], env.obs_rms.var[:] = 0.3, 2.0
    model = PPO("MlpPolicy", env, policy_kwargs={"net_arch": [8, 6]}, n_steps=4, batch_size=4, device="cpu", seed=3)
    model.save(tmp_path / "best_model.zip")
    if normalised:  # as the zoo lays it out
        (tmp_path / "tensegym").mkdir()
        env.save(tmp_path / "tensegym" / "vecnormalize.pkl")
    assert Convert(tmp_path, trust=True)() == [tmp_path]
    policy = load_policy(tmp_path)
    assert policy.env == {"observation": "onboard"}
    for seen in observations(env):
        given = env.normalize_obs(seen[None]) if normalised else seen[None]
        wanted, _ = model.predict(given, deterministic=True)
        np.testing.assert_allclose(policy(seen), wanted[0], rtol=1e-5, atol=1e-6)


def test_the_zoo_s_folder_says_which_environment_it_was(tmp_path):
    """As rl_zoo3 writes it: NAME_1 with zips of policies, NAME/{args.yml, config.yml, vecnormalize.pkl}.

    The robot with flexible rods is seen by as many values as the default one, so the length alone would not tell."""
    wanted = {"observation": "onboard", "design": "six_rod_flexible"}
    env = VecNormalize(DummyVecEnv([lambda: RollingEnv(**wanted, settle=0.0)]), norm_reward=False)
    model = PPO("MlpPolicy", env, n_steps=8, batch_size=8, n_epochs=1, device="cpu", seed=1)
    model.learn(8)
    name = "tensegym-SixRodRolling-v0"
    run = tmp_path / f"{name}_1"
    (run / name).mkdir(parents=True)
    arguments = OrderedDict(algo="ppo", env="tensegym/SixRodRolling-v0", env_kwargs=wanted, seed=1)
    (run / name / "args.yml").write_text(yaml.dump(arguments))
    (run / name / "config.yml").write_text(yaml.dump(OrderedDict(n_steps=8, normalize=True, policy="MlpPolicy")))
    env.save(run / name / "vecnormalize.pkl")
    for zipped in ("best_model.zip", f"{name}.zip"):
        model.save(run / zipped)
    Convert(run, trust=True)()
    policy = load_policy(run)
    assert policy.env == wanted
    env.training = False
    seen = env.reset()[0]
    action = model.predict(seen[None], deterministic=True)[0][0]
    np.testing.assert_allclose(policy(env.get_original_obs()[0]), action, rtol=1e-5, atol=1e-6)
    env.close()


def test_a_policy_of_another_exploration_is_refused(env, tmp_path):
    PPO("MlpPolicy", env, n_steps=4, batch_size=4, use_sde=True, device="cpu").save(tmp_path / "model.zip")
    with pytest.raises(InputError, match="use_sde = False"):
        Convert(tmp_path, trust=True)()


def test_other_policies_are_refused_before_anything_is_written(env, tmp_path):
    from torch import nn

    kept = {"activation_fn": nn.ReLU}
    PPO("MlpPolicy", env, n_steps=4, batch_size=4, policy_kwargs=kept, device="cpu").save(tmp_path / "model.zip")
    with pytest.raises(InputError, match="no policy of plain layers with tanh"):
        Convert(tmp_path, trust=True)()
    (tmp_path / "model.zip").write_bytes(b"PK no zip")
    with pytest.raises(InputError, match=r"model\.zip is no policy of PPO"):
        Convert(tmp_path / "model.zip", trust=True)()
    assert [path.name for path in tmp_path.iterdir()] == ["model.zip"]


@pytest.mark.parametrize("given", ["folder", "zip"])
@pytest.mark.parametrize("command", ["evaluate", "roll"])
def test_every_command_says_how_to_convert_it(command, given, env, tmp_path, cli, capsys):
    (tmp_path / "my model.zip").write_bytes(pickle.dumps(None))
    path = tmp_path if given == "folder" else tmp_path / "my model.zip"
    wanted = f"`python -m tensegym.train.convert --folder {shlex.quote(str(path))} --trust`"
    assert_refused(cli(command, "--policy", path, "--out", tmp_path / "out"), wanted)


def test_a_run_of_before_is_resumed_after_its_conversion(tiny_run, tmp_path, cli):
    run = tmp_path / "old"
    shutil.copytree(tiny_run, run)
    folder = run / "checkpoints" / "000000060"
    env = VecNormalize(DummyVecEnv([lambda: RollingEnv(observation="onboard", settle=0.1)]))
    model = _new_model(load_config(str(run / "config.yaml")), env, 7)
    read_training(model, env, folder, 6)
    before = read_policy(folder).weights, read_arrays(folder / "optimiser.npz")
    for each in (run, folder):  # as tensegym wrote it when it had no format of its own
        model.save(each / "model.zip")
        with (each / "vecnormalize.pkl").open("wb") as file:
            pickle.dump(env, file)
        for name in ("weights.npz", "policy.json", "optimiser.npz"):
            (each / name).unlink(missing_ok=True)
        (each / "state.json").write_text(json.dumps({"seed": 7, "steps": 60, "seconds": 1.0}))
    env.close()
    assert_refused(cli("train", "--resume", "--out", run, "--steps", 80), "has no 'updates'", "tensegym.train.convert")
    Convert(run, trust=True)()
    for wanted, found in zip(before, (read_policy(folder).weights, read_arrays(folder / "optimiser.npz")), strict=True):
        for name in wanted:
            np.testing.assert_array_equal(wanted[name], found[name])
    assert cli("train", "--resume", "--out", run, "--steps", 80)[0] == 0


def test_statistics_of_fewer_entries_fill_the_first():
    from stable_baselines3.common.running_mean_std import RunningMeanStd

    from tensegym.control.policy_file import Statistics

    running = RunningMeanStd(shape=(3,))
    put_statistics(running, Statistics(np.array([1.0, 2.0]), np.array([3.0, 4.0]), 9.0))
    np.testing.assert_array_equal(running.mean, [1, 2, 0])
    np.testing.assert_array_equal(running.var, [3, 4, 1])
