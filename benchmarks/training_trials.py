"""What a choice in a training's config is worth: short trainings that differ from a base in that choice alone.

    python benchmarks/training_trials.py --base four_rod --steps 64000 --out runs/trials

From nothing, on the base's body, by equal numbers of environment steps. A killed run goes on where it was when it is
started again. The speed is the curve's over its last quarter: median of the training's own episodes, exploration noise
and all, so it says what was learned soonest, not what would come of it in the end. The seeds of the base say how much
of a difference is chance.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
import tyro
import yaml
from stable_baselines3 import SAC
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

from tensegym.cli.train import Train
from tensegym.files import write_text
from tensegym.report import table, to_json
from tensegym.train.config import TrainConfig, load_config
from tensegym.train.curve import CURVE, read_curve
from tensegym.train.ppo import make_vec_env

_SAC = "SAC, a gradient step in eight"


def variants(base: TrainConfig) -> Iterator[tuple[str, dict[str, Any], dict[str, Any]]]:
    """By name, what differs from the base: fields of the config, and of its environment."""
    period = base.env["control_period"]
    yield "base", {}, {}
    for factor in (0.5, 2.0):  # the horizon stays, in seconds
        name = f"control period {period * factor:.3g} s for {period:.3g}"
        yield name, {"gamma": base.gamma**factor}, {"control_period": period * factor}
    yield "discount .9 a step", {"gamma": 0.9}, {}
    yield "discount .99 a step", {"gamma": 0.99}, {}
    bonus = 3 * (base.ent_coef or 1e-3)
    yield f"a bonus of {bonus:.3g} for entropy", {"ent_coef": bonus}, {}
    yield "half the learning rate", {"learning_rate": base.learning_rate / 2}, {}
    yield "the rate does not fall", {"final_learning_rate": base.learning_rate}, {}
    yield "half as wide", {"hidden": tuple(n // 2 for n in base.hidden)}, {}
    yield "twice as wide", {"hidden": tuple(n * 2 for n in base.hidden)}, {}
    yield "sees its last three moments", {}, {"observation": "onboard-memory"}
    yield "sees the whole state", {}, {"observation": "full"}
    yield "no price on slip", {}, {"reward": {"slip": 0.0}}


@dataclass(frozen=True)
class Trials:
    """Short trainings from nothing, one after another."""

    base: str = "four_rod"
    """Config that all are like but in one thing."""
    steps: int = 64_000
    """Environment steps of each."""
    seeds: int = 3
    """Of the base; the others have the first."""
    only: tuple[str, ...] = ()
    """Of the trials, those whose names begin so; default: all."""
    out: Path = Path("runs/trials")
    """Folder of the runs and of trials.json."""

    def run(self) -> str:
        base = replace(load_config(self.base), start=None, start_std=None, steps=self.steps, schedule=None)
        self.out.mkdir(parents=True, exist_ok=True)
        rows, data = [], {}
        for name, fields, env in variants(base):
            if not name.startswith(self.only or ""):
                continue
            config = replace(base, **fields, env={**base.env, **env})
            for seed in range(self.seeds if name == "base" else 1):
                label = f"{name}, seed {seed}" if name == "base" else name
                data[label] = self._train(config, label, seed)
                rows.append([label, *(f"{value:.3g}" for value in data[label].values())])
        if _SAC.startswith(self.only or ""):
            data[_SAC] = _soft(base)
            rows.append([_SAC, *(f"{value:.3g}" for value in data[_SAC].values())])
        write_text(self.out / "trials.json", to_json(data) + "\n")
        return table(["trial", "speed L/s", "slip share", "minutes"], rows)

    def _train(self, config: TrainConfig, label: str, seed: int) -> dict[str, float]:
        folder = self.out / "".join(letter if letter.isalnum() else "_" for letter in label)
        file = folder.with_suffix(".yaml")
        write_text(file, yaml.safe_dump(config.as_dict(), sort_keys=False))
        Train(config=str(file), out=folder, seed=seed, resume=(folder / "state.json").exists()).run()
        curve = read_curve(folder / CURVE)
        last = curve[-max(1, len(curve) // 4) :]
        mean = {name: float(np.mean([row[name] for row in last])) for name in ("speed_lps", "slip_share")}
        return mean | {"minutes": 60 * curve[-1]["hours"]}


def _soft(config: TrainConfig) -> dict[str, float]:
    """SAC as Stable-Baselines3 has it, on the same environments; its networks know no symmetry."""
    torch.set_num_threads(1)
    began = time.perf_counter()
    workers = make_vec_env(config)
    env = VecNormalize(VecMonitor(workers), gamma=config.gamma)
    gaits: list[dict[str, float]] = []
    model = SAC("MlpPolicy", env, batch_size=256, train_freq=10, gamma=config.gamma, device="cpu",
                gradient_steps=10 * config.n_envs // 8, learning_rate=config.learning_rate,
                learning_starts=config.rollout_steps, seed=0, policy_kwargs={"net_arch": [*config.hidden]})  # fmt: skip

    def note(local: dict[str, Any], _: dict[str, Any]) -> bool:
        gaits.extend(info["gait"] for info, done in zip(local["infos"], local["dones"], strict=True) if done)
        return True

    try:
        model.learn(config.steps, callback=note)
    finally:
        workers.close()
    last = gaits[-max(1, len(gaits) // 4) :]
    mean = {name: float(np.median([gait[name] for gait in last])) for name in ("speed_lps", "slip_share")}
    return mean | {"minutes": (time.perf_counter() - began) / 60}


if __name__ == "__main__":
    print(tyro.cli(Trials).run())
