"""The robot on the ground: its contacts, its way against the time step, how fast two ways part."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.bearing import Bearing
from tensegym.control.table import make_controller
from tensegym.engine import GROUND
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks import Roll
from tensegym.tasks.episode import Episode, Watcher
from tensegym.tasks.goal import unit
from tensegym.tasks.rollout import Result, rollout
from tensegym.validation.row import Findings, Row

STEPS = (0.5e-3, 1e-3, 2e-3, 4e-3)
FAR, SAMPLE = 1e-2, 0.1  # m, of the size of what a tip makes; s


def walks(engine: str, dt: float, seconds: float, seeds: int, watcher: Watcher | None = None) -> list[Result]:
    """Episodes of the open-loop walker, which needs nothing that was learned."""
    task = Roll(dt=dt, seconds=seconds, patience=seconds)
    with TensegrityRobot(dt=dt, engine=engine) as robot:
        walker = make_controller({"kind": "walker"})
        return [rollout(robot, walker, task, seed, watcher=watcher) for seed in range(seeds)]


class ContactWatcher:
    """Worst of what contacts may not do, and forces against gaps, over an episode."""

    def __init__(self, period: float = 0.02) -> None:
        self.period = period
        self.least_push, self.most_friction, self.deepest = np.inf, 0.0, 0.0
        self.points: list[list[float]] = []

    def __call__(self, episode: Episode) -> None:
        for contact in episode.robot.world.contacts():
            self.least_push = min(self.least_push, contact.push)
            if contact.other != GROUND:
                continue
            if contact.push > 0.1:
                self.most_friction = max(self.most_friction, float(np.linalg.norm(contact.friction)) / contact.push)
            self.deepest = max(self.deepest, -contact.distance)
            self.points.append([1e3 * contact.distance, contact.push])


def contacts(engine: str, seeds: int = 10, seconds: float = 20.0) -> Findings:
    """While the walker rolls the robot, contacts push and never pull, friction stays within mu times the push, and what
    is further apart than 2 m/s close in a step does not push."""
    watcher, dt = ContactWatcher(), 2e-3
    walks(engine, dt, seconds, seeds, watcher)
    points = np.array(watcher.points)
    apart = points[points[:, 0] > 2e3 * dt, 1]
    rows = [Row("contacts", "least push, N, where it pulls", 0.0, min(watcher.least_push, 0.0), 0.0, dt),
            Row("contacts", "largest friction over push (mu 0.8)", 0.8, watcher.most_friction, 0.008, dt),
            Row("contacts", "largest push over a gap of 4 mm or more, N", 0.0, float(apart.max(initial=0.0)), 1e-9, dt),
            Row("contacts", "deepest overlap, mm", 0.0, 1e3 * watcher.deepest, 1.0, dt)]  # fmt: skip
    some = points[np.random.default_rng(0).permutation(len(points))[:2000]]
    return Findings(rows, {"gap, mm": some[:, 0].tolist(), "push, N": some[:, 1].tolist()})


def time_steps(engine: str, seeds: int = 24, seconds: float = 12.0) -> Findings:
    """The walker's mean speed at four time steps: intervals of 95 % that overlap, though no path is the same."""
    rows = []
    speeds = {dt: np.array([r.gait.speed_lps for r in walks(engine, dt, seconds, seeds)]) for dt in STEPS}
    base = speeds[1e-3]
    for dt in STEPS:
        if dt != 1e-3:
            width = 1.96 * np.sqrt(base.var(ddof=1) / seeds + speeds[dt].var(ddof=1) / seeds)
            rows.append(Row("steps", "mean speed of the walker, L/s, beside that at 1 ms (95 % of the difference)",
                            float(base.mean()), float(speeds[dt].mean()), float(width), dt))  # fmt: skip
    half = {dt: 1.96 * s.std(ddof=1) / np.sqrt(seeds) for dt, s in speeds.items()}
    return Findings(rows, {"time step, ms": [1e3 * dt for dt in STEPS],
                           "mean speed, L/s": [float(s.mean()) for s in speeds.values()],
                           "half of its 95 %": [float(h) for h in half.values()]})  # fmt: skip


def parting(engine: str, seeds: int = 6, seconds: float = 40.0) -> Findings:
    """Two robots that the policy `rolling` rolls, one of them pushed by a nanometre a second: they part by a factor e
    every 1 / rate, up to the size of a tip. Beyond that no path of rolling can be compared; statistics can."""
    curves, rates, dt = [], [], 2e-3
    for seed in range(seeds):
        apart = _rolled(engine, dt, seconds, seed, 1e-9) - _rolled(engine, dt, seconds, seed)
        size = np.sqrt((apart**2).sum(axis=2).mean(axis=1))
        curves.append((1e3 * size).tolist())
        stop = int(np.argmax(size > FAR)) or len(size)
        rates.append(float(np.log(size[stop - 1] / size[0]) / (SAMPLE * max(1, stop - 1))))
    note = f"They part by a factor e every {1 / np.mean(rates):.2g} s, the mean of {seeds} runs."
    parted = sum(max(curve) > 1e3 * FAR for curve in curves)
    rows = [Row("parting", f"runs of {seeds} that a push of 1 nm/s takes 1 cm apart in {seconds:g} s", seeds, parted,
                0.0, dt, note)]  # fmt: skip
    times = (SAMPLE * np.arange(1, len(curves[0]) + 1)).tolist()
    return Findings(rows, {"time, s": times, "apart, mm": curves, "rate, 1/s": rates})


def _rolled(engine: str, dt: float, seconds: float, seed: int, push: float = 0.0) -> FloatArray:
    """Nodes (samples, n, 3) of a robot under the policy, from rest on a face."""
    policy, nodes, bearing = make_controller({"kind": "policy", "policy": "rolling"}), [], Bearing(unit(0.0))
    with TensegrityRobot(dt=dt, engine=engine) as robot:
        robot.reset(seed % len(robot.faces.triangles), 0.3 * seed)
        robot.push([push, 0, 0])
        policy.begin(robot, seed)
        each = round(policy.period / SAMPLE)
        for tick in range(round(seconds / SAMPLE)):
            if tick % each == 0:
                robot.command(policy.angles(robot, bearing))
            robot.step(round(SAMPLE / dt))
            nodes.append(robot.node_positions_in_world())
    return np.array(nodes)
