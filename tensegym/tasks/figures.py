"""gait.png and roll.mp4: what one episode looked like, and how it stands among all."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.files import replace_path
from tensegym.physics.drives import CURRENT
from tensegym.plotting import new_figure, save
from tensegym.robot.rendering import render

from .episode import Episode

FRAMES_PER_SECOND = 20


class GaitRecorder:
    """A watcher that keeps what `draw_gait` and `write_video` need, FRAMES_PER_SECOND times a second.

    Args:
        pictures: also render each time.
    """

    period = 1 / FRAMES_PER_SECOND

    def __init__(self, pictures: bool = False) -> None:
        self._pictures = pictures
        self.frames: list[NDArray[np.uint8]] = []
        self.times: list[float] = []
        self.centres: list[FloatArray] = []
        self.tensions: list[FloatArray] = []
        self.currents: list[FloatArray] = []
        self.faces: list[int] = []

    def __call__(self, episode: Episode) -> None:
        robot = episode.robot
        self.direction, self.robot = episode.bearing.direction, robot.design
        self.driven = robot.model.driven
        self.times.append(robot.time)
        self.centres.append(robot.centre_of_mass_in_world())
        self.tensions.append(robot.tensions.copy())
        self.currents.append(robot.drives[:, CURRENT].copy())
        self.faces.append(episode.meter.face)
        if self._pictures:
            self.frames.append(render(robot))


def draw_gait(record: GaitRecorder, speeds_lps: Sequence[float], out: Path) -> None:
    """Path with its tips, tensions, drive currents against their limit, and the speeds [L/s] of all episodes."""
    times, centres = np.array(record.times), np.array(record.centres)
    tensions, currents = np.array(record.tensions), np.array(record.currents)
    tips = np.flatnonzero(np.diff(record.faces)) + 1
    tension_limit = max(drive.current_limit * drive.torque_constant * drive.gear_ratio * drive.gear_efficiency
                        / drive.spool_radius for drive in record.robot.each_drive)  # fmt: skip
    figure, axes = new_figure(2, 2, size=(12, 9), layout="tight")
    (path, speeds), (pull, load) = axes

    way = (centres[:, :2] - centres[0, :2]) / record.robot.length
    path.plot(*way.T, "-", color="0.4", lw=1)
    path.scatter(*way[tips].T, s=18, color="tab:red", zorder=3, label=f"{len(tips)} tips")
    reach = float(np.abs(way).max())
    path.annotate("wanted direction", xytext=(0, 0), xy=tuple(record.direction * reach),
                  arrowprops={"arrowstyle": "->", "color": "tab:blue"}, color="tab:blue")  # fmt: skip
    path.set(xlabel="x [rod lengths]", ylabel="y [rod lengths]", aspect="equal", title="Way of the centre of mass")
    path.legend()

    speeds.hist(list(speeds_lps), bins=min(20, max(5, len(speeds_lps) // 5)), color="tab:blue")
    median = float(np.median(list(speeds_lps)))
    speeds.axvline(median, color="k", ls="--", label=f"median {median:.3f} L/s")
    speeds.set(xlabel="speed along the wanted direction [rod lengths/s]", ylabel="episodes", title="All episodes")
    speeds.legend()

    elastic = np.delete(tensions, np.arange(record.driven.start, record.driven.stop), axis=1)
    pull.fill_between(times, elastic.min(axis=1), elastic.max(axis=1), color="0.8", label="elastic, least to most")
    pull.plot(times, tensions[:, record.driven], lw=0.9)
    pull.axhline(tension_limit, color="k", ls="--", lw=1, label="drive's current limit")
    pull.set(xlabel="time [s]", ylabel="tension [N]", title="Cables (lines: stiff cables 1 to 6)")
    pull.legend()

    load.plot(times, currents, lw=0.9)
    for sign in (-1, 1):
        load.axhline(sign * max(drive.current_limit for drive in record.robot.each_drive), color="k", ls="--", lw=1)
    load.set(xlabel="time [s]", ylabel="current [A]", title="Drives 1 to 6 (dashed: limit)")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    save(figure, out)


def write_video(frames: Sequence[NDArray[np.uint8]], out: Path) -> None:
    """H.264."""
    from moviepy import ImageSequenceClip

    with replace_path(out) as fresh:
        ImageSequenceClip(list(frames), fps=FRAMES_PER_SECOND).write_videofile(str(fresh), logger=None, audio=False)
