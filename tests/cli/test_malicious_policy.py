"""A policy from a stranger under every command that takes one: nothing in it runs."""

import io
import json
import pickle
import re
import shutil
import zipfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from tensegym.control.policy import shipped
from tensegym.errors import InputError
from tensegym.train.convert import Convert
from tensegym.train.distil import Distil
from tests.conftest import assert_refused

SHIPPED = shipped("onboard")
SCENES = ("stable-baselines3", "pickle in the weights", "pickle for the weights", "names with paths", "settings",
          "a task that is code", "yaml tags", "links to nowhere", "a bomb", "numbers beyond all")  # fmt: skip


class Runs:
    """Leaves a mark where it is unpickled."""

    def __init__(self, mark):
        self.mark = mark

    def __reduce__(self):
        return Path.touch, (self.mark,)


@cache
def bomb():
    """Some hundred kB that unpack to 300 MB."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("log_std.npy", bytes(300 << 20))
    return file.getvalue()


@pytest.fixture(params=SCENES)
def stranger(request, tmp_path, monkeypatch):
    """A policy's folder that would leave a mark, and where."""
    folder, mark = tmp_path / "stranger", tmp_path / "ran"
    shutil.copytree(SHIPPED, folder)
    runs = pickle.dumps(Runs(mark))
    pickle.loads(runs)
    assert mark.exists()  # it would
    mark.unlink()
    if request.param == "stable-baselines3":
        for name in ("weights.npz", "policy.json"):
            (folder / name).unlink()
        (folder / "vecnormalize.pkl").write_bytes(runs)
        with zipfile.ZipFile(folder / "model.zip", "w") as archive:
            archive.writestr("data", "{}")
            archive.writestr("policy.pth", runs)
    elif request.param == "pickle in the weights":
        np.savez(folder / "weights.npz", log_std=np.array([Runs(mark)], dtype=object))
    elif request.param == "pickle for the weights":
        (folder / "weights.npz").write_bytes(runs)
    elif request.param == "names with paths":
        with zipfile.ZipFile(folder / "weights.npz", "a") as archive:
            archive.writestr("../../ran", b"x")
    elif request.param == "a task that is code":
        (tmp_path / "evil.py").write_text(f"open({str(mark)!r}, 'w')")
        monkeypatch.syspath_prepend(str(tmp_path))
        own = yaml.safe_load((folder / "config.yaml").read_text())
        own["env"]["task"] = {"motion": "evil:Task"}
        (folder / "config.yaml").write_text(yaml.safe_dump(own))
    elif request.param == "yaml tags":
        (folder / "config.yaml").write_text(f"env: !!python/object/apply:pathlib.Path.touch [{mark}]")
    elif request.param == "links to nowhere":
        for name in ("weights.npz", "policy.json", "config.yaml"):
            (folder / name).unlink()
            (folder / name).symlink_to(name)
    elif request.param == "a bomb":
        (folder / "weights.npz").write_bytes(bomb())
    elif request.param == "numbers beyond all":
        text = (folder / "policy.json").read_text()
        (folder / "policy.json").write_text(re.sub(r'"clip": [^,]*', '"clip": ' + "9" * 400, text))
    else:
        data = json.loads((folder / "policy.json").read_text())
        (folder / "policy.json").write_text(json.dumps(data | {"observations": str(tmp_path / "elsewhere.json")}))
    yield folder
    assert not mark.exists()
    assert not (tmp_path.parent / "ran").exists()


def config(tmp_path, **fields):
    path = tmp_path / "config.yaml"
    own = yaml.safe_load((SHIPPED / "config.yaml").read_text())
    path.write_text(yaml.safe_dump(own | {"start": None, "steps": 100} | fields))
    return path


@pytest.mark.parametrize("command", ["roll", "evaluate", "train", "resume", "design", "distil"])
def test_nothing_in_a_strangers_policy_runs(command, stranger, tmp_path, cli, request):
    out = tmp_path / "out"
    if "code" in request.node.name and command in ("train", "design"):
        return  # which give the policy a task of their own
    if command in ("roll", "evaluate"):
        result = cli(command, "--policy", stranger, "--out", out)
    elif command == "train":
        result = cli("train", "--config", config(tmp_path, start=str(stranger)), "--out", out)
    elif command == "resume":
        (stranger / "state.json").write_text(json.dumps({"seed": 0, "steps": 6400, "seconds": 1.0, "updates": 1}))
        checkpoint = stranger / "checkpoints" / "000006400"
        checkpoint.parent.mkdir()
        shutil.copytree(stranger, checkpoint, ignore=shutil.ignore_patterns("checkpoints"), symlinks=True)
        result = cli("train", "--resume", "--out", stranger)
    elif command == "design":
        (tmp_path / "task.toml").write_text(
            f'[task]\nmotion = "roll"\n[controller]\nkind = "policy"\npolicy = "{stranger}"\n'
            '[space]\n"design.elastic_cable.pretension" = {low = 5.0, high = 20.0}\n'
        )
        result = cli("design", "run", "--task", tmp_path / "task.toml", "--budget", 1, "--out", out)
    else:
        with pytest.raises((InputError, OSError)):
            Distil(str(stranger), out=out)()
        return
    assert_refused(result)


def test_a_policy_of_stable_baselines3_is_read_only_with_trust(tmp_path):
    for name in ("model.zip", "vecnormalize.pkl"):
        (tmp_path / name).write_bytes(pickle.dumps(Runs(tmp_path / "ran")))
    with pytest.raises(InputError, match="--trust"):
        Convert(tmp_path)()
    assert not (tmp_path / "ran").exists()


def test_a_folder_named_as_a_shipped_policy_is_not_taken_for_it(tmp_path, monkeypatch, cli):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rolling").mkdir()
    (tmp_path / "mine").mkdir()
    from tensegym.control.policy import policy_folder

    assert policy_folder("rolling") == shipped("rolling")
    with pytest.raises(FileNotFoundError, match=r"no policy 'mine': .*\./mine"):
        policy_folder("mine")


def test_a_module_named_in_a_training_config_is_not_imported(tmp_path, monkeypatch, cli):
    (tmp_path / "evil.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert_refused(cli("train", "--config", config(tmp_path, env_id="evil:Env-v0"), "--out", tmp_path / "out"),
                   "env_id = 'evil:Env-v0'")  # fmt: skip
    assert not (tmp_path / "ran").exists()
