"""Frame and Stage: what is seen of a robot at one time, and what stands still around it."""

from __future__ import annotations

from typing import NamedTuple

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.physics.terrain import Ground


class Stage(NamedTuple):
    """What stays as it is while a robot moves."""

    design: RobotDesign
    ground: Ground | None
    """None in free flight."""
    gravity: FloatArray
    """(3,) [m/s^2]; on a slope it leans, since z = 0 is the slope's plane."""
    path: FloatArray
    """(k, 2) points of the path to follow [m]; none without one."""


class Frame(NamedTuple):
    """A robot at one time; world axes, rows as in `tensegym.robot.robot_state.RobotState`."""

    time: float
    """Since its start [s]."""
    poses: FloatArray
    """(b, 7) centre of mass [m] and quaternion xyzw of every body."""
    tensions: FloatArray
    """(c,) [N]."""
    commands: FloatArray
    """(w,) commanded spool angles [rad]."""
    angles: FloatArray
    """(w,) spool angles [rad]."""
    currents: FloatArray
    """(w,) [A]."""
    torques: FloatArray
    """(w,) load of the cable on its spool [N m]."""
    direction: FloatArray
    """(2,) unit vector to go along, nan where none is wanted."""
    place: FloatArray
    """(2,) to go to [m], nan where there is none."""
    face: int
    """Index of the face it stands on."""
    says: str = ""
    """Its gait so far, or what went wrong, in one line."""
