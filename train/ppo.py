"""PPO on a rolling environment, checkpointed so that a killed run goes on as if it had not been.

Training is a row of chunks. A chunk starts from its checkpoint alone: weights, optimiser, running statistics, and
random generators seeded by (seed, steps done), with fresh episodes. So killing and resuming changes nothing.
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import cast

import gymnasium as gym
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.logger import configure
from stable_baselines3.common.utils import set_random_seed
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

from tensegym.envs import CONTROL_PERIOD
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.progress import progress_bar

from .checkpoint import checkpoint_folder, go_back, read_training, write_checkpoint
from .config import TrainConfig
from .start_policy import begin_from
from .state import TrainState
from .symmetric_policy import SymmetricPolicy, symmetry_arguments
from .vec_env import RollingVecEnv
from .watch import Watch


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


def train(config: TrainConfig, out: Path, state: TrainState) -> int:
    """Run the chunks that are left; returns the steps done."""
    seed = state.seed
    torch.set_num_threads(1)
    workers = make_vec_env(config)
    monitored = VecMonitor(workers)
    try:
        set_random_seed(seed)
        env = VecNormalize(monitored, gamma=config.gamma, clip_obs=10.0)
        model = _new_model(config, env, seed)
        if state.steps:
            read_training(model, env, checkpoint_folder(out, state.steps), state.updates)
            model.num_timesteps = state.steps
        elif config.start is not None:
            begin_from(config.start, model, env, config.start_std)
        go_back(out, state)
        model.set_logger(configure(str(out / "tensorboard"), ["tensorboard", "csv"]))
        metric = workers.get_attr("task")[0].goal.metric
        with progress_bar(total=config.whole_steps, initial=state.steps, unit="step", desc=out.name) as bar:
            while state.steps < config.steps:
                began = time.perf_counter()
                _start_chunk(model, env, config, seed, state.steps)
                chunk = min(config.chunk * config.rollout_steps, config.whole_steps - state.steps)
                model.learn(chunk, callback=Watch(bar, out, state, metric), reset_num_timesteps=False)
                seconds = state.seconds + time.perf_counter() - began
                state = replace(state, steps=model.num_timesteps, seconds=seconds)
                write_checkpoint(model, env, out, state)
    finally:
        workers.close()
    return state.steps


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
    model.learning_rate = config.learning_rate_at(steps)
    model._setup_lr_schedule()
