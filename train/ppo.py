"""`tensegym train`: PPO on a rolling environment, checkpointed so that a killed run goes on as if it had not been.

Training is a row of chunks. A chunk starts from its checkpoint alone: weights, optimiser, running statistics, and
random generators seeded by (seed, steps done), with fresh episodes. So killing and resuming changes nothing.
"""

from __future__ import annotations

import csv
import json
import platform
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
from stable_baselines3.common.logger import configure
from stable_baselines3.common.utils import set_random_seed
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize
from tqdm import tqdm

from tensegym.envs import CONTROL_PERIOD
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.report import Report, table

from .checkpoint import checkpoint_folder, last_state, write_checkpoint
from .config import TrainConfig, load_config
from .start_policy import begin_from, check_start
from .symmetric_policy import SymmetricPolicy, symmetry_arguments
from .vec_env import RollingVecEnv
from .watch import CURVE_FIELDS, Watch


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
    """A committed config (rolling, onboard, flexible, conditioned, carry, climb, steep) or the path of a YAML file."""
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
            state = last_state(out)
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
            last = checkpoint_folder(out, state["steps"])
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
                model.learn(chunk_steps, callback=Watch(bar, out, state), reset_num_timesteps=False)
                state["steps"] = model.num_timesteps
                state["seconds"] += time.perf_counter() - began
                write_checkpoint(model, env, out, state)
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
