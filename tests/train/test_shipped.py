"""The policies that come with the package, on a few of the episodes that their table in the docs is made of."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tensegym.control.policy import shipped
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.trials import run_trials
from tensegym.train.config import load_config

PAGE = Path(__file__).parents[2] / "docs" / "training.md"
ROWS = re.findall(r"^\| `(\w+)`([^|]*)\| ([\d.]+) \|", PAGE.read_text(), re.MULTILINE)
FIGURES = {name: float(median) for name, what, median in ROWS if "half the time step" not in what}
"""Median speed of each policy over a hundred episodes [rod lengths a second], as the page has it."""
HELD = 0.85
SEEDS = range(FIRST_SEED + 58, FIRST_SEED + 70)  # the twelve in a row whose medians come nearest to the hundreds'
FALLS = {"three_rod": 1}  # of the twelve, flat on the ground, which make no way; 11 of the hundred: docs/structures.md
POLICIES = sorted(p.name for p in shipped("rolling").parent.iterdir() if (p / "config.yaml").is_file())


def test_every_shipped_policy_has_its_figure():
    assert sorted(FIGURES) == POLICIES


@pytest.mark.parametrize("name", POLICIES)
def test_holds_its_figure_without_sliding_or_free_energy(name):
    results = run_trials(policy_setup(name), SEEDS, quiet=True)
    assert all(result.gait.audit_passed and not result.diverged for result in results)
    assert sum(result.fallen for result in results) <= FALLS.get(name, 0)
    assert np.median([result.scores()["speed_lps"] for result in results]) >= HELD * FIGURES[name]
    assert np.median([result.gait.slip_share for result in results]) < 0.3
    assert np.median([result.gait.tips for result in results]) > 10


@pytest.mark.parametrize("name", POLICIES)
def test_comes_with_what_made_it(name):
    folder = shipped(name)
    trained = load_config(str(folder / "config.yaml"))
    assert replace(trained, steps=load_config(name).steps) == load_config(name)  # a run may have been gone on with
    assert f"tensegym train --config {name} --seed" in (folder / "COMMAND").read_text()
    assert len(json.loads((folder / "versions.json").read_text())["commit"]) == 40
    assert (folder / "curve.csv").read_text().startswith("steps,")
