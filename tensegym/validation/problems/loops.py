"""IFToMM's benchmarks A02 and A04: chains that close to loops, their joints from a URDF, closed by PyBullet."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.bullet.loops import hold_point
from tensegym.flexible import FlexibleRobot
from tensegym.validation.row import Findings, Row

GRAVITY, SECONDS, STEPS = 9.81, 10.0, (1e-3, 0.5e-3, 0.25e-3)
Vector = tuple[float, float, float]


class Rod(NamedTuple):
    """A rod of 1 m and 1 kg on a revolute joint."""

    name: str
    parent: str
    joint: Vector
    """Where, in the parent [m]."""
    axis: Vector
    along: Vector
    """Unit vector from the joint to its other end, in its own frame, which is the world's at the start."""
    rate: float = 0.0
    """Of the joint at the start [rad/s]."""


def _urdf(rods: Sequence[Rod], thick: float) -> str:
    across, own = (1 + thick**2) / 12, max(thick**2 / 6, 1e-5)
    text = ['<robot name="loop"><link name="base"/>']
    for rod in rods:
        moments = [own if abs(a) > 0.5 else across for a in rod.along]
        middle, joint, axis = (" ".join(f"{v:g}" for v in values) for values in
                               ((0.5 * np.array(rod.along)).tolist(), rod.joint, rod.axis))  # fmt: skip
        inertia = " ".join(f'i{a}{a}="{m:.12g}"' for a, m in zip("xyz", moments, strict=True))
        text += [f'<link name="{rod.name}"><inertial><origin xyz="{middle}"/><mass value="1"/>'
                 f'<inertia {inertia} ixy="0" ixz="0" iyz="0"/></inertial></link>',
                 f'<joint name="{rod.name}" type="continuous"><parent link="{rod.parent}"/>'
                 f'<child link="{rod.name}"/><origin xyz="{joint}"/><axis xyz="{axis}"/></joint>']  # fmt: skip
    return "".join([*text, "</robot>"])


def energies(rods: Sequence[Rod], held: Sequence[tuple[str, Vector, Vector]], gravity: Vector, dt: float,
             thick: float, seconds: float = SECONDS) -> FloatArray:  # fmt: skip
    """(n,) total energy [J] of a loop at every step, where its velocities are: half a step before its places.

    held: link, point from its middle [m], place in the world [m].
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "loop.urdf"
        path.write_text(_urdf(rods, thick))
        with FlexibleRobot(path, dt=dt, gravity=gravity, fixed_base=True, scheme="explicit") as robot:
            robot.place(rates={rod.name: rod.rate for rod in rods})
            for link, point, place in held:
                hold_point(robot.body, robot.links[link] - 1, point, place)
            total, before = [], robot.energies().gravity
            for _ in range(round(seconds / dt)):
                robot.step()
                now = robot.energies()
                total.append(now.kinetic + 0.5 * (before + now.gravity))
                before = now.gravity
    return np.array(total)


UP, DOWN, ASIDE = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)
Y = (0.0, 1.0, 0.0)
FOUR_BARS = (
    Rod("left", "base", (0, 0, 0), Y, UP, 1.0), Rod("top", "left", UP, Y, ASIDE, -1.0),
    Rod("middle", "top", ASIDE, Y, DOWN, 1.0), Rod("next", "top", ASIDE, Y, ASIDE, 0.0),
    Rod("right", "next", ASIDE, Y, DOWN, 1.0),
)  # fmt: skip
FOUR_BARS_HELD = (("middle", (0.0, 0.0, -0.5), (1.0, 0.0, 0.0)), ("right", (0.0, 0.0, -0.5), (2.0, 0.0, 0.0)))
BRICARD = (
    Rod("one", "base", (0, 0, 0), (0, 1, 0), (1, 0, 0)), Rod("two", "one", (1, 0, 0), (0, 0, 1), (0, -1, 0)),
    Rod("three", "two", (0, -1, 0), (1, 0, 0), (0, 0, 1)), Rod("four", "three", (0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    Rod("five", "four", (-1, 0, 0), (0, 0, 1), (0, 1, 0)),
)  # fmt: skip
BRICARD_HELD = (  # two points of the last axis
    ("five", (0.0, 0.5, 0.0), (0.0, 0.0, 1.0)), ("five", (0.2, 0.5, 0.0), (0.2, 0.0, 1.0))
)  # fmt: skip


def four_bars(engine: str) -> Findings:
    """Two four-bars in a row, of rods of 1 kg and 1 m, through the pose in which all lie in a line, for 10 s; the upper
    left corner starts at 1 m/s. The energy is constant."""
    return _findings("A02", FOUR_BARS, FOUR_BARS_HELD, (0, 0, -GRAVITY), 0.0)


def bricard(engine: str) -> Findings:
    """Bricard's mechanism: five rods of 1 kg, 1 m long and 0.1 m square, and six revolute joints, one of which too many
    by counting, fall under gravity for 10 s. The energy is constant."""
    return _findings("A04", BRICARD, BRICARD_HELD, (0, -GRAVITY, 0), 0.1)


def _findings(name: str, rods: Sequence[Rod], held: Sequence[tuple[str, Vector, Vector]], gravity: Vector,
              thick: float) -> Findings:  # fmt: skip
    """At three time steps, since the engine's way to close a loop is what takes the energy."""
    rows, curves = [], {}
    for dt in STEPS:
        total = energies(rods, held, gravity, dt, thick)
        change = total - total[0]
        rows.append(Row(name, "energy, largest change in 10 s, J", 0.0, float(np.abs(change).max()), 0.1, dt))
        every = round(0.05 / dt)
        curves[f"{1e3 * dt:g} ms"] = change[every - 1 :: every].tolist()
    return Findings(rows, {"time, s": (0.05 * np.arange(1, round(SECONDS / 0.05) + 1)).tolist(),
                           "change of energy, J": curves})  # fmt: skip
