"""Training: what a run leaves behind, and that killing and resuming it changes nothing."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import yaml

import tensegym
from tensegym.control.policy import load_policy
from tensegym.control.policy_file import read_arrays, read_policy
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.tasks.reward import RewardWeights
from tensegym.train.ship import Ship
from tensegym.train.state import read_state
from tests.conftest import assert_refused

STEPS = 20  # a chunk of the tiny training


def learned(run):
    """Everything a training's next step depends on: weights, optimiser, running statistics, curve without clocks."""
    saved = read_policy(run)
    newest = max((run / "checkpoints").iterdir())
    with (run / "curve.csv").open() as file:
        curve = [{k: v for k, v in row.items() if k != "hours"} for row in csv.DictReader(file)]
    moments = [array for _, array in sorted(read_arrays(newest / "optimiser.npz").items())]
    statistics = [value for each in (saved.observations, saved.returns) for value in vars(each).values()]
    return saved.weights, moments, statistics, curve


def assert_same(one, two):
    for first, second in zip(learned(one)[:3], learned(two)[:3], strict=True):
        pairs = first.items() if isinstance(first, dict) else enumerate(first)
        for key, value in pairs:
            np.testing.assert_array_equal(value, second[key])
    assert learned(one)[3] == learned(two)[3]


def test_a_run_leaves_model_statistics_curve_config_and_versions(tiny_run):
    config = yaml.safe_load((tiny_run / "config.yaml").read_text())
    assert config["env"] == {"observation": "onboard", "settle": 0.1}
    assert config["hidden"] == [8]
    assert json.loads((tiny_run / "versions.json").read_text())["torch"] == version("torch")
    state = json.loads((tiny_run / "state.json").read_text())
    assert (state["seed"], state["steps"]) == (7, 3 * STEPS)
    with (tiny_run / "curve.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [int(row["steps"]) for row in rows] == [STEPS, 2 * STEPS, 3 * STEPS]
    assert all(int(row["episodes"]) == 4 for row in rows)  # 2 environments, 10 steps each, episodes of 5
    assert all(np.isfinite([float(value) for value in row.values()]).all() for row in rows)
    assert {p.name for p in (tiny_run / "checkpoints").iterdir()} == {f"{n * STEPS:09d}" for n in (1, 2, 3)}
    assert (tiny_run / "curve.png").read_bytes().startswith(b"\x89PNG")
    assert list((tiny_run / "tensorboard").glob("events.*"))
    assert not list(tiny_run.rglob(".tensegym-*"))


def test_weights_and_statistics_move_with_every_chunk(tiny_run):
    seen = []
    for folder in sorted((tiny_run / "checkpoints").iterdir()):
        saved = read_policy(folder)
        assert read_state(folder).steps == int(folder.name)
        seen.append((saved.layers("actor")[0][0], saved.observations.count))
    assert all(np.abs(a[0] - b[0]).max() > 0 and b[1] > a[1] for a, b in pairwise(seen))


def test_a_run_killed_in_its_second_chunk_and_resumed_equals_one_that_was_not(tiny_run, tiny_config, tmp_path, cli):
    out = tmp_path / "killed"
    code = "from tensegym.cli.main import main; main()"
    arguments = ["train", "--config", str(tiny_config), "--out", str(out), "--seed", "7"]
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip
    while not (out / "checkpoints" / f"{STEPS:09d}").is_dir():
        assert process.poll() is None
        time.sleep(0.002)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert not (out / "checkpoints" / f"{3 * STEPS:09d}").exists()

    status, _, _ = cli("train", "--resume", "--out", out)
    assert status == 0
    assert_same(out, tiny_run)


def test_a_run_that_ends_early_on_a_schedule_equals_the_first_part_of_the_whole(tiny_run, tiny_config, tmp_path, cli):
    """What was stopped because it was good enough is made again by a config with that end and the same schedule."""
    config = yaml.safe_load(tiny_config.read_text()) | {"steps": 2 * STEPS, "schedule": 3 * STEPS}
    (tmp_path / "early.yaml").write_text(yaml.safe_dump(config))
    early = tmp_path / "early"
    assert cli("train", "--config", tmp_path / "early.yaml", "--out", early, "--seed", "7")[0] == 0
    ends = [read_policy(folder / "checkpoints" / f"{2 * STEPS:09d}") for folder in (early, tiny_run)]
    for name, value in ends[0].weights.items():
        np.testing.assert_array_equal(value, ends[1].weights[name])
    (tmp_path / "early.yaml").write_text(yaml.safe_dump(config | {"schedule": STEPS}))
    refused = cli("train", "--config", tmp_path / "early.yaml", "--out", tmp_path / "none")
    assert_refused(refused, f"schedule = {STEPS}", f"{2 * STEPS} steps")
    assert not (tmp_path / "none").exists()


def test_steps_are_rounded_up_to_whole_updates_and_no_further(tiny_config, tmp_path, cli):
    """An update is of 20 steps and a chunk of one of them here; of two, the last one is cut short."""
    config = yaml.safe_load(tiny_config.read_text()) | {"chunk": 2, "steps": 50}
    (tmp_path / "c.yaml").write_text(yaml.safe_dump(config))
    status, _, told = cli("train", "--config", tmp_path / "c.yaml", "--out", tmp_path / "run")
    assert status == 0
    assert "50 steps are asked for; it will be 60, whole updates of 20" in told
    assert {p.name for p in (tmp_path / "run" / "checkpoints").iterdir()} == {"000000040", "000000060"}


def test_a_kill_amid_writing_is_resumed_from_the_last_whole_checkpoint(tiny_run, tmp_path, cli):
    """The curve is a row ahead, a checkpoint is half written, and the run's copies are of two different ones."""
    out = tmp_path / "torn"
    shutil.copytree(tiny_run, out)
    second, third = (out / "checkpoints" / f"{n * STEPS:09d}" for n in (2, 3))
    third.rename(half := out / "checkpoints" / f".tensegym-1-{third.name}")
    (half / "state.json").unlink()
    (out / "weights.npz").write_bytes((out / "weights.npz").read_bytes()[:100])
    shutil.copy(second / "state.json", out / "state.json")

    status, output, _ = cli("train", "--resume", "--out", out, "--json")
    assert status == 0
    assert json.loads(output)["steps"] == 3 * STEPS
    assert_same(out, tiny_run)


def test_a_kill_before_the_first_checkpoint_starts_again(tiny_run, tmp_path, cli):
    out = tmp_path / "young"
    out.mkdir()
    for name in ("config.yaml", "versions.json"):
        shutil.copy(tiny_run / name, out / name)
    (out / "curve.csv").write_text((tiny_run / "curve.csv").read_text().splitlines()[0] + "\n")
    (out / "state.json").write_text(json.dumps({"seed": 7, "steps": 0, "seconds": 0.0}))
    assert cli("train", "--resume", "--out", out)[0] == 0
    assert_same(out, tiny_run)


def test_a_finished_run_goes_on_with_a_longer_schedule_and_says_so(tiny_run, tmp_path, cli, monkeypatch):
    run = tmp_path / "longer"
    shutil.copytree(tiny_run, run)
    assert_refused(cli("train", "--resume", "--out", run, "--steps", 3 * STEPS), "steps = 60", "above the 60")
    assert cli("train", "--resume", "--out", run, "--steps", 4 * STEPS)[0] == 0
    assert yaml.safe_load((run / "config.yaml").read_text())["steps"] == 4 * STEPS
    state = json.loads((run / "state.json").read_text())
    assert (state["steps"], state["stages"]) == (4 * STEPS, [3 * STEPS, 4 * STEPS])
    monkeypatch.setattr("tensegym.train.ship.shipped", lambda name: tmp_path / name)
    shipped = Ship(run, "tiny")()
    first, second, _ = (shipped / "COMMAND").read_text().splitlines()
    assert first == "tensegym train --config tiny --seed 7"
    assert second.endswith(f"--steps {4 * STEPS}")
    env = RollingEnv(**yaml.safe_load((shipped / "config.yaml").read_text())["env"])
    observation, _ = env.reset(seed=0)
    np.testing.assert_array_equal(load_policy(shipped)(observation), load_policy(run)(observation))
    env.close()


def test_an_unfinished_run_is_not_shipped(tiny_run, tmp_path):
    run = tmp_path / "cut"
    shutil.copytree(tiny_run, run)
    (run / "state.json").write_text(json.dumps({"seed": 7, "steps": STEPS, "seconds": 1.0, "updates": 2}))
    with pytest.raises(InputError, match="stands at 20 of 60 steps"):
        Ship(run, "tiny")()


def test_another_seed_learns_something_else(tiny_run, tiny_config, tmp_path, cli):
    out = tmp_path / "other"
    assert cli("train", "--config", tiny_config, "--out", out, "--seed", "8", "--steps", STEPS)[0] == 0
    first = read_policy(tiny_run / "checkpoints" / f"{STEPS:09d}").weights
    other = read_policy(out).weights
    assert any((first[name] != other[name]).any() for name in first)
    assert yaml.safe_load((out / "config.yaml").read_text())["steps"] == STEPS


def test_resuming_nothing_is_refused(tmp_path, cli):
    assert_refused(cli("train", "--resume", "--out", tmp_path / "none"), "nothing to resume", "state.json")
    assert not (tmp_path / "none").exists()


def test_a_folder_in_use_is_refused(tiny_run, tiny_config, cli):
    before = sorted(p.name for p in tiny_run.iterdir())
    assert_refused(cli("train", "--config", tiny_config, "--out", tiny_run), "is not empty", "--resume")
    assert sorted(p.name for p in tiny_run.iterdir()) == before


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("env: {observatoin: full}", ["observatoin"]),
        ("env_id: tensegym/Nothing-v0", ["tensegym/Nothing-v0"]),
        ("env: {control_period: 0}", ["control_period"]),
        ("env: {reward: {slip: -1}}", ["reward.slip = -1"]),
        ("env: 3", ["env = 3", "must be a table"]),
        ("stepss: 3", ["unknown field 'stepss'"]),
        ("steps: 1.5", ["steps = 1.5", "whole number"]),
        ("n_envs: 0", ["n_envs = 0"]),
        ("learning_rate: 4e-4", ["learning_rate = '4e-4'", "1.0e-4"]),
        ("gamma: 1.5", ["gamma = 1.5", "(0, 1]"]),
        ("hidden: 8.5", ["hidden = 8.5 must be a list"]),
        ("hidden: [8.5]", ["hidden[1] = 8.5"]),
        ("batch_size: 2000", ["batch_size = 2000", "800"]),
        ("target_kl: soon", ["target_kl = 'soon'"]),
        ("- 1", ["must be a table of fields"]),
        ("a: [", ["is not YAML"]),
    ],
)
def test_a_bad_config_is_refused_and_nothing_is_written(text, words, tmp_path, cli):
    (tmp_path / "bad.yaml").write_text(text)
    assert_refused(cli("train", "--config", tmp_path / "bad.yaml", "--out", tmp_path / "run"), *words)
    assert [p.name for p in tmp_path.iterdir()] == ["bad.yaml"]


