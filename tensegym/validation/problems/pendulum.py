"""IFToMM's benchmark A01: a simple pendulum, its joint from a URDF, in PyBullet."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from scipy.special import ellipk

from tensegym.flexible import FlexibleRobot
from tensegym.validation.row import Findings, Row

URDF = """<robot name="pendulum">
  <link name="base"/>
  <link name="rod"><inertial><origin xyz="1 0 0"/><mass value="1"/>
    <inertia ixx="1e-9" iyy="1e-9" izz="1e-9" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pin" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint>
</robot>"""
GRAVITY = 9.81
STEPS = (4e-3, 2e-3, 1e-3)


def swing(dt: float, seconds: float = 10.0) -> tuple[float, float, float]:
    """Period [s] from the crossings of the lowest point, greatest speed [m/s], largest change of the energy [J]."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pendulum.urdf"
        path.write_text(URDF)
        with FlexibleRobot(path, dt=dt, gravity=(0, 0, -GRAVITY), fixed_base=True) as robot:
            angles, speeds, energies = [], [], [robot.energies().total]
            for _ in range(round(seconds / dt)):
                angles.append(float(robot.positions[0]))
                speeds.append(float(robot.velocities[0]))
                robot.step()
                energies.append(robot.energies().total)
    below = np.array(angles) - np.pi / 2
    passes = np.flatnonzero(np.diff(np.sign(below)) != 0)
    times = (passes + below[passes] / (below[passes] - below[passes + 1])) * dt
    return (float(2 * np.diff(times).mean()), float(np.abs(speeds).max()),
            float(np.abs(np.array(energies) - energies[0]).max()))  # fmt: skip


def pendulum(engine: str) -> Findings:
    """1 kg at 1 m, let go from the horizontal, for 10 s: period 4 K(1/2) sqrt(l / g), greatest speed sqrt(2 g l)."""
    found = {dt: swing(dt) for dt in STEPS}
    period = 4 * float(ellipk(0.5)) / np.sqrt(GRAVITY)
    one = found[1e-3]
    order = np.polyfit(np.log(STEPS), np.log([found[dt][2] for dt in STEPS]), 1)[0]
    rows = [Row("A01", "period, s", period, one[0], 1e-5, 1e-3),
            Row("A01", "greatest speed, m/s", np.sqrt(2 * GRAVITY), one[1], 1e-4, 1e-3),
            Row("A01", "energy, largest change in 10 s, J", 0.0, one[2], 1e-4, 1e-3),
            Row("A01", "order of that in the time step", 2.0, float(order), 0.1)]  # fmt: skip
    return Findings(rows)
