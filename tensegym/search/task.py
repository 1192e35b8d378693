"""A task: a motion, how it is tried, and the bound on a metric that says it is done."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from tensegym.design.parameters import bounded, check_ranges
from tensegym.errors import DesignError, InputError
from tensegym.physics.terrain import Terrain
from tensegym.robot.robot import LARGEST_TIME_STEP, LEAST_TIME_STEP

from .measure import Bound


@dataclass(frozen=True)
class Task:
    """One motion. Raises DesignError naming the field that is out of its range.

    goal: the bound on a metric, mean over the episodes, that the search is for. Every episode starts at rest on a
    random face at a random heading, towards a random direction; to step is to tip onto a neighbour of that face, drawn
    at random too, and the direction is the one across their edge. An episode without a tip in its first ``patience``
    seconds ends there, and one of stepping with the first tip. On a slope the wanted direction is uphill.
    Rough ground is the same in all episodes, which cross it in their directions; see `tensegym.physics.terrain`.
    """

    motion: str
    goal: Bound
    seconds: float = bounded(0.1, 3600, 10.0, "s", "length of an episode")
    settle: float = bounded(0, 60, 0.3, "s", "standing still before it")
    patience: float = bounded(0, 3600, 4.0, "s", "given up without a tip in this time")
    dt: float = bounded(LEAST_TIME_STEP, LARGEST_TIME_STEP, 2e-3, "s", "physics time step")
    slope: float = bounded(0, 60, 0.0, "deg", "of the ground, uphill along the wanted direction")
    roughness: float = bounded(0, 0.2, 0.0, "m", "root mean square height of the ground's bumps")
    correlation_length: float = bounded(0.1, 5, 0.3, "m", "of the bumps")
    payload: float = bounded(0, 100, 0.0, "kg", "mass of the payload a design must carry; 0 asks for none")

    def __post_init__(self) -> None:
        check_ranges(self)
        try:
            self.ground  # noqa: B018 - refuses what is too large
        except DesignError as error:
            raise DesignError(f"Task.seconds = {self.seconds!r} is too long for rough ground: {error}") from error

    @property
    def ground(self) -> bool | Terrain:
        """The plane, or bumps further than a robot gets at 1 m/s, some twice what the fastest ones make."""
        if not self.roughness:
            return True
        return Terrain(self.roughness, self.correlation_length, reach=2.0 + self.seconds)


MOTIONS: dict[str, dict[str, Any]] = {
    "roll": {"goal": "speed_lps >= 0.2"},
    "step": {"goal": "arrived >= 0.9", "seconds": 4.0},
    "climb": {"goal": "speed_lps >= 0.05", "slope": 10.0},
    "cross": {"goal": "speed_lps >= 0.2", "roughness": 0.02},
    "carry": {"goal": "speed_lps >= 0.2", "payload": 0.5},
}


def task_from(data: Any) -> Task:
    """From a motion's name, or a table that names one and changes its fields. Raises InputError or DesignError."""
    table = {"motion": data} if isinstance(data, str) else data
    if not isinstance(table, dict) or table.get("motion") not in MOTIONS:
        given = table.get("motion") if isinstance(table, dict) else table
        raise InputError(f"task motion {given!r} is not one of {', '.join(MOTIONS)}")
    allowed = [f.name for f in fields(Task)]
    unknown = set(table) - set(allowed)
    if unknown:
        raise InputError(f"unknown field {sorted(unknown)[0]!r} in [task]; one of {', '.join(allowed)}")
    values = MOTIONS[table["motion"]] | table
    values = {k: float(v) if isinstance(v, int) and not isinstance(v, bool) else v for k, v in values.items()}
    try:
        return Task(**values | {"goal": Bound.parse(values["goal"])})
    except DesignError as error:
        raise InputError(f"[task]: {error}") from error
