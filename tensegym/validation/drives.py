"""The winch drives' speed and force, against the figures of the paper's motor, gear and spool."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from tensegym.design.parameters import Drive
from tensegym.physics import drives as drive_kernel

from .check import Check


def drive_speed(tension: float, drive: Drive | None = None) -> float:
    """Steady winding speed [m/s] against a constant cable tension [N], full command."""
    constants = drive_kernel.drive_constants(drive or Drive())
    state = np.zeros(drive_kernel.STATE_SIZE)
    state[drive_kernel.COMMAND] = 1e4
    for _ in range(300):
        drive_kernel.drive_step(constants, state, tension, 1e-3)
    return state[drive_kernel.PULLED] / 1e-3


def rows(engine: str = "pybullet") -> Iterator[Check]:
    """Speeds and tensions of the default drive at full command; no engine takes part."""
    yield Check("drive", "unloaded speed, m/s", 0.197, drive_speed(0.0), 0.002)
    yield Check("drive", "speed at the nominal 41 N, m/s", 0.121, drive_speed(41.0), 0.002)
    yield Check("drive", "tension at the nominal 0.121 m/s, N", 41.0,
                brentq(lambda t: drive_speed(t) - 0.121, 1, 80), 1.0)  # fmt: skip
    yield Check("drive", "largest tension it winds against, N", 82.0,
                brentq(lambda t: drive_speed(t) - 1e-4, 50, 150), 1.5)  # fmt: skip
