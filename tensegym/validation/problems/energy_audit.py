"""The energy audit over a thousand episodes of random commands, and its worst one."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tensegym.control.random_commands import RandomCommands
from tensegym.robot.gait import AUDIT_TOLERANCE
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks import Roll
from tensegym.tasks.episode import Episode
from tensegym.tasks.rollout import rollout
from tensegym.validation.row import Findings, Row


class EnergyWatcher:
    """Energy [J] against what the start and the drives' work allow, every 20 ms of an episode."""

    def __init__(self) -> None:
        self.period = 0.02
        self.times: list[float] = []
        self.energy: list[float] = []
        self.allowed: list[float] = []
        self._start: float | None = None

    def __call__(self, episode: Episode) -> None:
        robot = episode.robot
        total, work = robot.energies().total, robot.totals().drive_work
        self._start = total - work if self._start is None else self._start
        self.times.append(robot.time)
        self.energy.append(total)
        self.allowed.append(self._start + work)

    @property
    def excess(self) -> float:
        """Largest part by which the energy was over what is allowed, negative where it never was."""
        return max((e / a - 1 for e, a in zip(self.energy[1:], self.allowed[1:], strict=True)), default=-1.0)


def energy_audit(engine: str, episodes: int = 1000, seconds: float = 3.0, dt: float = 2e-3) -> Findings:
    """Kinetic, gravity and elastic energy may never exceed the start's and the drives' work by more than 1 %. Looked at
    every 20 ms of every episode; the worst one is played again at half the time step."""
    watchers, lost = _watched(engine, dt, seconds, range(episodes))
    excess = np.array([watcher.excess for watcher in watchers])
    seed = int(excess.argmax())
    worst, ((finer,), _) = watchers[seed], _watched(engine, dt / 2, seconds, [seed])
    rows = [Row("audit", f"episodes of {episodes} that fail", 0, int((excess > AUDIT_TOLERANCE).sum()), 0.0, dt),
            Row("audit", f"episodes of {episodes} that diverge", 0, lost, 0.0, dt),
            Row("audit", "largest excess, part of what is allowed", 0.0, max(0.0, worst.excess), AUDIT_TOLERANCE, dt,
                _explained(worst, finer, seed)),
            Row("audit", "of the same episode at half the step", 0.0, max(0.0, finer.excess), AUDIT_TOLERANCE, dt / 2)]
    return Findings(rows, {"excess": np.sort(excess).tolist(), "worst seed": seed, "time, s": worst.times,
                           "energy, J": worst.energy, "allowed, J": worst.allowed})  # fmt: skip


def _watched(engine: str, dt: float, seconds: float, seeds: Iterable[int]) -> tuple[list[EnergyWatcher], int]:
    """Episodes of random commands, and how many of them diverged."""
    task, watchers, lost = Roll(dt=dt, seconds=seconds, patience=seconds), [], 0
    with TensegrityRobot(dt=dt, engine=engine) as robot:
        for seed in seeds:
            watchers.append(EnergyWatcher())
            lost += rollout(robot, RandomCommands(), task, seed, watcher=watchers[-1]).diverged
    return watchers, lost


def _explained(worst: EnergyWatcher, finer: EnergyWatcher, seed: int) -> str:
    over = np.array(worst.energy) / np.array(worst.allowed) - 1
    at = int(over[1:].argmax()) + 1
    by, lost = worst.energy[at] - worst.allowed[at], worst.allowed[-1] - worst.energy[-1]
    how = f"over by {1e3 * by:.3g} mJ" if by > 0 else f"nearest, {-1e3 * by:.3g} mJ below"
    why = (" It is the time step's: at half of it the energy stays below what is allowed." if by > 0 > finer.excess
           else "")  # fmt: skip
    return (f"The worst, seed {seed}, is {how}, of {worst.allowed[at]:.3g} J, {worst.times[at] - worst.times[0]:.2g} s "
            f"after its start.{why} At its end dampers, friction and gears have taken "
            f"{lost:.3g} J.")  # fmt: skip
