"""`tensegym train`: PPO on a rolling environment, checkpointed so that a killed run goes on as if it had not been.

Training is a row of chunks. A chunk starts from its checkpoint alone: weights, optimiser, running statistics, and
random generators seeded by (seed, steps done), with fresh episodes. So killing and resuming changes nothing.
"""

from __future__ import annotations

import csv
import json
import os
import platform
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, cast

import gymnasium as gym
import numpy as np
import torch
import yaml
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import configure
from stable_baselines3.common.utils import set_random_seed
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize
from tqdm import tqdm

from tensegym.envs import CONTROL_PERIOD
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.files import replace_file
from tensegym.report import Report, table

from .config import TrainConfig, load_config
from .start_policy import begin_from, check_start
from .symmetric_policy import SymmetricPolicy, symmetry_arguments
from .vec_env import RollingVecEnv

CURVE_FIELDS = ("steps", "hours", "episodes", "speed_lps", "speed_lps_p10", "slip_share", "tips", "audit_excess",
                "action_std")  # fmt: skip


def make_env(config: TrainConfig) -> gym.Env:
    """One environment as the config describes it, with its time limit.

    Raises InputError for an environment or an argument there is none of.
    """
    try:
        return gym.make(config.env_id, max_episode_steps=_episode_steps(config), **config.env)
    except (TypeError, ZeroDivisionError, gym.error.Error) as error:
        raise InputError(f"training config: env_id = {config.env_id!r}, env = {config.env!r}: {error}") from error


def _episode_steps(config: TrainConfig) -> int:
    period = config.env.get("control_period", CONTROL_PERIOD)
    return max(1, round(config.episode_seconds / period))


def make_vec_env(config: TrainConfig) -> RollingVecEnv:
    """The config's environments, over the cores."""
    arguments = {**gym.spec(config.env_id).kwargs, **config.env}
    return RollingVecEnv(config.n_envs, _episode_steps(config), arguments)


@dataclass(frozen=True)
class Train:
    """Train a rolling policy with PPO and save it with its curve."""

    config: str = "rolling"
    """A committed config (rolling, onboard, flexible) or the path of a YAML file."""
    out: Path | None = None
    """Folder of the run; default runs/CONFIG-sSEED. One folder a run."""
    seed: int = 0
    """Seed of the networks, the episodes and the exploration."""
    steps: int | None = None
    """Environment steps in all, in place of the config's; with --resume, a longer schedule to go on with."""
    resume: bool = False
    """Go on from the folder's last checkpoint, with its own config and seed."""

    def run(self) -> Report:
        out = self.out or Path("runs") / f"{Path(self.config).stem}-s{self.seed}"
        if self.resume:
            state = _resume(out)
            config, seed = load_config(str(out / "config.yaml")), state["seed"]
            if self.steps is not None:
                config = _extended(config, self.steps, out, state)
        else:
            if out.exists() and not out.is_dir():
                raise InputError(f"--out {out} is a file; give a folder")
            if out.exists() and any(out.iterdir()):
                raise InputError(f"folder {out} is not empty; take another --out, or --resume to go on with it")
            config, seed = load_config(self.config), self.seed
            data = config.as_dict() | ({} if self.steps is None else {"steps": self.steps})
            config = TrainConfig(**data)
            _check(config)
            state = {"seed": seed, "steps": 0, "seconds": 0.0}
            out.mkdir(parents=True, exist_ok=True)
            (out / "config.yaml").write_text(yaml.safe_dump(config.as_dict(), sort_keys=False))
            (out / "versions.json").write_text(json.dumps(_versions(), indent=1))
            (out / "state.json").write_text(json.dumps(state))
            with (out / "curve.csv").open("w", newline="") as file:
                csv.writer(file).writerow(CURVE_FIELDS)
        model_steps = train(config, seed, out, state)
        rows = list(csv.DictReader((out / "curve.csv").open()))
        best = max((float(r["speed_lps"]) for r in rows), default=None)
        from .curve import draw_curve

        draw_curve({out.name: out / "curve.csv"}, out / "curve.png")
        data = {"out": str(out), "seed": seed, "steps": model_steps, "best_median_speed_lps": best,
                "last": {k: float(v) for k, v in rows[-1].items()} if rows else {}}  # fmt: skip
        text = table(["run", "steps", "best median speed L/s"], [[str(out), model_steps, best]])
        return Report(text, data)


def _check(config: TrainConfig) -> None:
    """A bad env argument, or a start that does not fit it, fails here, before anything is written."""
    probe = make_env(config)
    spaces = probe.observation_space.shape, probe.action_space.shape
    probe.close()
    if config.start is not None:
        check_start(config, *spaces)


def _extended(config: TrainConfig, steps: int, out: Path, state: dict[str, Any]) -> TrainConfig:
    """The same training with a longer schedule; the run's state keeps the ends of its stages."""
    if steps <= state["steps"]:
        raise InputError(f"steps = {steps} must be above the {state['steps']} that {out} stands at")
    state["stages"] = [*state.get("stages", [config.steps]), steps]
    config = replace(config, steps=steps)
    (out / "config.yaml").write_text(yaml.safe_dump(config.as_dict(), sort_keys=False))
    return config


def _versions() -> dict[str, str]:
    names = ("tensegym", "pybullet", "numpy", "numba", "gymnasium", "stable-baselines3", "torch")
    found = {"python": platform.python_version(), **{n: version(n) for n in names}}
    commit = subprocess.run(["git", "-C", Path(__file__).parent, "rev-parse", "HEAD"], capture_output=True, text=True)
    return found | {"commit": commit.stdout.strip() or "not a git checkout"}


