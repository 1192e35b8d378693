"""Make a policy's files of Stable-Baselines3's: `python -m tensegym.train.convert --folder runs/mine --trust`.

model.zip and vecnormalize.pkl hold pickles, which run what their maker put in, so no other command reads them.
"""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from pathlib import Path

from tensegym.errors import InputError
from tensegym.files import lock_folder

from .checkpoint import write_training


@dataclass(frozen=True)
class Convert:
    """Write weights.npz and policy.json beside model.zip and vecnormalize.pkl, in a folder and in its checkpoints."""

    folder: Path
    """Folder of a run or of a policy."""
    trust: bool = False
    """Read the pickles in it, which can run any code: the word of someone who knows where they come from."""

    def __call__(self) -> list[Path]:
        """Returns the folders written to. Raises InputError without trust, or where there is nothing to convert."""
        folders = [f for f in (self.folder, *sorted((self.folder / "checkpoints").glob("[0-9]*")))
                   if (f / "model.zip").is_file() and (f / "vecnormalize.pkl").is_file()]  # fmt: skip
        if not folders:
            raise InputError(f"no model.zip with a vecnormalize.pkl in {self.folder}")
        if not self.trust:
            raise InputError(f"{folders[0] / 'model.zip'} can run code when read; give --trust if you know its maker")
        from stable_baselines3 import PPO

        with lock_folder(self.folder):
            for folder in folders:
                with (folder / "vecnormalize.pkl").open("rb") as file:
                    env = pickle.load(file)
                write_training(PPO.load(folder / "model.zip", device="cpu"), env, folder)
        return folders


if __name__ == "__main__":
    import tyro

    print(*tyro.cli(Convert)(), sep="\n")
