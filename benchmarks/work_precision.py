"""Simulated seconds a processor second against the error of the motion: ours in both engines, and MuJoCo alone.

    python benchmarks/work_precision.py        prints the tables, writes docs/work_precision.png

The robot tumbles in free flight; every other stiff cable is wound in for 0.3 s and paid out for as long, at the drives'
speed, then all are held until 1 s. Rest lengths are that function of time for all, taken before every step, and some
cables fall slack and snap taut. MuJoCo alone is the robot as `tensegym export` writes it, its cables MuJoCo's own
tendons. There is no spin damping, since MuJoCo has none. The error is the RMS, over the nodes
and over every 20 ms, of node positions about the centre of mass, against the same engine at its finest step; how far
the two finest motions are apart is what the two differ in. Schemes of one force a step keep velocities half a
step before the poses and start with those. Time is taken while the cables are held.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib
import mujoco
import numpy as np
from scipy.spatial.transform import Rotation
from timing import OneCore, in_turn, machine

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError, SimulationError
from tensegym.mujoco.robot_mjcf import robot_mjcf
from tensegym.physics.geometry import points_at
from tensegym.physics.readings import step_back
from tensegym.physics.robot_arrays import robot_model
from tensegym.report import table
from tensegym.robot.robot import TensegrityRobot

DESIGN = RobotDesign(spin_damping=0.0, drive=replace(RobotDesign().drive, speed_limit=1e-9))  # locked: see natural_at
BARE = DESIGN.with_(stiff_cable=replace(DESIGN.stiff_cable, damping=0.0))
INTEGRATORS = {"MuJoCo Euler": "Euler", "MuJoCo implicitfast": "implicitfast", "MuJoCo RK4": "RK4"}
MODEL = robot_model(DESIGN)
SPIN = np.array([2.0, 3.0, 1.0])  # rad/s, of the whole robot at the start
DEPTHS = np.array([0.06, 0, 0.06, 0, 0.06, 0])  # m
TURN, HELD, SECONDS, SAMPLE = 0.3, 0.6, 1.0, 0.02  # s: winding ends, paying out ends, the end, between two samples
STEPS = (1e-4, 2e-4, 5e-4, 1e-3, 1.25e-3, 2e-3, 4e-3, 5e-3)  # s
ROUNDS = 9
PICTURE = Path(__file__).parent.parent / "docs" / "work_precision.png"


def natural_at(t: float) -> FloatArray:
    """Rest lengths (c,) of all cables [m]."""
    natural = MODEL.rest_lengths.copy()
    natural[MODEL.driven] -= DEPTHS * max(0.0, min(t, HELD - t)) / TURN
    return natural


def start() -> tuple[FloatArray, FloatArray]:
    """Poses (b, 7) and velocities (b, 6) of the standing robot, turning as one body about its centre of mass."""
    poses, velocities = MODEL.rest_poses.copy(), np.empty((len(MODEL.masses), 6))
    poses[:, :3] -= MODEL.masses @ poses[:, :3] / MODEL.masses.sum()
    velocities[:, :3], velocities[:, 3:] = np.cross(SPIN, poses[:, :3]), SPIN
    return poses, velocities


class Ours:
    """Our robot; ``lag`` is how far the velocities are behind the poses, in steps."""

    lag = 0.5

    def __init__(self, integrator: Any, dt: float, design: RobotDesign = DESIGN, engine: str = "pybullet") -> None:
        self.dt = dt
        self.robot = TensegrityRobot(design, dt=dt, ground=False, integrator=integrator, engine=engine)
        self.poses, self.velocities = lambda: self.robot.poses_in_world, self.robot.velocities_in_world

    def place(self, poses: FloatArray, velocities: FloatArray) -> None:
        self.robot.reset_rotated(Rotation.identity(), velocities)

    def step(self, natural: FloatArray, count: int) -> None:
        self.robot.natural_lengths[:] = natural
        self.robot.step(count)


class Theirs:
    """MuJoCo alone, likewise. Raises SimulationError where it warns that it has diverged."""

    def __init__(self, integrator: str, dt: float, design: RobotDesign = DESIGN) -> None:
        self.dt, self.lag = dt, 0.0 if integrator == "RK4" else 0.5
        text = robot_mjcf(design, dt=dt, integrator=integrator, ground=False)
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)

    def place(self, poses: FloatArray, velocities: FloatArray) -> None:
        mujoco.mj_resetData(self.model, self.data)
        coordinates, speeds = self.data.qpos.reshape(-1, 7), self.data.qvel.reshape(-1, 6)
        coordinates[:, :3], coordinates[:, 3:] = poses[:, :3], np.roll(poses[:, 3:], 1, axis=1)
        speeds[:, :3] = velocities[:, :3]
        speeds[:, 3:] = Rotation.from_quat(poses[:, 3:]).inv().apply(velocities[:, 3:])  # body axes

    def poses(self) -> FloatArray:
        poses = self.data.qpos.reshape(-1, 7).copy()
        poses[:, 3:] = np.roll(poses[:, 3:], -1, axis=1)
        return poses

    def velocities(self) -> FloatArray:
        velocities = self.data.qvel.reshape(-1, 6).copy()
        velocities[:, 3:] = Rotation.from_quat(self.poses()[:, 3:]).apply(velocities[:, 3:])
        return velocities

    def step(self, natural: FloatArray, count: int) -> None:
        self.data.ctrl[:] = (MODEL.rest_lengths - natural)[MODEL.driven]
        mujoco.mj_step(self.model, self.data, nstep=count)
        if any(warning.number for warning in self.data.warning):
            raise SimulationError(f"MuJoCo diverged at {self.dt:g} s")


@dataclass(frozen=True)
class Motion:
    """Node positions about the centre of mass (samples, n, 3) [m], largest relative change of angular momentum,
    simulated seconds a second of processor time, one for each round.
    """

    nodes: FloatArray
    drift: float
    paces: FloatArray

    @property
    def pace(self) -> float:
        return float(np.median(self.paces))

    def error(self, other: Motion) -> float:
        """RMS distance [m]."""
        return float(np.sqrt(((self.nodes - other.nodes) ** 2).sum(axis=2).mean()))


def angular_momentum(robot: Ours | Theirs) -> FloatArray:
    """(3,) about the world's origin [kg m^2/s], at the time of the velocities."""
    velocities = robot.velocities()
    poses = robot.poses().copy()
    step_back(poses, velocities, robot.lag * robot.dt)
    turns = Rotation.from_quat(poses[:, 3:])
    spin = turns.apply(MODEL.inertias * turns.inv().apply(velocities[:, 3:]))
    return (MODEL.masses[:, None] * np.cross(poses[:, :3], velocities[:, :3]) + spin).sum(axis=0)


