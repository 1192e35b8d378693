"""Tensegrity robots and flexible joints on PyBullet, and on MuJoCo beside it.

    import tensegym

    with tensegym.TensegrityRobot(tensegym.RobotDesign()) as robot:
        robot.reset(face=0)
        robot.command(0.3 * robot.command_limit)  # spool angles of the drives [rad]
        robot.step(1000)
        print(robot.tensions)

Environments, registered with Gymnasium by this import:
    gymnasium.make("tensegym/SixRodRolling-v0")          the six-rod robot; tensegym.envs.rolling.RollingEnv
    gymnasium.make("tensegym/FlexibleSixRodRolling-v0")  the same robot with passive rods that bend
    gymnasium.make("tensegym/SixRodSteer-v0")            a direction that changes; also SixRodPlaces-v0, SixRodPath-v0

Robots:
    RobotDesign       what a robot is: structure, rods, cables, drives, payload; validated, frozen
    load_design       a design from a TOML file
    TensegrityRobot   a design in PyBullet or MuJoCo: reset, command, step, and what can be read
    Terrain           rough ground
    standing_verdict  whether a design stands, face by face, and the least pretension that holds it
    GaitMeter         measures a motion while a robot makes it
    GaitMetrics       what it measured: speed, tips, slip, energy, the energy audit

Tasks:
    Task              what is to be done: start, goal, ground, end, reward, metrics; the base class of your own
    as_task           a task by its name ("roll", "climb", "step", ...) or from a table
    rollout           one episode of a controller at a task on a robot
    load_policy       a shipped policy, or your own run's, as a function of the observation
    evaluate          figures of a policy over many episodes
    record            an environment that leaves a replay, or a video, of every episode

Flexible joints:
    fit_joint         joint models fitted to a hinge's finite elements, with their errors
    load_joint        a fitted joint from its JSON file
    FlexibleRobot     any URDF robot in PyBullet, with joints that are fitted flexures

Errors, all of them a TensegymError:
    StructureError    nodes, rods or cables that are no tensegrity
    DesignError       a field of a design that is unknown or outside its range
    FlexureError      a hinge, a joint or measured data that cannot be used
    InputError        a file or a command-line value that cannot be used
    SimulationError   a simulation that left the states it can be trusted in

Each name is imported when it is first asked for. Everything is in SI units. The commands are `tensegym --help`.
"""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from tensegym import envs as envs

if TYPE_CHECKING:
    from tensegym.control.policy import load_policy
    from tensegym.design.design import RobotDesign
    from tensegym.design.design_file import load_design
    from tensegym.errors import (
        DesignError,
        FlexureError,
        InputError,
        SimulationError,
        StructureError,
        TensegymError,
    )
    from tensegym.flexible import FlexibleRobot
    from tensegym.flexure.models import fit_joint, load_joint
    from tensegym.physics.terrain import Terrain
    from tensegym.replay.record import record
    from tensegym.robot.gait import GaitMeter, GaitMetrics
    from tensegym.robot.robot import TensegrityRobot
    from tensegym.robot.standing import standing_verdict
    from tensegym.tasks import Task, as_task, evaluate, rollout

__all__ = [
    "DesignError", "FlexibleRobot", "FlexureError", "GaitMeter", "GaitMetrics", "InputError", "RobotDesign",
    "SimulationError", "StructureError", "Task", "TensegrityRobot", "TensegymError", "Terrain", "as_task", "evaluate",
    "fit_joint", "load_design", "load_joint", "load_policy", "record", "rollout",
    "standing_verdict",
]  # fmt: skip

_HOMES = {
    "control.policy": ("load_policy",),
    "design.design": ("RobotDesign",),
    "design.design_file": ("load_design",),
    "errors": ("DesignError", "FlexureError", "InputError", "SimulationError", "StructureError", "TensegymError"),
    "flexible": ("FlexibleRobot",),
    "flexure.models": ("fit_joint", "load_joint"),
    "physics.terrain": ("Terrain",),
    "replay.record": ("record",),
    "robot.gait": ("GaitMeter", "GaitMetrics"),
    "robot.robot": ("TensegrityRobot",),
    "robot.standing": ("standing_verdict",),
    "tasks": ("Task", "as_task", "evaluate", "rollout"),
}

__version__ = version("tensegym")


def __getattr__(name: str) -> Any:  # and no __dir__, by which help() would load all of it and print a thousand lines
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"tensegym.{home}"), name)
    raise AttributeError(f"module 'tensegym' has no attribute {name!r}")
