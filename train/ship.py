"""Put a finished run among the shipped policies: `python -m tensegym.train.ship --run runs/rolling-s0 --name rolling`.

Keeps what evaluation needs and what made it (config, seed, versions, curve); leaves out the optimiser's moments, two
thirds of the file.
"""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path

from tensegym.control.policy import shipped
from tensegym.errors import InputError

FILES = ("config.yaml", "versions.json", "curve.csv", "curve.png", "vecnormalize.pkl")


@dataclass(frozen=True)
class Ship:
    """Copy a finished training run to the folder of shipped policies."""

    run: Path
    """Folder of the run."""
    name: str
    """Name to ship it under, for `tensegym roll --policy NAME`."""

    def __call__(self) -> Path:
        """Returns the folder written. Raises InputError for a run that is not finished."""
        from stable_baselines3 import PPO

        from .config import load_config

        missing = [f for f in (*FILES, "model.zip", "state.json") if not (self.run / f).is_file()]
        if missing:
            raise InputError(f"{self.run} is no finished run: {missing[0]} is missing; resume it with `tensegym train`")
        state = json.loads((self.run / "state.json").read_text())
        config = load_config(str(self.run / "config.yaml"))
        if state["steps"] < config.steps:
            raise InputError(f"{self.run} stands at {state['steps']} of {config.steps} steps; resume it first")
        out = shipped(self.name)
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir(parents=True)
        for name in FILES:
            shutil.copy2(self.run / name, out / name)
        model = PPO.load(self.run / "model.zip", device="cpu")
        model.policy.optimizer = type(model.policy.optimizer)(model.policy.parameters(), lr=model.learning_rate)
        model.save(out / "model.zip")
        commit = json.loads((self.run / "versions.json").read_text())["commit"]
        lines = [f"tensegym train --config {self.name} --seed {state['seed']}"]
        lines += [f"tensegym train --resume --out {self.run} --steps {end}" for end in state.get("stages", [])[1:]]
        done = f"# at commit {commit}; {state['steps']} steps in {state['seconds'] / 3600:.2f} h\n"
        (out / "COMMAND").write_text("\n".join([*lines, done]))
        return out


if __name__ == "__main__":
    import tyro

    print(tyro.cli(Ship)())