def move(robot: Ours | Theirs, acceleration: FloatArray) -> Motion:
    """The motion; accelerations (b, 6) at its start tell the velocities a little before."""
    poses, velocities = start()
    robot.place(poses, velocities - robot.lag * robot.dt * acceleration)
    count, spent = round(SAMPLE / robot.dt), 0.0
    nodes, momenta = [], [angular_momentum(robot)]
    for sample in range(round(SECONDS / SAMPLE)):
        t = sample * SAMPLE
        if t < HELD - SAMPLE / 2:
            for i in range(count):  # Runge-Kutta steps take the middle's, the others that of their one force
                robot.step(natural_at(t + (i + 0.5 - robot.lag) * robot.dt), 1)
        else:
            began = time.thread_time()
            robot.step(natural_at(t), count)
            spent += time.thread_time() - began
        poses = robot.poses()
        at = points_at(poses, MODEL.node_bodies, MODEL.node_points)
        nodes.append(at - MODEL.masses @ poses[:, :3] / MODEL.masses.sum())
        momenta.append(angular_momentum(robot))
    drift = np.linalg.norm(np.array(momenta) - momenta[0], axis=1).max() / np.linalg.norm(momenta[0])
    return Motion(np.array(nodes), float(drift), np.array([(SECONDS - HELD) / spent]))


def pace(robot: Ours | Theirs, acceleration: FloatArray) -> float:
    return move(robot, acceleration).pace


def start_acceleration() -> FloatArray:
    """(b, 6) at the start, from one microsecond of ours."""
    robot, (poses, velocities) = Ours("explicit", 1e-6), start()
    robot.place(poses, velocities)
    robot.step(natural_at(0), 1)
    return (robot.velocities() - velocities) / robot.dt


EXPLICIT, IMPLICIT, RK4 = "ours, explicit", "ours, implicit", "MuJoCo RK4"
IN_MUJOCO = "ours, implicit, in MuJoCo"
SCHEMES: dict[str, Callable[..., Ours | Theirs]] = {
    EXPLICIT: partial(Ours, "explicit"), IMPLICIT: partial(Ours, "implicit"),
    IN_MUJOCO: partial(Ours, "implicit", engine="mujoco"),
    **{name: partial(Theirs, kind) for name, kind in INTEGRATORS.items()},
}  # fmt: skip
FINEST = {EXPLICIT: 1e-5, RK4: 5e-5}  # s
DEFAULT = 2e-3  # s, implicit: the environments'
REFUSED, DIVERGED = "refused", "diverged"


def finest(acceleration: FloatArray, design: RobotDesign) -> list[Motion]:
    """Ours and MuJoCo's."""
    return [move(SCHEMES[name](dt, design), acceleration) for name, dt in FINEST.items()]