def test_a_missing_or_unknown_config_and_no_steps_are_refused(tmp_path, cli):
    out = tmp_path / "run"
    assert_refused(cli("train", "--config", tmp_path / "none.yaml", "--out", out), "none.yaml")
    assert_refused(cli("train", "--config", "rollin", "--out", out), "unknown training config 'rollin'", "rolling")
    assert_refused(cli("train", "--steps", "0", "--out", out), "steps = 0")
    assert not out.exists()


CONFIGS = sorted(path.stem for path in Path(tensegym.__file__).parent.glob("train/configs/*.yaml"))


@pytest.mark.parametrize("name", CONFIGS)
def test_the_committed_configs_are_sound(name):
    from tensegym.train.config import load_config
    from tensegym.train.ppo import make_env

    config = load_config(name)
    env = make_env(config)
    assert env.spec.max_episode_steps * config.env["control_period"] == pytest.approx(config.episode_seconds)
    assert config.rollout_steps % config.batch_size == 0
    weights, usual = env.unwrapped.task.reward, RewardWeights()  # the shipped policies learned by what gym.make weighs
    assert weights.changed({"slip": usual.slip}) == usual
    assert weights.slip >= usual.slip  # prisms pay more
    env.close()


# -- starting from a trained policy ------------------------------------------------------------------------------------

