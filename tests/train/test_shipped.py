"""The policies that come with the package, on a few of the episodes that they are judged by."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tensegym.control.policy import shipped
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.trials import run_trials
from tensegym.train.config import load_config

# rod lengths a second, of the median
BARS = {"rolling": 0.12, "onboard": 0.07, "carry": 0.2, "climb": 0.03, "steep": 0.03, "conditioned": 0.15}


@pytest.mark.parametrize("name", BARS)
def test_rolls_in_the_wanted_direction_without_sliding_or_free_energy(name):
    setup = policy_setup(name)
    if name == "conditioned":  # its own robots are drawn at random, and some of those cannot roll
        setup = replace(setup, design=policy_setup("carry").design, vary=None)
    results = run_trials(setup, range(FIRST_SEED, FIRST_SEED + 6), quiet=True)
    assert np.median([result.gait.speed_lps for result in results]) > BARS[name]
    assert np.median([result.gait.slip_share for result in results]) < 0.6
    assert np.median([result.gait.tips for result in results]) > 5
    assert all(result.sound for result in results)


@pytest.mark.parametrize("name", BARS)
def test_comes_with_what_made_it(name):
    folder = shipped(name)
    trained = load_config(str(folder / "config.yaml"))
    assert replace(trained, steps=load_config(name).steps) == load_config(name)  # a run may have been gone on with
    assert f"tensegym train --config {name} --seed" in (folder / "COMMAND").read_text()
    assert len(json.loads((folder / "versions.json").read_text())["commit"]) == 40
    assert (folder / "curve.csv").read_text().startswith("steps,")
