"""Checkpoints of a training: whole or not there, whenever it is killed, and nothing in them can run."""

from __future__ import annotations

import csv
from dataclasses import replace
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
    Weights,
    read_arrays,
    read_policy,
    write_arrays,
    write_policy,
)
from tensegym.errors import InputError
from tensegym.files import replace_file, replace_path
from tensegym.tables import one_line

from .curve import CURVE, read_cells
from .state import STATE, TrainState, read_state, write_state

OPTIMISER = "optimiser.npz"  # Adam's moments, as NUMBER.NAME of the parameters in their order
_MOMENTS = {"step", "exp_avg", "exp_avg_sq"}


def write_checkpoint(model: PPO, env: VecNormalize, out: Path, state: TrainState) -> None:
    """Write beside, then move: a kill leaves the old checkpoint or the new one, never half of one."""
    keep = checkpoint_folder(out, state.steps)
    keep.parent.mkdir(exist_ok=True)
    with replace_path(keep) as fresh:
        fresh.mkdir()
        write_training(model, env, fresh)
        write_state(replace(state, updates=model._n_updates), fresh)
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
    optimiser = model.policy.optimizer
    try:
        model.policy.load_state_dict({name: torch.from_numpy(value) for name, value in saved.weights.items()})
        groups = optimiser.state_dict()["param_groups"]
        optimiser.load_state_dict({"state": _moments(moments, list(model.policy.parameters())), "param_groups": groups})
    except (RuntimeError, ValueError) as error:
        raise InputError(one_line(f"{folder} is no checkpoint of this training: {error}")) from None
    put_statistics(env.obs_rms, saved.observations)
    put_statistics(env.ret_rms, saved.returns)
    model._n_updates = updates


def _moments(arrays: Weights, parameters: list[torch.nn.Parameter]) -> dict[int, dict[str, Any]]:
    """Adam's state by parameter, none before the first step. Raises ValueError where it is not that of these."""
    state: dict[int, dict[str, Any]] = {}
    for key, value in arrays.items():
        number, _, name = key.partition(".")
        if not number.isdecimal() or int(number) >= len(parameters):
            raise ValueError(f"{OPTIMISER} has {key!r}, of no parameter")
        shape = () if name == "step" else tuple(parameters[int(number)].shape)
        if name not in _MOMENTS or value.shape != shape:
            raise ValueError(f"{OPTIMISER}: {key!r} of shape {value.shape} is no moment of a parameter of {shape}")
        state.setdefault(int(number), {})[name] = torch.from_numpy(value.astype(np.float32))
    for place, own in state.items():
        if own.keys() != _MOMENTS or len(state) != len(parameters):
            raise ValueError(f"{OPTIMISER} lacks moments of parameter {place}, or of others")
        if (own["step"] < 0).any() or (own["exp_avg_sq"] < 0).any():
            raise ValueError(f"{OPTIMISER}: a count or a mean square of parameter {place} is below 0")
    return state


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
    for name in (WEIGHTS, SETTINGS, STATE):
        with replace_path(out / name) as fresh:
            fresh.write_bytes((checkpoint / name).read_bytes())


def last_state(out: Path) -> TrainState:
    """State of the newest whole checkpoint, or of the start where a kill came before the first one.

    Raises InputError where a file is none, or FileNotFoundError.
    """
    whole = sorted(folder for folder in (out / "checkpoints").glob("[0-9]*") if folder.is_dir())
    newest = whole[-1] if whole else out
    if not (newest / STATE).is_file():
        raise FileNotFoundError(one_line(f"nothing to resume in {out}: no {STATE}" + f" in {newest}" * bool(whole)))
    state = read_state(newest)
    if newest != checkpoint_folder(out, state.steps) and (whole or state.steps):
        raise InputError(one_line(f"{newest / STATE}: steps = {state.steps} is another checkpoint's; one of that many "
                                  f"stands in {checkpoint_folder(out, state.steps)}"))  # fmt: skip
    if state.steps:  # what is none is told before anything is started
        read_policy(newest)
        read_arrays(newest / OPTIMISER)
    read_cells(out / CURVE)
    return state


def go_back(out: Path, state: TrainState) -> None:
    """Make a run's folder what it was at a state: rows that a killed chunk left in curve.csv go, since it is run again.

    For when all that a resumption reads has been read.
    """
    if state.steps:
        _publish(checkpoint_folder(out, state.steps), out)
    curve = read_cells(out / CURVE)
    kept = [row for row in curve.cells if float(row[0]) <= state.steps]
    with replace_file(out / CURVE) as file:
        csv.writer(file, lineterminator="\n").writerows([curve.header, *kept])