VARY = {"elastic_cable.stiffness": {"low": 200.0, "high": 800.0}}


def started(tmp_path, tiny_config, start, **changes):
    """A config file of the tiny training that starts from a policy."""
    data = yaml.safe_load(tiny_config.read_text())
    env = {**data["env"], **changes.pop("env", {})}
    path = tmp_path / "started.yaml"
    path.write_text(yaml.safe_dump({**data, "start": str(start), "env": env, **changes}))
    return path


def test_a_training_begins_as_the_policy_it_starts_from(tmp_path, tiny_config, tiny_run, cli):
    # at a vanishing learning rate it also ends as that policy, and sees nothing of the design
    config = started(tmp_path, tiny_config, tiny_run, steps=STEPS, learning_rate=1e-12, final_learning_rate=1e-12,
                     start_std=0.25, env={"vary": VARY})  # fmt: skip
    assert cli("train", "--config", config, "--out", tmp_path / "run")[0] == 0
    np.testing.assert_allclose(np.exp(read_policy(tmp_path / "run").weights["log_std"]), 0.25, rtol=1e-5)
    before, after = load_policy(tiny_run), load_policy(tmp_path / "run")
    with RollingEnv(**yaml.safe_load(config.read_text())["env"]) as env:
        observation, _ = env.reset(seed=1)
    assert np.abs(before(observation[:-1])).max() > 1e-6
    # the running statistics have moved by the few steps of this run
    np.testing.assert_allclose(after(observation), before(observation[:-1]), atol=0.02)
    other = observation.copy()
    other[-1] = -other[-1]
    np.testing.assert_allclose(after(other), after(observation), atol=1e-9)