def train(config: TrainConfig, seed: int, out: Path, state: dict[str, Any]) -> int:
    """Run the chunks that are left; returns the steps done."""
    torch.set_num_threads(1)
    workers = make_vec_env(config)
    monitored = VecMonitor(workers)
    try:
        if state["steps"]:
            last = _checkpoint_folder(out, state["steps"])
            env = VecNormalize.load(str(last / "vecnormalize.pkl"), monitored)
            model = PPO.load(last / "model.zip", env=env, device="cpu")
        else:
            set_random_seed(seed)
            env = VecNormalize(monitored, gamma=config.gamma, clip_obs=10.0)
            model = _new_model(config, env, seed)
            if config.start is not None:
                begin_from(config.start, model, env)
        model.set_logger(configure(str(out / "tensorboard"), ["tensorboard", "csv"]))
        chunk_steps = config.chunk * config.rollout_steps
        with tqdm(total=config.steps, initial=state["steps"], unit="step", desc=out.name, file=sys.stderr) as bar:
            while state["steps"] < config.steps:
                began = time.perf_counter()
                _start_chunk(model, env, config, seed, state["steps"])
                model.learn(chunk_steps, callback=_Watch(bar, out, state), reset_num_timesteps=False)
                state["steps"] = model.num_timesteps
                state["seconds"] += time.perf_counter() - began
                _checkpoint(model, env, out, state)
    finally:
        workers.close()
    return state["steps"]


def _new_model(config: TrainConfig, env: VecNormalize, seed: int) -> PPO:
    probe = make_env(config)
    arguments = {"hidden": list(config.hidden), "log_std_init": config.log_std_init,
                 **symmetry_arguments(cast(RollingEnv, probe.unwrapped))}  # fmt: skip
    probe.close()
    return PPO(
        SymmetricPolicy, env, learning_rate=config.learning_rate, n_steps=config.rollout,
        batch_size=config.batch_size, n_epochs=config.n_epochs, gamma=config.gamma, gae_lambda=config.gae_lambda,
        clip_range=config.clip_range, ent_coef=config.ent_coef, target_kl=config.target_kl, policy_kwargs=arguments,
        seed=seed, device="cpu",
    )  # fmt: skip


def _start_chunk(model: PPO, env: VecNormalize, config: TrainConfig, seed: int, steps: int) -> None:
    stream = int(np.random.SeedSequence([seed, steps]).generate_state(1)[0] >> 1)
    set_random_seed(stream)
    env.seed(stream)
    model._last_obs = None  # makes learn() reset the environments
    left = 1 - steps / config.steps
    model.learning_rate = config.final_learning_rate + left * (config.learning_rate - config.final_learning_rate)
    model._setup_lr_schedule()


def _checkpoint(model: PPO, env: VecNormalize, out: Path, state: dict[str, Any]) -> None:
    """Write beside, then move: a kill leaves the old checkpoint or the new one, never half of one."""
    fresh = out / "checkpoint.tmp"
    shutil.rmtree(fresh, ignore_errors=True)
    fresh.mkdir()
    model.save(fresh / "model.zip")
    env.save(str(fresh / "vecnormalize.pkl"))
    (fresh / "state.json").write_text(json.dumps(state))
    keep = _checkpoint_folder(out, state["steps"])
    keep.parent.mkdir(exist_ok=True)
    shutil.rmtree(keep, ignore_errors=True)
    os.replace(fresh, keep)
    _publish(keep, out)


def _checkpoint_folder(out: Path, steps: int) -> Path:
    return out / "checkpoints" / f"{steps:09d}"


def _publish(checkpoint: Path, out: Path) -> None:
    """Copy a checkpoint to the run's folder, where `evaluate` looks; resuming never reads these copies."""
    for name in ("model.zip", "vecnormalize.pkl", "state.json"):
        shutil.copy2(checkpoint / name, out / f"{name}.tmp")
        os.replace(out / f"{name}.tmp", out / name)


def _resume(out: Path) -> dict[str, Any]:
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


class _Watch(BaseCallback):
    """Progress bar, and one row of curve.csv an update from the episodes that ended in it."""

    def __init__(self, bar: tqdm, out: Path, state: dict[str, Any]) -> None:
        super().__init__()
        self.bar, self.state, self.path = bar, state, out / "curve.csv"
        self.began = time.perf_counter()
        self.gaits: list[dict[str, Any]] = []

    def _on_step(self) -> bool:
        self.bar.update(self.training_env.num_envs)
        for done, info in zip(self.locals["dones"], self.locals["infos"], strict=True):
            if done:
                self.gaits.append(info["gait"])
        return True

    def _on_training_end(self) -> None:
        if not self.gaits:
            return
        speeds = np.array([g["speed_lps"] for g in self.gaits])
        row = (
            self.num_timesteps, (self.state["seconds"] + time.perf_counter() - self.began) / 3600, len(self.gaits),
            np.median(speeds), np.quantile(speeds, 0.1), np.median([g["slip_share"] for g in self.gaits]),
            np.mean([g["tips"] for g in self.gaits]), np.max([g["audit_excess"] for g in self.gaits]),
            float(self.model.policy.log_std.detach().exp().mean()),
        )  # fmt: skip
        with self.path.open("a", newline="") as file:
            csv.writer(file).writerow([f"{v:.6g}" if isinstance(v, float) else v for v in row])
        for name, value in zip(CURVE_FIELDS[3:], row[3:], strict=True):
            self.logger.record(f"gait/{name}", float(value))
        self.bar.set_postfix_str(f"{np.median(speeds):.3f} L/s, slip {row[5]:.2f}, {row[6]:.0f} tips")
