"""Tensegrity robots and flexible joints on PyBullet.

    import tensegym

    with tensegym.TensegrityRobot(tensegym.RobotDesign()) as robot:
        robot.reset(face=0)
        robot.command(0.3 * robot.command_limit)  # spool angles of the drives [rad]
        robot.step(1000)
        print(robot.tensions)

Environments, registered with Gymnasium by this import:
    gymnasium.make("tensegym/SixRodRolling-v0")          the six-rod robot; tensegym.envs.rolling.RollingEnv
    gymnasium.make("tensegym/FlexibleSixRodRolling-v0")  the same robot with passive rods that bend

Robots:
    RobotDesign       what a robot is: structure, rods, cables, drives, payload; validated, frozen
    load_design       a design from a TOML file
    TensegrityRobot   a design in PyBullet: reset, command, step, and what can be read
    Terrain           rough ground
    GaitMeter         measures a motion while a robot makes it
    GaitMetrics       what it measured: speed, tips, slip, energy, the energy audit

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
    from tensegym.robot.gait import GaitMeter, GaitMetrics
    from tensegym.robot.robot import TensegrityRobot

__all__ = [
    "DesignError", "FlexibleRobot", "FlexureError", "GaitMeter", "GaitMetrics", "InputError", "RobotDesign",
    "SimulationError", "StructureError", "TensegrityRobot", "TensegymError", "Terrain", "fit_joint", "load_design",
    "load_joint",
]  # fmt: skip

_HOMES = {
    "design.design": ("RobotDesign",),
    "design.design_file": ("load_design",),
    "errors": ("DesignError", "FlexureError", "InputError", "SimulationError", "StructureError", "TensegymError"),
    "flexible": ("FlexibleRobot",),
    "flexure.models": ("fit_joint", "load_joint"),
    "physics.terrain": ("Terrain",),
    "robot.gait": ("GaitMeter", "GaitMetrics"),
    "robot.robot": ("TensegrityRobot",),
}

__version__ = version("tensegym")


def __getattr__(name: str) -> Any:  # and no __dir__, by which help() would load all of it and print a thousand lines
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"tensegym.{home}"), name)
    raise AttributeError(f"module 'tensegym' has no attribute {name!r}")
