"""Figures of `tensegym step`: the step run again with the camera on, its storyboard and its drives."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.control.tipping import Tip, run_pull
from tensegym.physics import drives as drive_kernel
from tensegym.plotting import new_figure, save
from tensegym.robot.rendering import render
from tensegym.robot.robot import TensegrityRobot

FRAMES = 6
PERIOD = 0.02  # s between two rows of the record


@dataclass
class StepRecord:
    """What a step looked like: every PERIOD a row, and FRAMES pictures."""

    times: list[float] = field(default_factory=list)
    """Since the pull began [s]."""
    drives: list[FloatArray] = field(default_factory=list)
    """(drives, STATE_SIZE) states of the drives."""
    angles: list[FloatArray] = field(default_factory=list)
    """(drives,) spool angles [rad]."""
    tensions: list[FloatArray] = field(default_factory=list)
    """(drives,) tensions of the driven cables [N]."""
    frames: list[tuple[float, NDArray[np.uint8]]] = field(default_factory=list)
    """Time [s] and picture (height, width, 3)."""


def record_step(robot: TensegrityRobot, tip: Tip, settle: float = 0.5) -> StepRecord:
    """Run the step again with the camera on: the same start gives the same motion."""
    record = StepRecord()
    robot.reset(tip.from_face)
    robot.step(round(settle / robot.dt))
    start = robot.time
    wanted = np.linspace(0, tip.pull.duration - PERIOD, FRAMES)

    def watch(robot: TensegrityRobot) -> None:
        now = robot.time - start
        record.times.append(now)
        record.drives.append(robot.drives.copy())
        record.angles.append(robot.drive_angles)
        record.tensions.append(robot.tensions[robot.model.driven].copy())
        if len(record.frames) < FRAMES and now >= wanted[len(record.frames)]:
            record.frames.append((now, render(robot)))

    run_pull(robot, tip.pull, watch, PERIOD)
    return record


def draw_storyboard(record: StepRecord, out: Path) -> None:
    """FRAMES pictures of the step, in two rows."""
    figure, axes = new_figure(2, FRAMES // 2, size=(12, 6.4), layout="tight")
    for axis, (time, frame) in zip(axes.flat, record.frames, strict=True):
        axis.imshow(frame)
        axis.set_title(f"t = {time:.2f} s")
        axis.axis("off")
    save(figure, out)


def draw_drives(record: StepRecord, out: Path) -> None:
    """Angles, torques and cable tensions of the drives over the step."""
    times, state = np.array(record.times), np.array(record.drives)
    figure, (angle, torque, tension) = new_figure(3, size=(9, 9), layout="tight", sharex=True)
    for d in range(state.shape[1]):
        colour = f"C{d}"
        angle.plot(times, state[:, d, drive_kernel.COMMAND], "--", color=colour, lw=0.8)
        angle.plot(times, np.array(record.angles)[:, d], color=colour, label=f"drive {d + 1}")
        torque.plot(times, 1e3 * state[:, d, drive_kernel.LOAD_TORQUE], color=colour)
        tension.plot(times, np.array(record.tensions)[:, d], color=colour)
    angle.set(ylabel="spool angle [rad]", title="Dashed: commanded; full: true")
    angle.legend(ncols=3)
    torque.set(ylabel="load torque at the spool [mN m]")
    tension.set(ylabel="tension of the stiff cable [N]", xlabel="time [s]")
    for axis in (angle, torque, tension):
        axis.grid(alpha=0.3)
    save(figure, out)
