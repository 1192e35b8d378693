"""Faults: what goes wrong with a robot in the course of one episode."""

from __future__ import annotations

from collections import deque
from dataclasses import fields
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.parameters import Drive
from tensegym.physics.model import TWO_WAY
from tensegym.robot.robot import TensegrityRobot

from .disturbance import Disturbance

_SNAPPED = 1e3  # m: the natural length of a cable that never pulls again
_COLUMN = {field.name: column for column, field in enumerate(fields(Drive))}


class Faults:
    """Those of one episode, drawn when it begins; the robot's next reset mends them.

    Args:
        disturb: their ranges, which fit the robot.
        robot: that is to have them.
        rng: draws them.
    """

    def __init__(self, disturb: Disturbance, robot: TensegrityRobot, rng: np.random.Generator) -> None:
        self._disturb, self._rng = disturb, rng
        drives, cables = rng.permutation(len(robot.drives)), rng.permutation(robot.model.first_driven)
        counts = np.cumsum([disturb.weak, disturb.stuck, disturb.dead])
        split = np.split(drives[: counts[-1]], counts[:-1])
        self.weak, self.stuck, self.dead = (self._fails(parts) for parts in split)
        snapping = [(0.0, number - 1) for number in disturb.cables]
        drawn = self._fails(cables[: disturb.snapped])
        snapping += [(float(rng.uniform(0, disturb.snap_by)), int(cable)) for cable in drawn]
        self._snapping = sorted(snapping)
        self.late = int(rng.integers(disturb.done_late + 1))
        self._commands: deque[FloatArray] = deque([np.zeros(len(drives))] * self.late)
        self._clock = 0.0
        params = robot.model.drive_params
        params[self.weak, _COLUMN["current_limit"]] *= disturb.weak_to
        params[self.stuck, _COLUMN["speed_limit"]] = 0.0
        params[self.dead, _COLUMN["voltage_limit"]] = 0.0

    def _fails(self, parts: IntArray) -> IntArray:
        certain = self._disturb.faulty == 1.0
        return parts if certain else parts[self._rng.random(len(parts)) < self._disturb.faulty]

    def command(self, angles: FloatArray) -> FloatArray:
        """What comes of a command (w,): one that was given before, where they come late."""
        self._commands.append(angles)
        return self._commands.popleft()

    def strike(self, robot: TensegrityRobot, seconds: float) -> float:
        """What happens at the start of a control step of so many seconds; returns the energy it brings [J]."""
        snapping = [cable for time, cable in self._snapping if time <= self._clock]
        pushed = self._disturb.pushes and self._rng.random() < self._disturb.pushes * seconds / 60
        self._clock += seconds
        if not (snapping or pushed):
            return 0.0
        before = robot.energies().total
        robot.model.spring_params[snapping, TWO_WAY] = 0.0
        robot.natural_lengths[snapping] = _SNAPPED
        self._snapping = self._snapping[len(snapping) :]
        if pushed:
            angle = self._rng.uniform(-np.pi, np.pi)
            robot.push(self._disturb.push * np.array([np.cos(angle), np.sin(angle), 0.0]))
        return robot.energies().total - before

    def as_dict(self) -> dict[str, Any]:
        """What was drawn, in plain types; drives and cables by number from 1."""
        return {
            "weak": (self.weak + 1).tolist(), "stuck": (self.stuck + 1).tolist(), "dead": (self.dead + 1).tolist(),
            "snapping": {str(cable + 1): time for time, cable in self._snapping}, "done_late": self.late,
        }  # fmt: skip
