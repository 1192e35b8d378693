"""Readers of what commands keep in folders: policies, trainings, searches; one file of each is damaged."""

import functools
import io
import json
import shutil
import sqlite3
import tempfile
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import yaml

TASK = """
[task]
motion = "roll"
seconds = 0.4
settle = 0.1
dt = 0.004
[controller]
amplitudes = [0.5, 0.5]
[space]
"design.elastic_cable.pretension" = {low = 5.0, high = 20.0, log = true}
"design.payload.two_way" = {choices = [false, true]}
[design.payload]
[search]
sampler = "random"
batch = 3
episodes = 2
constraints = ["slip_share <= 0.3"]
"""
CONFIG = {"env": {"observation": "onboard", "settle": 0.0}, "hidden": [2], "n_envs": 1, "rollout": 10, "batch_size": 10}
CURVE = ("steps,hours,episodes,speed_lps,speed_lps_p10,slip_share,tips,audit_excess,action_std,goal\n"
         "20,0.1,4,0.1,0.05,0.2,3,0,0.9,0.1\n40,0.2,4,0.2,nan,0.2,3,0,0.9,0.2\n")  # fmt: skip


@functools.cache
def policy() -> dict[str, bytes]:
    """Files of a small policy, by name."""
    from tensegym.control.policy import shipped
    from tensegym.control.policy_file import read_policy, write_policy

    whole = read_policy(shipped("onboard"))
    n, w = whole.observation_bounds.shape[1], whole.action_bounds.shape[1]
    sizes = {"actor": (n, 2, w), "critic": (n, 2, 1)}
    weights = {name: array for name, array in whole.weights.items() if not {"actor", "critic"} & set(name.split("."))}
    for network, widths in sizes.items():
        for k, (width, after) in enumerate(pairwise(widths)):
            weights[f"mlp_extractor.{network}.{2 * k}.weight"] = np.full((after, width), 0.1, np.float32)
            weights[f"mlp_extractor.{network}.{2 * k}.bias"] = np.zeros(after, np.float32)
    folder = Path(tempfile.mkdtemp())
    write_policy(replace(whole, weights=weights), folder)
    (folder / "config.yaml").write_text(yaml.safe_dump(CONFIG))
    found = {path.name: path.read_bytes() for path in folder.iterdir()}
    shutil.rmtree(folder)
    return found


def put(files: dict[str, bytes], folder: Path) -> None:
    for name, content in files.items():
        (folder / name).write_bytes(content)


def read_policy_folder(path: Path) -> Any:
    """As a command does, and one action of it."""
    from tensegym.control.policy import PolicyController
    from tensegym.tasks.policy_trials import policy_setup

    own = PolicyController(f"{path.parent}/")
    policy_setup(f"{path.parent}/")
    assert np.isfinite(own.policy(np.zeros(own.policy.observed, np.float32))).all()


def from_npz(content: bytes) -> Any:
    with np.load(io.BytesIO(content)) as file:
        return {name: file[name].tolist() for name in file.files}


def to_npz(tree: Any) -> bytes:
    """As NumPy writes it, objects as pickles."""
    file = io.BytesIO()
    try:
        np.savez(file, **{str(name) or "empty": np.array(value) for name, value in dict(tree).items()})
    except (ValueError, OverflowError, TypeError, KeyError):
        return b"no such arrays"
    return file.getvalue()


# -- a training --------------------------------------------------------------------------------------------------------


@functools.cache
def _learner() -> tuple[Any, Any]:
    """A model and its environments, small enough to be made at once."""
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    from tensegym.train.config import TrainConfig
    from tensegym.train.ppo import _new_model, make_env

    config = TrainConfig(**{**CONFIG, "hidden": (2,)})
    env = VecNormalize(DummyVecEnv([lambda: make_env(config)]))
    return _new_model(config, env, 0), env


@functools.cache
def training() -> dict[str, bytes]:
    """Files of a checkpoint of 40 steps."""
    import torch

    from tensegym.train.checkpoint import write_training
    from tensegym.train.state import TrainState, write_state

    model, env = _learner()
    optimiser = model.policy.optimizer
    for parameter in model.policy.parameters():
        parameter.grad = torch.ones_like(parameter)
    optimiser.step()
    folder = Path(tempfile.mkdtemp())
    write_training(model, env, folder)
    write_state(TrainState(7, 40, 1.5, 4, (20, 40)), folder)
    found = {path.name: path.read_bytes() for path in folder.iterdir()}
    shutil.rmtree(folder)
    return found


