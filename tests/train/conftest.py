"""A training that takes seconds, shared by the tests of this folder."""

import pytest
import yaml

from tensegym.cli.main import run

TINY = {
    "env": {"observation": "onboard", "settle": 0.1},
    "episode_seconds": 2.0,
    "n_envs": 2,
    "rollout": 10,
    "chunk": 1,
    "steps": 60,
    "batch_size": 10,
    "n_epochs": 2,
    "hidden": [8],
}


@pytest.fixture(scope="session")
def tiny_config(tmp_path_factory):
    path = tmp_path_factory.mktemp("config") / "tiny.yaml"
    path.write_text(yaml.safe_dump(TINY))
    return path


@pytest.fixture(scope="session")
def tiny_run(tmp_path_factory, tiny_config):
    """Folder of a finished training of three chunks."""
    out = tmp_path_factory.mktemp("runs") / "whole"
    assert run(["train", "--config", str(tiny_config), "--out", str(out), "--seed", "7"]) == 0
    return out