def test_a_training_with_a_memory_begins_as_one_without(tmp_path, tiny_config, tiny_run, cli):
    config = started(tmp_path, tiny_config, tiny_run, steps=STEPS, learning_rate=1e-12, final_learning_rate=1e-12,
                     env={"observation": "onboard-memory"})  # fmt: skip
    assert cli("train", "--config", config, "--out", tmp_path / "run")[0] == 0
    before, after = load_policy(tiny_run), load_policy(tmp_path / "run")
    with RollingEnv(**yaml.safe_load(config.read_text())["env"]) as env:
        env.reset(seed=1)
        observation = env.step(env.action_space.sample())[0]
    now = observation[: len(observation) // 3]
    assert np.abs(before(now)).max() > 1e-6
    np.testing.assert_allclose(after(observation), before(now), atol=0.02)


@pytest.mark.parametrize(
    ("changes", "word"),
    [({"env": {"observation": "full"}}, "full"), ({"hidden": [9]}, "[9]"),
     ({"env": {"design": {"structure": {"stiff_cables": [[3, 7], [4, 9]]}}}}, "(2,)")],
)  # fmt: skip
def test_a_start_that_does_not_fit_is_refused(tmp_path, tiny_config, tiny_run, cli, changes, word):
    config = started(tmp_path, tiny_config, tiny_run, **changes)
    assert_refused(cli("train", "--config", config, "--out", tmp_path / "run"), "start = ", word)
    assert not (tmp_path / "run").exists()


def test_a_start_there_is_not_is_refused(tmp_path, tiny_config, cli):
    config = started(tmp_path, tiny_config, tmp_path / "nowhere")
    assert_refused(cli("train", "--config", config, "--out", tmp_path / "run"), "nowhere")
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("name", ["../rolling", "a/b", "/tmp", "", ".", "Rolling", "walker"])
def test_ship_replaces_nothing_but_a_policy(name, tiny_run):
    with pytest.raises(InputError, match=r"name = '.*' (must be|is taken)"):
        Ship(tiny_run, name)()
