"""Trials of a policy on the robot, at the task and with the observation that it was trained with."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tensegym.control.policy import CONTROL_PERIOD, policy_env
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design, design_to_dict
from tensegym.design.variation import parse_variation

from .follow import Follow
from .motions import as_task, refuse_code
from .navigate import Navigate
from .task import Task
from .trials import Setup, run_trials, summarise

EPISODE_SECONDS = 20.0
FIRST_SEED = 10_000  # evaluation episodes start here; training draws its seeds elsewhere


def policy_setup(
    policy: str, *, seconds: float | None = None, dt: float | None = None, observation: str | None = None,
    task: Task | None = None, engine: str | None = None,
) -> Setup:  # fmt: skip
    """What a policy is tried on: as in its training, but never given up.

    Args:
        policy: a shipped policy, or a run's folder.
        seconds: length of an episode; default: the given task's own, or else EPISODE_SECONDS.
        dt: physics time step [s] in place of the training's, or the given task's.
        observation: in place of the training's.
        task: in place of the training's, with all that is the task's: slope, settling, time step.
        engine: in place of the training's, or the given task's.

    Raises:
        FileNotFoundError: there is no such policy.
        DesignError, InputError: the training's arguments, or those given, are outside their ranges.
    """
    env = policy_env(policy)
    if task is None:
        refuse_code(env.get("task"), f"the policy {policy}")
        own = {name: env.get(name) for name in ("dt", "settle", "slope", "reward", "disturb", "engine")}
        task = as_task(env.get("task", "roll")).changed(**own, seconds=EPISODE_SECONDS)
    seconds = task.seconds if seconds is None else seconds
    task = task.changed(dt=dt, seconds=seconds, patience=seconds, engine=engine)
    design = task.equipped(as_design(env.get("design", "six_rod")))
    varies = env.get("vary") and env.get("episodes_per_design", 1)
    controller: dict[str, Any] = {"kind": "policy", "policy": policy}
    if observation is not None:
        controller["observation"] = observation
    return Setup(policy, task, controller, design, parse_variation(env["vary"], design) if varies else None)


def baseline_setups(setup: Setup, period: float = CONTROL_PERIOD) -> dict[str, Setup]:
    """Random commands and the open-loop walker on the robot and the task of another setup, by name; for tasks that go
    somewhere the planner too.

    The walker of a robot other than the default one tabulates it first, which takes minutes.
    """
    default = design_to_dict(setup.design) == design_to_dict(RobotDesign())
    walker = {"kind": "walker", "period": period, "tips": "" if default else "own"}
    tables = {"open-loop walker": walker, "random commands": {"kind": "random", "period": period}}
    if isinstance(setup.task, Navigate | Follow):
        tables["planner"] = walker | {"kind": "planner"}
    return {name: replace(setup, name=name, controller=table) for name, table in tables.items()}


def evaluate(
    policy: str, *, episodes: int = 100, seconds: float = EPISODE_SECONDS, dt: float | None = None, jobs: int = 0,
    engine: str | None = None,
) -> dict[str, Any]:
    """Figures of a policy over episodes from random faces and headings, as `tensegym evaluate` tabulates them.

    Args:
        policy: a shipped policy, or a run's folder.
        episodes: how many; the seeds are FIRST_SEED and on.
        seconds: length of one.
        dt: physics time step [s] in place of the training's.
        jobs: processes; 0 for one a core.
        engine: in place of the training's.

    Raises: as `policy_setup` and `run_trials`.
    """
    setup = policy_setup(policy, seconds=seconds, dt=dt, engine=engine)
    return summarise(run_trials(setup, range(FIRST_SEED, FIRST_SEED + episodes), jobs=jobs, quiet=True))
