"""What rolling means: speed, tips, foot slip, energy and its audit. Every gait in this project is judged here."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.groups import column
from tensegym.physics.drives import CURRENT
from tensegym.structure.faces import supporting_face

from .fault import element_energies, most_gained
from .robot import TensegrityRobot

AUDIT_TOLERANCE = 0.01  # mechanical energy over what the start and the drives' work allow


@dataclass(frozen=True)
class GaitMetrics:
    """One trial. Displacements are horizontal and of the centre of mass.

    speed: displacement along the wanted direction, summed over its changes, over time [m/s]; speed_lps the same in rod
    lengths a second.
    path: length of the way [m]. tips: changes of the face under the centre of mass.
    slip_share: path of the grounded feet's centres, averaged over the grounded feet, over the path of the centre of
    mass: 0 for pure rolling, 1 for a body that skates. slip_share_sum: the same with the feet's paths summed.
    energy: electrical, what the drives draw [J]. cost_of_transport: energy / (m g displacement along), inf if <= 0.
    peak_tension: the most that any cable bears [N].
    audit_excess: largest part by which kinetic + gravity + elastic energy exceeded the start's plus the drives' work.
    """

    duration: float
    speed: float
    speed_lps: float
    path: float
    tips: int
    slip_share: float
    slip_share_sum: float
    energy: float
    drive_work: float
    cost_of_transport: float
    audit_excess: float
    peak_tension: float

    @property
    def audit_passed(self) -> bool:
        return self.audit_excess <= AUDIT_TOLERANCE

    def as_dict(self) -> dict[str, float | int | bool | None]:
        """Plain JSON types; an infinite cost of transport becomes None."""
        data = vars(self) | {"audit_passed": self.audit_passed}
        return {name: value if math.isfinite(value) else None for name, value in data.items()}


NO_GAIT = GaitMetrics(0.0, 0.0, 0.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0, math.inf, 0.0, 0.0)  # of a trial that never began


class DriveMeter:
    """Watches the drives of a robot through a trial; call `update` once a control step."""

    def __init__(self, robot: TensegrityRobot) -> None:
        self.robot = robot
        self._squares = np.zeros(len(robot.drives))
        self._limits = column(robot.design.each_drive, "current_limit")
        self._updates = 0

    def update(self) -> None:
        """Take the present currents in."""
        self._squares += (self.robot.drives[:, CURRENT] / self._limits) ** 2
        self._updates += 1

    @property
    def rms_current(self) -> float:
        """Root mean square current of the hardest worked drive, as a part of the current limit."""
        return float(np.sqrt(self._squares.max(initial=0.0) / max(1, self._updates)))


class GaitMeter:
    """Watches a robot through a trial; call `update` once a control step.

    direction: wanted heading in the world's horizontal plane, (2,) unit vector; `turn` changes it.
    """

    def __init__(self, robot: TensegrityRobot, direction: FloatArray) -> None:
        self.robot = robot
        self.direction = np.asarray(direction, dtype=float)
        self._weight, self._length = robot.design.mass * robot.design.gravity, robot.design.length
        self._start = self._turned_at = robot.centre_of_mass_in_world()
        self._made = 0.0  # m, along the directions before this one
        self._start_time = robot.time
        robot.forget_peak()
        self._start_totals = robot.totals()
        self._start_energy = robot.energies().total
        self._start_energies = element_energies(robot)
        self._excess = 0.0
        self.fault: str | None = None
        """When and by what the energy audit was broken first, None while it holds."""
        self._planes = robot.faces.planes
        self.tips = 0
        self.face = self._face(robot.nodes_in_world()[0], self._start)

    def _face(self, nodes: FloatArray, centre: FloatArray) -> int:
        return supporting_face(self.robot.faces, nodes, centre)

    def update(self, nodes: FloatArray | None = None, velocities: FloatArray | None = None) -> None:
        """Take the robot's present state in; pass nodes (n, 3) and body velocities (b, 6) when read already."""
        robot = self.robot
        nodes = robot.node_positions_in_world() if nodes is None else nodes
        face = self._face(nodes, robot.centre_of_mass_in_world())
        self.tips += bool(self._planes[face] != self._planes[self.face])
        self.face = face
        allowed = self._start_energy + robot.totals().drive_work - self._start_totals.drive_work
        total = robot.energies(velocities).total
        self._excess = max(self._excess, total / allowed - 1 if allowed else float(total > 0))
        if self.fault is None and not self._excess <= AUDIT_TOLERANCE:
            self.fault = (
                f"the energy audit broke at t = {robot.time:.4g} s, {100 * self._excess:.3g} % over: most gained by "
                f"{most_gained(robot, self._start_energies)}; lower dt = {robot.dt:g} s, or StiffCable.damping"
            )

    def exchange(self, energy: float) -> None:
        """Energy [J] that came from outside, and not through the drives."""
        self._start_energy += energy

    def turn(self, direction: FloatArray) -> None:
        """From now on way counts along another direction (2,)."""
        if np.array_equal(direction, self.direction):
            return
        here = self.robot.centre_of_mass_in_world()
        self._made += float(self.direction @ (here - self._turned_at)[:2])
        self.direction, self._turned_at = direction, here

    @property
    def displacement(self) -> FloatArray:
        """(3,) of the centre of mass since the trial began, in the world [m]."""
        return self.robot.centre_of_mass_in_world() - self._start

    def metrics(self) -> GaitMetrics:
        """The trial so far."""
        robot, start, now = self.robot, self._start_totals, self.robot.totals()
        duration = max(robot.time - self._start_time, robot.dt)
        along = self._made + float(self.direction @ (robot.centre_of_mass_in_world() - self._turned_at)[:2])
        path = max(now.centre_path - start.centre_path, 1e-9)
        energy = now.electrical_energy - start.electrical_energy
        return GaitMetrics(
            duration=duration,
            speed=along / duration,
            speed_lps=along / duration / self._length,
            path=path,
            tips=self.tips,
            slip_share=(now.foot_path - start.foot_path) / path,
            slip_share_sum=(now.foot_path_sum - start.foot_path_sum) / path,
            energy=energy,
            drive_work=now.drive_work - start.drive_work,
            cost_of_transport=energy / (self._weight * along) if self._weight * along > 0 else math.inf,
            audit_excess=self._excess,
            peak_tension=now.peak_tension,
        )
