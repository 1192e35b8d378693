"""Controllers by their table in a task file: the pattern generator, with its own feedback or a trained policy's.

    [controller]
    policy = "onboard"        # a shipped policy or a run's folder, in place of the quadratic feedback; default: none
    gain = 1.0                # and the fields of tensegym.control.cpg.Cpg
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np

from tensegym.control.cpg import Cpg, CpgController
from tensegym.robot import TensegrityRobot
from tensegym.structure import FloatArray

Start = Callable[[TensegrityRobot, FloatArray], CpgController]


def check_controller(table: dict[str, Any]) -> dict[str, Any]:
    """The table with every default in it. Raises DesignError, or FileNotFoundError for a policy there is not."""
    policy = table.get("policy", "")
    if policy:
        from tensegym.train.controllers import policy_controller

        policy_controller(policy)
    return {"policy": policy, **asdict(_generator(table))}


def controller(table: dict[str, Any]) -> Start:
    """What makes the controller of an episode from a standing robot and the wanted direction (2,)."""
    parameters, policy = _generator(table), table.get("policy", "")
    if not policy:
        return lambda robot, direction: CpgController(robot, parameters, direction)
    return lambda robot, direction: CpgController(robot, parameters, direction, _learned(robot, policy, direction))


def _generator(table: dict[str, Any]) -> Cpg:
    return Cpg.from_dict({k: v for k, v in table.items() if k != "policy"})


def _learned(robot: TensegrityRobot, policy: str, direction: FloatArray) -> Callable[[], FloatArray]:
    """Feedback (w,) of a policy: its commands from -1/2 to 1/2, as the quadratic form was fitted to."""
    from tensegym.envs.observation import OBSERVATIONS
    from tensegym.train.controllers import policy_controller

    observer = OBSERVATIONS[policy_controller(policy).env.get("observation", "full")](robot)
    act = _loaded(policy, len(observer.bound), len(robot.drives))
    return lambda: np.clip(act(observer.read(robot, direction)[0].astype(np.float32)), -1, 1) / 2


@cache
def _loaded(policy: str, observed: int, driven: int) -> Callable[[np.ndarray], np.ndarray]:
    """The policy, read once a process. Raises InputError where it was trained on other sizes."""
    from pathlib import Path

    from tensegym.train.controllers import load_policy, policy_controller

    sizes = SimpleNamespace(observation_space=SimpleNamespace(shape=(observed,)),
                            action_space=SimpleNamespace(shape=(driven,)))  # fmt: skip
    return load_policy(Path(policy_controller(policy).path or ""), sizes)  # type: ignore[arg-type]
