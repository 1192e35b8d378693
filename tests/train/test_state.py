"""state.json of a training: read in full or refused in one line, and so is what else a resumption reads."""

import json
import shutil

import numpy as np
import pytest
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

from tensegym.control.policy_file import read_arrays, write_arrays
from tensegym.errors import InputError
from tensegym.train.checkpoint import read_training
from tensegym.train.config import load_config
from tensegym.train.ppo import _new_model, make_env
from tensegym.train.state import TrainState, read_state, write_state
from tests.conftest import assert_refused

WHOLE = {"seed": 7, "steps": 60, "seconds": 1.5, "updates": 6}


def test_a_state_is_read_as_it_was_written(tmp_path):
    state = TrainState(7, 60, 1.5, 6, (40, 60))
    write_state(state, tmp_path)
    assert read_state(tmp_path) == state


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"updates": None}, r"state\.json has no 'updates'.*tensegym\.train\.convert"),
        ({"updates": -1}, r"updates = -1 is outside \[0"),
        ({"seed": None}, "no 'seed'"),
        ({"seed": 1.5}, "seed = 1.5 is no whole number"),
        ({"steps": "60"}, "steps = '60'"),
        ({"steps": 10**13}, "steps = 10000000000000 is outside"),
        ({"seconds": float("nan")}, "seconds = nan is no finite number"),
        ({"stages": 3}, "stages = 3 must be a list"),
        ({"more": 3}, "unknown field 'more'"),
        ({"version": 2}, "is of version 2"),
    ],
)
def test_a_state_that_is_none_is_refused(changes, words, tmp_path):
    (tmp_path / "state.json").write_text(json.dumps({k: v for k, v in (WHOLE | changes).items() if v is not None}))
    with pytest.raises(InputError, match=words):
        read_state(tmp_path)


def rewrite(path, **arrays):
    """Arrays of an npz replaced, or taken away by None."""
    found = {name: array for name, array in (read_arrays(path) | arrays).items() if array is not None}
    write_arrays(found, path)


DAMAGE = {
    "steps = 40": lambda run, last: (last / "state.json").write_text(json.dumps(WHOLE | {"steps": 40})),
    "no state.json": lambda run, last: (last / "state.json").unlink(),
    "the header must be steps,": lambda run, last: (run / "curve.csv").write_text("steps,speed\n20,0.1\n"),
    "line 2: steps = 'x' is no number": lambda run, last: (run / "curve.csv").write_text(
        (run / "curve.csv").read_text().replace("20,", "x,", 1)),
    "Unexpected key": lambda run, last: rewrite(last / "weights.npz", more=np.zeros(3)),
}  # fmt: skip


@pytest.mark.parametrize("words", DAMAGE)
def test_a_training_with_a_broken_file_is_not_resumed_and_stays_as_it_is(words, tiny_run, tmp_path, cli):
    run = tmp_path / "run"
    shutil.copytree(tiny_run, run)
    DAMAGE[words](run, run / "checkpoints" / "000000060")
    before = (run / "curve.csv").read_bytes(), (run / "weights.npz").read_bytes()
    assert_refused(cli("train", "--resume", "--out", run, "--steps", 80), words)
    assert ((run / "curve.csv").read_bytes(), (run / "weights.npz").read_bytes()) == before


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"x": np.zeros(1)}, "'x', of no parameter"),
        ({"99.step": np.zeros(())}, "'99.step', of no parameter"),
        ({"0.exp_avg": np.zeros(3)}, r"'0.exp_avg' of shape \(3,\) is no moment of a parameter of \(6,\)"),
        ({"0.more": np.zeros(())}, "'0.more' .* is no moment"),
        ({"0.step": None}, "lacks moments of parameter 0"),
        ({"0.step": np.array(-1.0)}, "is below 0"),
    ],
)
def test_moments_of_another_optimiser_are_refused(arrays, words, tiny_run, tmp_path):
    folder = tmp_path / "last"
    shutil.copytree(tiny_run / "checkpoints" / "000000060", folder)
    config = load_config(str(tiny_run / "config.yaml"))
    env = VecNormalize(DummyVecEnv([lambda: make_env(config)]))
    model = _new_model(config, env, 7)
    read_training(model, env, folder, 6)
    rewrite(folder / "optimiser.npz", **arrays)
    with pytest.raises(InputError, match=words):
        read_training(model, env, folder, 6)
    env.close()


def test_a_checkpoint_that_leads_to_a_device_is_refused(tmp_path):
    """Which would be read for ever."""
    (tmp_path / "weights.npz").symlink_to("/dev/zero")
    with pytest.raises(InputError, match="is no file"):
        read_arrays(tmp_path / "weights.npz")
