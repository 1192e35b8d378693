"""The generator's feedback, fitted to a policy of a robot whose drives are all of one kind."""

import tomllib

import numpy as np
import pytest

from tensegym.control.cpg import TERMS
from tensegym.search.evaluate import TrialSpec, run_trial
from tensegym.search.problem import load_problem
from tensegym.train.distil import Distil, fit


def test_weights_of_one_kind_of_drives_come_of_a_policy_and_in_later_rounds_of_the_generator_too(tmp_path, monkeypatch):
    out = tmp_path / "feedback.toml"
    monkeypatch.setattr("tensegym.train.distil.EPISODE_SECONDS", 2.0)
    Distil("four_rod", rounds=2, episodes=1, out=out)()
    assert np.shape(tomllib.loads(out.read_text())["feedback"]) == (1, TERMS)


def test_weights_are_found_again():
    rng = np.random.default_rng(0)
    terms, weights, kinds = rng.normal(size=(60, 3, TERMS)), rng.normal(size=(2, TERMS)), np.array([0, 1, 0])
    np.testing.assert_allclose(fit(terms, (terms * weights[kinds]).sum(axis=2), kinds), weights, atol=1e-9)


@pytest.mark.parametrize("prism", [0, 2, 3], ids=["three rods", "four rods", "five rods"])
def test_the_search_prism_begins_with_weights_that_roll_its_robots(prism):
    """They were fitted on four rods; on the same springs without them the oscillators alone make no such way."""
    problem = load_problem("prism")
    body = {"design.structure": prism, "design.elastic_cable.stiffness": 742.0, "design.drive.gear_ratio": 14.0,
            "design.cables.upright.stiffness": 500.0, "design.stiff_cable.max_pull": 0.5}  # fmt: skip
    tables = problem.space.apply(problem.space.start | body)
    none = tables["controller"] | {"feedback": [0.0] * TERMS}
    rolled, stood = (
        run_trial(TrialSpec(0, tables["design"], controller, problem.task, (200, 201, 203))).metrics["speed_lps"]
        for controller in (tables["controller"], none)
    )
    assert rolled > 0.2
    assert abs(stood) < rolled / 5
