"""Episode: one try at a task on a robot, begun and then advanced a control step at a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.bearing import Bearing
from tensegym.engine import Uncopied
from tensegym.errors import SimulationError
from tensegym.robot.energy_check import SPEED_BOUND
from tensegym.robot.gait import NO_GAIT, DriveMeter, GaitMeter, GaitMetrics
from tensegym.robot.reading import NODE_REACH, Reading, farthest_node, read
from tensegym.robot.robot import TensegrityRobot

from .faults import Faults
from .goal import Heading
from .start import Start, check_options, draw_start
from .task import Task


class Watcher(Protocol):
    """Looks at an episode while it goes on."""

    period: float
    """How often [s], as near as whole time steps of a control step come to it."""

    def __call__(self, episode: Episode) -> None: ...


class Episode(Uncopied):
    """One try at a task, from a settled start.

    A simulation that diverges, in the settling too, ends the episode: ``diverged`` and ``ended`` say so, and ``gait``
    stays that of the last step that could be trusted.

    Args:
        robot: any state; it is reset.
        task: what is to be done.
        rng: draws the start, and what the task's goal needs.
        options: face (index), heading [rad] and direction [rad] in place of what is drawn.

    Raises:
        DesignError: an option is none.
    """

    def __init__(
        self, robot: TensegrityRobot, task: Task, rng: np.random.Generator, options: Mapping[str, Any] | None = None
    ) -> None:
        faces = len(robot.faces.triangles)
        check_options(options or {}, faces)
        self.robot, self.task, self._length = robot, task, robot.design.length
        self.start: Start = draw_start(task.faces or range(faces), rng, options or {})
        self.ended: str | None = None
        """Why the episode is over; None while it goes on."""
        self.diverged = False
        self.gait: GaitMetrics = NO_GAIT
        self.bearing: Bearing
        """As the controller is told it now."""
        self.drives = DriveMeter(robot)
        self.ways: list[float] = [0.0]
        """Made along what was wanted since the start [rod lengths], one entry a control step."""
        try:
            self.goal = task.begin(robot, self.start, rng)
            self.reading: Reading = read(robot)
        except SimulationError as error:
            self.goal = Heading.at(self.start.direction)
            self.bearing = self.goal.bearing(robot)
            self._fail(f"while it settled: {error}")
            return
        self.bearing = self.goal.bearing(robot)
        self.faults: Faults | None = None
        if task.disturb.on:
            own = np.random.default_rng(rng.integers(2**63))
            self.faults, robot.sensors = Faults(task.disturb, robot, own), task.disturb.sensors(own)
        self.meter = GaitMeter(robot, self.bearing.direction)
        self.gait = self.meter.metrics()
        self._totals, self._time = robot.totals(), robot.time

    @property
    def sound(self) -> bool:
        """Whether what it did can be believed: it has not diverged, and keeps the energy audit."""
        return not self.diverged and self.gait.audit_passed

    @property
    def fault(self) -> str | None:
        """When and by what the energy audit was broken, None while it holds."""
        return self.meter.fault if self.gait is not NO_GAIT else None

    def advance(self, angles: FloatArray, substeps: int, watcher: Watcher | None = None) -> dict[str, float]:
        """Command spool angles (w,) [rad], hold them for so many time steps; returns the signed reward terms."""
        robot = self.robot
        try:
            if self.faults:
                angles = self.faults.command(angles)
                self.meter.exchange(self.faults.strike(robot, substeps * robot.dt))
            robot.command(angles)
            self._step(substeps, watcher)
            reading = read(robot)
            self._check_whole(reading)
        except SimulationError as error:
            self._fail(str(error))
            return self.task.rewards(self, 0.0, 0.0, 0.0)
        before, self.reading = self.reading, reading
        self.meter.update(reading.nodes, reading.velocities)
        self.drives.update()
        self.gait = self.meter.metrics()
        way = self.goal.made(self.bearing, before.centre[:2], reading.centre[:2])
        self.ways.append(self.ways[-1] + way / self._length)
        self.goal.update(robot, way, robot.time - self._time)
        self.ended, self._time = self.task.over(self), robot.time
        terms = self._rewards(way)
        self.bearing = self.goal.bearing(robot)
        self.meter.turn(self.bearing.direction)
        return terms

    def _rewards(self, way: float) -> dict[str, float]:
        totals, before, length = self.robot.totals(), self._totals, self._length
        self._totals = totals
        return self.task.rewards(
            self, way / length, (totals.foot_path - before.foot_path) / length,
            totals.electrical_energy - before.electrical_energy,
        )  # fmt: skip

    def _step(self, substeps: int, watcher: Watcher | None) -> None:
        parts = max(1, round(substeps * self.robot.dt / watcher.period)) if watcher else 1
        for part in np.array_split(np.arange(substeps), parts):
            self.robot.step(len(part))
            if watcher:
                watcher(self)

    def _check_whole(self, reading: Reading) -> None:
        if not farthest_node(reading) <= NODE_REACH * self._length:
            raise SimulationError(f"a node left its bound, {NODE_REACH:g} rod lengths from the centre of mass")
        if not np.linalg.norm(reading.node_velocities, axis=1).max() <= SPEED_BOUND:
            raise SimulationError(f"a node is faster than {SPEED_BOUND:g} m/s")

    def _fail(self, reason: str) -> None:
        self.diverged, self.ended = True, reason
