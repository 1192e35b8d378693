"""The policies that come with the package, on a few of the episodes that they are judged by."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tensegym.train.config import load_config
from tensegym.train.controllers import policy_controller, shipped
from tensegym.train.evaluate import FIRST_SEED
from tensegym.train.trials import run_trials

# rod lengths a second, of the median
BARS = {"rolling": 0.12, "onboard": 0.07, "carry": 0.2, "climb": 0.03, "steep": 0.03, "conditioned": 0.15}
ROBOTS = {"conditioned": policy_controller("carry").env}  # its own are drawn at random, and some of those cannot roll


@pytest.mark.parametrize("name", BARS)
def test_rolls_in_the_wanted_direction_without_sliding_or_free_energy(name):
    rows = run_trials(policy_controller(name), range(FIRST_SEED, FIRST_SEED + 6), env=ROBOTS.get(name), quiet=True)
    assert np.median([row["speed_lps"] for row in rows]) > BARS[name]
    assert np.median([row["slip_share"] for row in rows]) < 0.6
    assert np.median([row["tips"] for row in rows]) > 5
    assert all(row["audit_passed"] and not row["terminated"] for row in rows)


@pytest.mark.parametrize("name", BARS)
def test_comes_with_what_made_it(name):
    folder = shipped(name)
    trained = load_config(str(folder / "config.yaml"))
    assert replace(trained, steps=load_config(name).steps) == load_config(name)  # a run may have been gone on with
    assert f"tensegym train --config {name} --seed" in (folder / "COMMAND").read_text()
    assert len(json.loads((folder / "versions.json").read_text())["commit"]) == 40
    assert (folder / "curve.csv").read_text().startswith("steps,")