def resume(path: Path) -> Any:
    """Read all that resuming a training reads, ``path`` in place of one of its files."""
    from tensegym.train.checkpoint import checkpoint_folder, go_back, last_state, read_training

    folder = path.parent / "run"
    kept = folder / "checkpoints" / "000000040"
    kept.mkdir(parents=True, exist_ok=True)
    put(training(), kept)
    (folder / "curve.csv").write_text(CURVE)
    shutil.copy(path, folder if path.name == "curve.csv" else kept)
    state = last_state(folder)
    model, env = _learner()
    read_training(model, env, checkpoint_folder(folder, state.steps), state.updates)
    go_back(folder, state)


# -- a search ----------------------------------------------------------------------------------------------------------


@functools.cache
def study() -> bytes:
    """A database with three trials, one of them refused."""
    from tensegym.search.asker import Asker
    from tensegym.search.evaluate import TrialResult
    from tensegym.search.problem import problem_from
    from tensegym.search.store import Store

    folder, problem = Path(tempfile.mkdtemp()), problem_from(TASK, "fuzz")
    store, asker = Store(folder, problem), Asker(problem)
    store.note("budget", 3)
    values = [*asker.ask(), *asker.ask()]
    metrics = dict.fromkeys(problem.task.metrics(), 0.25) | {"sound": 1.0}
    for number in range(3):
        refused = "it came apart" if number == 1 else None
        store.add(asker, values[number], TrialResult(number, metrics if refused is None else {}, 2, False, refused))
    store._study._storage._backend.engine.dispose()
    with sqlite3.connect(folder / "study.db") as database:
        database.execute("PRAGMA journal_mode=DELETE")
    content = (folder / "study.db").read_bytes()
    shutil.rmtree(folder)
    return content


def from_sqlite(content: bytes) -> Any:
    """Rows by table, the JSON texts among them as trees."""
    with sqlite3.connect(":memory:") as database:
        database.deserialize(content)
        tables = [name for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        return {name: [[_tree(cell) for cell in row] for row in database.execute(f"SELECT * FROM {name}")]
                for name in tables}  # fmt: skip


def _tree(cell: Any) -> Any:
    try:
        found = json.loads(cell)
    except (TypeError, ValueError):
        return cell
    return {"json": found}


def to_sqlite(tree: Any) -> bytes:
    """The database with these rows in place of its own, as far as its tables take them."""
    with sqlite3.connect(":memory:") as database:
        database.deserialize(study())
        for name in from_sqlite(study()):
            try:
                rows = [[_cell(cell) for cell in row] for row in tree.get(name, [])]
                database.execute(f"DELETE FROM {name}")
                for row in rows:
                    database.execute(f"INSERT INTO {name} VALUES ({','.join('?' * len(row))})", row)
            except (sqlite3.Error, TypeError, ValueError, OverflowError, RecursionError, AttributeError):
                continue
        database.commit()
        return database.serialize()


def _cell(cell: Any) -> Any:
    if isinstance(cell, dict):
        return json.dumps(cell.get("json", cell), default=str)
    return cell if isinstance(cell, int | float | str | bytes | None) else json.dumps(cell, default=str)


def read_study(path: Path) -> Any:
    """As status and report do."""
    from tensegym.cli.design import Status, open_search
    from tensegym.search.report import objective_values
    from tensegym.search.winner import losses_of

    with tempfile.TemporaryDirectory() as folder:  # a file of its own each time: SQLite knows those that are open
        shutil.copy(path, folder)
        (Path(folder) / "storage.txt").write_text("")
        problem, store = open_search(Path(folder))
        Status(Path(folder)).run()
        objective_values(problem, store.finished()), losses_of(problem, store.finished()), store.seconds()
        for values, _ in store.finished().values():
            problem.space.apply(values)


def read_storage(path: Path) -> Any:
    """Where a search is kept, as its folder says."""
    from tensegym.cli.design import open_search

    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(path, folder)
        (Path(folder) / "study.db").write_bytes(study())
        open_search(Path(folder))
