"""Put a finished run among the shipped policies: `python -m tensegym.train.ship --run runs/rolling-s0 --name rolling`.

Keeps what evaluation needs and what made it (config, seed, versions, curve); leaves out the optimiser's moments.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from tensegym.control.policy import shipped
from tensegym.control.policy_file import SETTINGS, WEIGHTS
from tensegym.errors import InputError
from tensegym.files import replace_path, write_text
from tensegym.tables import as_text, mapping, read_json

from .config import load_config
from .curve import CURVE
from .script import run_script
from .state import STATE, read_state

FILES = ("config.yaml", "versions.json", CURVE, "curve.png", WEIGHTS, SETTINGS)


@dataclass(frozen=True)
class Ship:
    """Copy a finished training run to the folder of shipped policies."""

    run: Path
    """Folder of the run."""
    name: str
    """Name to ship it under, for `tensegym roll --policy NAME`."""

    def __call__(self) -> Path:
        """Returns the folder written. Raises InputError for a run that is not finished, or a name that is none."""
        if not re.fullmatch(r"[a-z][a-z0-9_]*", self.name):
            raise InputError(f"name = {self.name!r} must be small letters, digits and _, beginning with a letter")
        out = shipped(self.name)
        if out.exists() and not (out / WEIGHTS).is_file():
            raise InputError(f"name = {self.name!r} is taken by {out}, which is no policy; take another")

        missing = [f for f in (*FILES, STATE) if not (self.run / f).is_file()]
        if missing:
            raise InputError(f"{self.run} is no finished run: {missing[0]} is missing; resume it with `tensegym train`")
        state = read_state(self.run)
        config = load_config(str(self.run / "config.yaml"))
        if state.steps < config.steps:
            raise InputError(f"{self.run} stands at {state.steps} of {config.steps} steps; resume it first")
        path = self.run / "versions.json"
        versions = mapping(read_json(path, "versions", InputError), str(path), InputError)
        commit = as_text(versions.get("commit"), f"{path}: commit", InputError)
        lines = [f"tensegym train --config {self.name} --seed {state.seed}"]
        lines += [f"tensegym train --resume --out {self.run} --steps {end}" for end in state.stages[1:]]
        done = f"# at commit {commit}; {state.steps} steps in {state.seconds / 3600:.2f} h\n"
        with replace_path(out) as fresh:
            fresh.mkdir(parents=True)
            for name in FILES:
                shutil.copy2(self.run / name, fresh / name)
            write_text(fresh / "COMMAND", "\n".join([*lines, done]))
        return out


if __name__ == "__main__":
    run_script(Ship)
