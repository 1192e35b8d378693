"""storyboard.png and drives.png: one step of the robot, from face to face."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from tensegym.control.tipping import Tip, run_pull
from tensegym.plotting import COLOURS, new_figure, save, thin_legend
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import supporting_face

from .gait_figure import draw_currents, draw_tensions
from .recorder import Recorder
from .recording import Recording
from .video import frame

FRAMES = 6
PERIOD = 0.02  # s between two looks


def record_step(robot: TensegrityRobot, tip: Tip, settle: float = 0.5) -> Recording:
    """Run a step again and record it: the same start gives the same motion. It stands for ``settle`` [s] first; times
    are since the pull began."""
    names = robot.faces.names()
    recorder = Recorder(f"{robot.design.name}: from face {names[tip.from_face]} onto {names[tip.to_face]}", PERIOD)
    robot.reset(tip.from_face)
    robot.step(round(settle / robot.dt))
    begun = robot.time

    def watch(robot: TensegrityRobot) -> None:
        nodes, centre = robot.node_positions_in_world(), robot.centre_of_mass_in_world()
        recorder.look(robot, face=supporting_face(robot.faces, nodes, centre))

    run_pull(robot, tip.pull, watch, PERIOD)
    found = recorder.recording()
    return replace(found, times=found.times - begun)


def draw_storyboard(recording: Recording, out: Path) -> None:
    """FRAMES pictures of the step, in two rows, with the clock, the nodes' numbers and the colours' key."""
    figure, axes = new_figure(2, FRAMES // 2, size=(12, 6.6))
    rows = np.linspace(0, len(recording.times) - 1, FRAMES).round().astype(int).tolist()
    for axis, row in zip(axes.flat, rows, strict=True):
        axis.imshow(frame(recording, row, numbers=True, key=row == rows[-1]))
        axis.axis("off")
    figure.suptitle(recording.title)
    save(figure, out)


def draw_drives(recording: Recording, out: Path) -> None:
    """Angles, currents and cable tensions of the drives over the step."""
    figure, (angle, load, pull) = new_figure(3, size=(9, 10), sharex=True)
    for d in range(recording.angles.shape[1]):
        colour = COLOURS[d % len(COLOURS)]
        angle.plot(recording.times, recording.commands[:, d], "--", color=colour, lw=1)
        angle.plot(recording.times, recording.angles[:, d], color=colour, lw=1.5, label=f"drive {d + 1}")
    angle.set(ylabel="spool angle [rad]", title="Drives (dashed: commanded)")
    thin_legend(angle, columns=2)
    draw_currents(load, recording, names=False)
    draw_tensions(pull, recording)
    for axis in (angle, load):
        axis.set(xlabel="")
    save(figure, out)
