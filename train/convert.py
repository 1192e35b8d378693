"""Make a policy's files of Stable-Baselines3's: `python -m tensegym.train.convert --folder runs/mine --trust`.

The zip and vecnormalize.pkl hold pickles, which run what their maker put in, so no other command reads them. A plain
"MlpPolicy" of PPO, as of the zoo, becomes one of this package whose only symmetry is to leave the robot as it is.
"""

from __future__ import annotations

import pickle
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tensegym.control.policy import foreign_policy
from tensegym.control.policy_file import SavedPolicy, Statistics, Weights, write_policy
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.files import VERSION, lock_folder, write_json, write_text
from tensegym.tables import one_line, read_json

from .checkpoint import saved_policy, write_training
from .script import run_script
from .state import STATE

STATISTICS = "vecnormalize.pkl"
_PARTS = {"policy_net": ("actor", "action_net"), "value_net": ("critic", "value_net")}  # own name, and the last layer


@dataclass(frozen=True)
class Convert:
    """Write weights.npz and policy.json beside a policy of Stable-Baselines3's PPO, and in a run's checkpoints."""

    folder: Path
    """Folder of a run or of a policy, or its zip."""
    trust: bool = False
    """Read the pickles in it, which can run any code: the word of someone who knows where they come from."""

    def __call__(self) -> list[Path]:
        """Returns the folders written to. Raises InputError without trust, or where there is nothing to convert."""
        folders = (self.folder, *sorted((self.folder / "checkpoints").glob("[0-9]*")))
        found = [path for folder in folders if (path := foreign_policy(folder))]
        if not found:
            raise InputError(one_line(f"no policy of Stable-Baselines3 in {self.folder}: no zip of that kind"))
        if not self.trust:
            raise InputError(one_line(f"{found[0]} can run code when read; give --trust if you know its maker"))
        with lock_folder(found[0].parent):
            for path in found:
                try:
                    _convert(path)
                except InputError:
                    raise
                except Exception as error:  # of what an unpickled object does
                    why = f"{type(error).__name__}: {error}"
                    raise InputError(one_line(f"{path} is no policy of PPO: {why}")) from error
        return [path.parent for path in found]


def _convert(path: Path) -> None:
    from stable_baselines3 import PPO

    folder, model = path.parent, PPO.load(path, device="cpu")
    statistics = next((p for p in (folder / STATISTICS, *sorted(folder.glob(f"*/{STATISTICS}"))) if p.is_file()), None)
    env = None if statistics is None else pickle.loads(statistics.read_bytes())
    if "mlp_extractor.index" in model.policy.state_dict():
        if env is None:
            raise InputError(one_line(f"no {STATISTICS} beside {path}"))
        write_training(model, env, folder)
    else:
        policy = _plain(model, env, path)
        observed = policy.observation_bounds.shape[1]
        config = None if (folder / "config.yaml").is_file() else _config(observed, path, _zoo_arguments(folder))
        write_policy(policy, folder)
        if config:
            write_text(folder / "config.yaml", yaml.safe_dump({"version": VERSION, **config}))
    if (folder / STATE).is_file() and isinstance(state := read_json(folder / STATE, "state", InputError), dict):
        write_json(folder / STATE, {"updates": model._n_updates, **state})


def _plain(model: Any, env: Any, path: Path) -> SavedPolicy:
    """A policy of plain layers. Raises InputError where it is of others."""
    from torch import nn

    given = {name: value.numpy() for name, value in model.policy.state_dict().items()}
    n, w = (np.prod(space.shape, dtype=int) for space in (model.observation_space, model.action_space))
    weights: Weights = {"log_std": given.pop("log_std", np.zeros(0)), "mlp_extractor.index": np.arange(n)[None],
                        "mlp_extractor.sign": np.ones((1, n), np.float32), "mlp_extractor.back": np.arange(w)[None]}
    for part, (own, last) in _PARTS.items():
        layers = sum(name.startswith(f"mlp_extractor.{part}.") for name in given) // 2
        for what in ("weight", "bias"):
            names = [f"mlp_extractor.{part}.{2 * k}.{what}" for k in range(layers)] + [f"{last}.{what}"]
            weights |= {f"mlp_extractor.{own}.{2 * k}.{what}": given.pop(name) for k, name in enumerate(names)}
    if weights["log_std"].ndim != 1:
        raise InputError(one_line(f"{path} explores by its state (use_sde = True); train it with use_sde = False"))
    if given or model.policy.activation_fn is not nn.Tanh or model.policy.squash_output:
        raise InputError(one_line(f"{path} is no policy of plain layers with tanh between them, as PPO's MlpPolicy is"))
    if env is not None and env.norm_obs:
        return replace(saved_policy(model, env), weights=weights)
    seen, driven = model.observation_space, model.action_space
    return SavedPolicy(
        weights, np.array([seen.low, seen.high]), np.array([driven.low, driven.high]),
        Statistics(np.zeros(n), np.ones(n), 1.0), Statistics(np.zeros(()), np.ones(()), 1.0),
        clip=float(np.finfo(np.float32).max), epsilon=1e-300,
    )  # fmt: skip


def _zoo_arguments(folder: Path) -> dict[str, Any]:
    """The environment's arguments that the zoo keeps in NAME/args.yml; none without that file."""
    for file in sorted(folder.glob("*/args.yml")):
        kept = dict(yaml.load(file.read_text(encoding="utf-8"), yaml.UnsafeLoader))  # an OrderedDict of Python's
        return dict(kept.get("env_kwargs") or {})
    return {}


def _config(observed: int, path: Path, arguments: dict[str, Any]) -> dict[str, Any]:
    """Of a policy that has none: the environment of these arguments, with the observation that is as long."""
    lengths = {}
    for kind in [arguments["observation"]] if "observation" in arguments else ("full", "onboard"):
        kept = {**arguments, "observation": kind}
        with RollingEnv(**kept) as env:
            lengths[kind] = env.observation_space.shape[0]
        if lengths[kind] == observed:
            return {"env": kept}
    what = f"the environment of {arguments}" if arguments else "the default environment"
    raise InputError(one_line(
        f"{path} observes {observed} values, {what} {lengths}: write a config.yaml beside it with its "
        "environment's arguments, as in `env: {design: six_rod_flexible}`, and convert it again"
    ))  # fmt: skip


if __name__ == "__main__":
    run_script(Convert)
