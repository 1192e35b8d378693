"""state.json of a training: how far it is."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from tensegym.errors import InputError
from tensegym.files import write_json
from tensegym.tables import Checked, bounded, fill, in_file, one_line, read_json

STATE = "state.json"
_MOST = 10**12  # steps, updates


@dataclass(frozen=True)
class TrainState(Checked, error=InputError):
    """Where a training stands. ``stages``: the ends of its schedules, where it was gone on with beyond the first."""

    seed: int = bounded(0, 2**31 - 1, what="of the networks, the episodes and the exploration")
    steps: int = bounded(0, _MOST, 0, what="environment steps done")
    seconds: float = bounded(0, 1e12, 0.0, "s", "wall time of them")
    updates: int = bounded(0, _MOST, 0, what="passes over the steps of an update that were made")
    stages: tuple[int, ...] = bounded(1, _MOST, (), what="environment steps at the end of each schedule")


def write_state(state: TrainState, folder: Path) -> None:
    """Write state.json, whole or as before."""
    write_json(folder / STATE, asdict(state))


def read_state(folder: Path) -> TrainState:
    """Read it. Raises InputError for what is no state of a training, naming the field; OSError where there is none."""
    path = folder / STATE
    data = read_json(path, "training's state", InputError)
    with in_file(str(path)):
        state = fill(TrainState, data, "", InputError)
    if state.steps and "updates" not in data:
        raise InputError(one_line(f"{path} has no 'updates': it is of an older tensegym, and so are the files beside "
                                  "it; convert the run by `python -m tensegym.train.convert`"))  # fmt: skip
    return state