def measure(acceleration: FloatArray, rounds: int) -> dict[str, dict[float, Motion | str]]:
    """Of every scheme the motions by time step, with the paces of all rounds, or why there is none."""
    seen: dict[str, dict[float, Motion | str]] = {name: {} for name in SCHEMES}
    runs: dict[str, Callable[[], float]] = {}
    for name, dt in [(name, dt) for dt in STEPS for name in SCHEMES]:
        try:
            robot = SCHEMES[name](dt)
            seen[name][dt] = move(robot, acceleration)
            runs[f"{name} {dt}"] = partial(pace, robot, acceleration)
        except DesignError:
            seen[name][dt] = REFUSED
        except SimulationError:
            seen[name][dt] = DIVERGED
    paces = in_turn(runs, rounds)
    for name, motions in seen.items():
        for dt, motion in motions.items():
            if isinstance(motion, Motion):
                motions[dt] = replace(motion, paces=np.array(paces[f"{name} {dt}"]))
    return seen


def draw(seen: dict[str, dict[float, Motion | str]], ours: Motion, theirs: Motion, out: Path) -> None:
    """Pace against error, and drift of angular momentum against time step."""
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5.5), layout="constrained")
    for name, motions in seen.items():
        good = {dt: motion for dt, motion in motions.items() if isinstance(motion, Motion)}
        without = [f"{why} at {', '.join(f'{1e3 * dt:g}' for dt in steps)} ms" for why in (REFUSED, DIVERGED)
                   if (steps := [dt for dt, motion in motions.items() if motion == why])]  # fmt: skip
        errors = {dt: 1e3 * motion.error(theirs if name in INTEGRATORS else ours) for dt, motion in good.items()}
        paces = {dt: motion.pace for dt, motion in good.items()}
        (line,) = left.loglog(list(errors.values()), list(paces.values()), "o-", ms=4,
                              label="; ".join([name, *without]))  # fmt: skip
        right.loglog([1e3 * dt for dt in good], [motion.drift for motion in good.values()], "o-", ms=4)
        for dt, error in errors.items():
            left.annotate(f"{1e3 * dt:g}", (error, paces[dt]), (3, 4), textcoords="offset points", fontsize=7,
                          color=line.get_color())  # fmt: skip
        if name == IMPLICIT:
            left.plot(errors[DEFAULT], paces[DEFAULT], "*", ms=15, color=line.get_color(),
                      label="the environments' time step")  # fmt: skip
    left.axvline(1e3 * ours.error(theirs), color="0.5", ls="--", lw=1, label="finest motions of both apart")
    left.set(xlabel="RMS error of node positions over 1 s [mm]", ylabel="simulated seconds a processor second",
             title="Work against precision (numbers: time step [ms])")  # fmt: skip
    right.set(xlabel="time step [ms]", ylabel="largest relative change in 1 s [-]",
              title="Angular momentum in free flight")  # fmt: skip
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=3, fontsize=8)
    figure.savefig(out, dpi=110)
    plt.close(figure)


def main() -> None:
    mujoco.set_mju_user_warning(lambda message: None)  # it would write a log file; `Theirs` looks at the counts
    with OneCore():
        acceleration = start_acceleration()
        ours, theirs = finest(acceleration, DESIGN)
        ours_bare, theirs_bare = finest(acceleration, BARE)
        seen = measure(acceleration, ROUNDS)
    rows: list[list[object]] = []
    for name, motions in seen.items():
        for dt, motion in motions.items():
            if isinstance(motion, Motion):
                own = motion.error(theirs if name in INTEGRATORS else ours)
                rows.append([name, 1e3 * dt, 1e3 * own, 1e3 * motion.error(ours), motion.drift, motion.pace])
            else:
                rows.append([name, 1e3 * dt, motion, "", "", ""])
    print(machine(), end="\n\n")
    print(table(["scheme", "dt_ms", "error_mm", "against_ours_mm", "drift", "pace"], rows))
    print(f"\nfinest motions, {FINEST} s, apart: {1e3 * ours.error(theirs):.3g} mm; "
          f"without dampers on the stiff cables: {1e3 * ours_bare.error(theirs_bare):.3g} mm")  # fmt: skip
    default = seen[IMPLICIT][DEFAULT]
    others = (EXPLICIT, 1e-3), (EXPLICIT, 1.25e-3), (IMPLICIT, 4e-3), (IN_MUJOCO, 2e-3), ("MuJoCo Euler", 1e-3)
    for name, dt in others:
        other = seen[name][dt]
        assert isinstance(default, Motion) and isinstance(other, Motion)
        low, ratio, high = np.quantile(default.paces / other.paces, [0.1, 0.5, 0.9])
        print(f"pace of {IMPLICIT}, 2 ms / {name}, {1e3 * dt:g} ms: {ratio:.2f}, 10 to 90 % {low:.2f} to {high:.2f}")
    draw(seen, ours, theirs, PICTURE)


if __name__ == "__main__":
    main()
