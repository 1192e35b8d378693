"""Controllers by their table in a task file: the pattern generator, with its own feedback or a trained policy's.

    [controller]
    kind = "cpg"              # the default
    policy = "onboard"        # a shipped policy or a run's folder, in place of the quadratic feedback; default: none
    gain = 1.0                # and the fields of tensegym.control.cpg.Cpg

Or the open-loop walker, with the default design's table of tips:

    [controller]
    kind = "walker"
    depth = 1.0               # and the fields of tensegym.control.walker.Playing
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields
from functools import cache
from importlib import resources
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Protocol, TypeVar

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.cpg import Cpg, CpgController
from tensegym.control.tipping import Tip
from tensegym.control.walker import Playing, WalkerController, load_table
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot


class Driver(Protocol):
    """What drives a robot through an episode."""

    @property
    def period(self) -> float:
        """A command is held for this long [s]."""

    def angles(self) -> FloatArray:
        """Commanded spool angles (w,) [rad] for the next period."""


Start = Callable[[TensegrityRobot, FloatArray], Driver]
_Parameters = TypeVar("_Parameters", Cpg, Playing)


def check_controller(table: dict[str, Any]) -> dict[str, Any]:
    """The table with every default in it. Raises DesignError, or FileNotFoundError for a policy there is not."""
    kind, policy, parameters = _parsed(table)
    if kind == "walker":
        return {"kind": kind, **asdict(parameters)}
    if policy:
        from tensegym.train.controllers import policy_controller

        policy_controller(policy)
    return {"kind": kind, "policy": policy, **asdict(parameters)}


def controller(table: dict[str, Any]) -> Start:
    """What makes the controller of an episode from a standing robot and the wanted direction (2,)."""
    _, policy, parameters = _parsed(table)
    if isinstance(parameters, Playing):
        return lambda robot, direction: WalkerController(robot, parameters, direction, _tips())
    if not policy:
        return lambda robot, direction: CpgController(robot, parameters, direction)
    return lambda robot, direction: CpgController(robot, parameters, direction, _learned(robot, policy, direction))


def _parsed(table: dict[str, Any]) -> tuple[str, str, Cpg | Playing]:
    """Kind, policy and parameters."""
    kind = table.get("kind", "cpg")
    if kind == "walker":
        return kind, "", _filled(Playing, table, "kind")
    if kind != "cpg":
        raise DesignError(f"controller kind = {kind!r} is not one of cpg, walker")
    return kind, table.get("policy", ""), _filled(Cpg, table, "kind", "policy")


def _filled(parameters: type[_Parameters], table: dict[str, Any], *besides: str) -> _Parameters:
    """A dataclass from a table, but for what else stands in it. Raises DesignError for a field there is not."""
    allowed = [*besides, *(f.name for f in fields(parameters))]
    for name in table:
        if name not in allowed:
            raise DesignError(f"unknown field {name!r} in the controller; one of {', '.join(allowed)}")
    values: dict[str, Any] = {k: float(v) if type(v) is int else v for k, v in table.items() if k not in besides}
    return parameters(**values)


@cache
def _tips() -> list[Tip]:
    """The default design's, as `tensegym step --all-faces` found them; read once a process."""
    return load_table(Path(str(resources.files("tensegym.train") / "policies" / "walker" / "tips.json")))


def _learned(robot: TensegrityRobot, policy: str, direction: FloatArray) -> Callable[[], FloatArray]:
    """Feedback (w,) of a policy: its commands from -1/2 to 1/2, as the quadratic form was fitted to."""
    from tensegym.control.observation import observer
    from tensegym.design.variation import variation
    from tensegym.train.controllers import policy_controller

    env = policy_controller(policy).env
    seen = variation(env["vary"], robot.design) if env.get("vary") else None
    eye = observer(env.get("observation", "full"), robot, seen)
    act = _loaded(policy, len(eye.bound), len(robot.drives))
    return lambda: np.clip(act(eye.read(robot, direction)[0].astype(np.float32)), -1, 1) / 2


@cache
def _loaded(policy: str, observed: int, driven: int) -> Callable[[np.ndarray], np.ndarray]:
    """The policy, read once a process. Raises InputError where it was trained on other sizes."""
    from tensegym.train.controllers import load_policy, policy_controller

    sizes = SimpleNamespace(observation_space=SimpleNamespace(shape=(observed,)),
                            action_space=SimpleNamespace(shape=(driven,)))  # fmt: skip
    return load_policy(Path(policy_controller(policy).path or ""), sizes)  # type: ignore[arg-type]
