"""`tensegym train`: a new training in a folder of its own, or one that was stopped gone on with."""

from __future__ import annotations

import platform
import subprocess
import sys
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

import yaml

from tensegym.bullet.c_interface import installed
from tensegym.errors import InputError
from tensegym.files import VERSION, is_empty, lock_folder, write_json, write_text
from tensegym.report import Report, table
from tensegym.tasks.motions import refuse_code
from tensegym.train.checkpoint import last_state
from tensegym.train.config import TrainConfig, load_config
from tensegym.train.curve import CURVE, FIELDS, draw_curve, read_curve
from tensegym.train.ppo import make_env, train
from tensegym.train.start_policy import check_start
from tensegym.train.state import TrainState, write_state

from .options import Count, Seed
from .standing import tell_unless_standing

_BEGUN = ("versions.json", CURVE, "config.yaml")  # all there is of a run that was killed as it began


@dataclass(frozen=True)
class Train:
    """Train a rolling policy with PPO and save it with its curve."""

    config: str = "rolling"
    """A committed config, such as rolling, onboard or carry (a wrong name lists all), or the path of a YAML file."""
    out: Path | None = None
    """Folder of the run; default runs/CONFIG-sSEED. One folder a run."""
    seed: Seed = 0
    """Seed of the networks, the episodes and the exploration."""
    steps: Count | None = None
    """Environment steps in all, in place of the config's, rounded up to whole updates (800 steps of most configs); with
    --resume, a longer schedule to go on with."""
    resume: bool = False
    """Go on from the folder's last checkpoint, with its own config and seed."""

    def run(self) -> Report:
        out = self.out or Path("runs") / f"{Path(self.config).stem}-s{self.seed}"
        if self.resume and not out.is_dir():
            raise FileNotFoundError(f"nothing to resume in {out}: no state.json")
        with lock_folder(out):
            config, state = self._go_on(out) if self.resume else self._begin(out)
            _tell_steps(config)
            steps = train(config, out, state)
            rows = read_curve(out / CURVE)
            draw_curve({out.name: out / CURVE}, out / "curve.png")
        best = max((row["speed_lps"] for row in rows), default=None)
        data = {"out": str(out), "seed": state.seed, "steps": steps, "best_median_speed_lps": best,
                "last": rows[-1] if rows else {}}  # fmt: skip
        text = table(["run", "steps", "best median speed L/s"], [[str(out), steps, best]])
        return Report(text, data)

    def _begin(self, out: Path) -> tuple[TrainConfig, TrainState]:
        """A new run's folder; nothing is written before all of it has been looked at."""
        if not is_empty(out, but=_BEGUN):
            raise InputError(f"folder {out} is not empty; take another --out, or --resume to go on with it")
        config = load_config(self.config)
        if self.steps is not None:
            config = replace(config, steps=self.steps)
        _check(config)
        state = TrainState(self.seed)
        write_json(out / "versions.json", _versions())
        write_text(out / CURVE, ",".join(FIELDS) + "\n")
        _write_config(config, out)
        write_state(state, out)
        return config, state

    def _go_on(self, out: Path) -> tuple[TrainConfig, TrainState]:
        """The run in a folder, with a longer schedule if steps are given; its state keeps the ends of its stages."""
        state = last_state(out)
        config = load_config(str(out / "config.yaml"))
        refuse_code(config.env.get("task"), f"the training {out}")
        if self.steps is not None:
            if self.steps <= state.steps:
                raise InputError(f"steps = {self.steps} must be above the {state.steps} that {out} stands at")
            state = replace(state, stages=(*(state.stages or (config.steps,)), self.steps))
            config = replace(config, steps=self.steps)
            _write_config(config, out)
        return config, state


def _tell_steps(config: TrainConfig) -> None:
    """Where whole updates are more than was asked for, say so before they are made."""
    if config.whole_steps != config.steps:
        print(f"tensegym: {config.steps} steps are asked for; it will be {config.whole_steps}, whole updates of "
              f"{config.rollout_steps}", file=sys.stderr, flush=True)  # fmt: skip


def _check(config: TrainConfig) -> None:
    """A bad env argument, or a start that does not fit it, fails here, before anything is written."""
    probe = make_env(config)
    spaces = probe.observation_space.shape, probe.action_space.shape
    robot = probe.get_wrapper_attr("robot")
    design, engine = robot.design, robot.engine
    probe.close()
    if config.start is not None:
        check_start(config, *spaces)
    tell_unless_standing(design, engine)


def _write_config(config: TrainConfig, out: Path) -> None:
    write_text(out / "config.yaml", yaml.safe_dump({"version": VERSION, **config.as_dict()}, sort_keys=False))


def _versions() -> dict[str, str]:
    names = ("tensegym", *installed(), "numpy", "numba", "gymnasium", "stable-baselines3", "torch")
    found = {"python": platform.python_version(), **{n: version(n) for n in names}}
    commit = subprocess.run(["git", "-C", Path(__file__).parent, "rev-parse", "HEAD"], capture_output=True, text=True)
    return found | {"commit": commit.stdout.strip() or "not a git checkout"}
