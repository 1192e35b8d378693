"""Checkpoints of a training: whole or not there, whenever it is killed."""

from __future__ import annotations

import csv
import json
import os
import shutil
from pathlib import Path
from typing import Any

from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecNormalize

from tensegym.files import replace_file


def write_checkpoint(model: PPO, env: VecNormalize, out: Path, state: dict[str, Any]) -> None:
    """Write beside, then move: a kill leaves the old checkpoint or the new one, never half of one."""
    fresh = out / "checkpoint.tmp"
    shutil.rmtree(fresh, ignore_errors=True)
    fresh.mkdir()
    model.save(fresh / "model.zip")
    env.save(str(fresh / "vecnormalize.pkl"))
    (fresh / "state.json").write_text(json.dumps(state))
    keep = checkpoint_folder(out, state["steps"])
    keep.parent.mkdir(exist_ok=True)
    shutil.rmtree(keep, ignore_errors=True)
    os.replace(fresh, keep)
    _publish(keep, out)


def checkpoint_folder(out: Path, steps: int) -> Path:
    return out / "checkpoints" / f"{steps:09d}"


def _publish(checkpoint: Path, out: Path) -> None:
    """Copy a checkpoint to the run's folder, where `evaluate` looks; resuming never reads these copies."""
    for name in ("model.zip", "vecnormalize.pkl", "state.json"):
        shutil.copy2(checkpoint / name, out / f"{name}.tmp")
        os.replace(out / f"{name}.tmp", out / name)


def last_state(out: Path) -> dict[str, Any]:
    """State of the newest whole checkpoint, or of the start where a kill came before the first one.

    Rows that the killed chunk left in curve.csv are dropped, since it is run again.
    """
    whole = sorted(folder for folder in (out / "checkpoints").glob("*") if folder.is_dir())
    if whole:
        _publish(whole[-1], out)
    if not (out / "state.json").is_file():
        raise FileNotFoundError(f"nothing to resume in {out}: no state.json")
    state = json.loads((out / "state.json").read_text())
    with (out / "curve.csv").open(newline="") as file:
        header, *rows = list(csv.reader(file))
    with replace_file(out / "curve.csv") as file:
        csv.writer(file).writerows([header, *(row for row in rows if int(row[0]) <= state["steps"])])
    return state
