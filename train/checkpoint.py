"""Checkpoints of a training: whole or not there, whenever it is killed, and nothing in them can run."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.running_mean_std import RunningMeanStd
from stable_baselines3.common.vec_env import VecNormalize

from tensegym.control.policy_file import (
    SETTINGS,
    WEIGHTS,
    SavedPolicy,
    Statistics,
    read_arrays,
    read_policy,
    write_arrays,
    write_policy,
)
from tensegym.errors import InputError
from tensegym.files import read_json, replace_file, replace_path, write_json

OPTIMISER = "optimiser.npz"  # Adam's moments, as NUMBER.NAME of the parameters in their order


def write_checkpoint(model: PPO, env: VecNormalize, out: Path, state: dict[str, Any]) -> None:
    """Write beside, then move: a kill leaves the old checkpoint or the new one, never half of one."""
    keep = checkpoint_folder(out, state["steps"])
    keep.parent.mkdir(exist_ok=True)
    with replace_path(keep) as fresh:
        fresh.mkdir()
        write_training(model, env, fresh)
        write_json(fresh / "state.json", {**state, "updates": model._n_updates})
    _publish(keep, out)


def write_training(model: PPO, env: VecNormalize, folder: Path) -> None:
    """Write the policy and its optimiser's moments."""
    write_policy(saved_policy(model, env), folder)
    moments = model.policy.optimizer.state_dict()["state"]
    arrays = {f"{n}.{name}": value.numpy() for n, each in moments.items() for name, value in each.items()}
    write_arrays(arrays, folder / OPTIMISER)


def read_training(model: PPO, env: VecNormalize, folder: Path, updates: int) -> None:
    """Give a fresh model and its environments what `write_training` wrote. Raises InputError where it does not fit."""
    saved, moments = read_policy(folder), read_arrays(folder / OPTIMISER)
    put_statistics(env.obs_rms, saved.observations)
    put_statistics(env.ret_rms, saved.returns)
    try:
        model.policy.load_state_dict({name: torch.from_numpy(value) for name, value in saved.weights.items()})
        state: dict[int, dict[str, Any]] = {}
        for key, value in moments.items():
            number, name = key.split(".")
            state.setdefault(int(number), {})[name] = torch.from_numpy(value)
        groups = model.policy.optimizer.state_dict()["param_groups"]
        model.policy.optimizer.load_state_dict({"state": state, "param_groups": groups})
    except (RuntimeError, ValueError, KeyError) as error:
        raise InputError(f"{folder} is no checkpoint of this training: {' '.join(str(error).split())}") from None
    model._n_updates = updates


def saved_policy(model: PPO, env: VecNormalize) -> SavedPolicy:
    """What a model has learned, as plain data."""
    seen, driven = model.observation_space, model.action_space
    return SavedPolicy(
        {name: value.numpy() for name, value in model.policy.state_dict().items()},
        np.array([seen.low, seen.high]), np.array([driven.low, driven.high]),
        _statistics(env.obs_rms), _statistics(env.ret_rms), float(env.clip_obs), float(env.epsilon),
    )  # fmt: skip


def _statistics(running: RunningMeanStd) -> Statistics:
    return Statistics(np.array(running.mean), np.array(running.var), float(running.count))


def put_statistics(running: RunningMeanStd, known: Statistics) -> None:
    """Set running statistics, of the first entries where there are fewer known ones."""
    size = np.size(known.mean)
    if np.ndim(known.mean):
        running.mean[:size], running.var[:size] = known.mean, known.variance
    else:
        running.mean, running.var = known.mean, known.variance
    running.count = known.count


def checkpoint_folder(out: Path, steps: int) -> Path:
    return out / "checkpoints" / f"{steps:09d}"


def _publish(checkpoint: Path, out: Path) -> None:
    """Copy a checkpoint to the run's folder, where `evaluate` looks; resuming never reads these copies."""
    for name in (WEIGHTS, SETTINGS, "state.json"):
        with replace_path(out / name) as fresh:
            fresh.write_bytes((checkpoint / name).read_bytes())


def last_state(out: Path) -> dict[str, Any]:
    """State of the newest whole checkpoint, or of the start where a kill came before the first one.

    Rows that the killed chunk left in curve.csv are dropped, since it is run again.
    """
    whole = sorted(folder for folder in (out / "checkpoints").glob("[0-9]*") if folder.is_dir())
    if whole:
        _publish(whole[-1], out)
    if not (out / "state.json").is_file():
        raise FileNotFoundError(f"nothing to resume in {out}: no state.json")
    state: dict[str, Any] = read_json(out / "state.json")
    with (out / "curve.csv").open(newline="") as file:
        header, *rows = list(csv.reader(file))
    with replace_file(out / "curve.csv") as file:
        csv.writer(file).writerows([header, *(row for row in rows if int(row[0]) <= state["steps"])])
    return state
