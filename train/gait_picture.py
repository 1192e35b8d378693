"""gait.png and roll.mp4: what one episode looked like, and how it stands among all."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.envs.rolling import RollingEnv
from tensegym.physics.drives import CURRENT, ROTOR_ANGLE
from tensegym.robot.rendering import render


class GaitRecorder:
    """Call it with the environment after every step; keeps what `draw_gait` and `write_video` need."""

    def __init__(self, env: RollingEnv, frames: bool) -> None:
        self.fps = 20
        self.frames: list[np.ndarray] = []
        if frames:
            env.watch, env.watch_period = (lambda robot: self.frames.append(render(robot))), 1 / self.fps
        self.times: list[float] = []
        self.centres: list[np.ndarray] = []
        self.tensions: list[np.ndarray] = []
        self.currents: list[np.ndarray] = []
        self.angles: list[np.ndarray] = []
        self.faces: list[int] = []

    def __call__(self, env: RollingEnv) -> None:
        robot = env.robot
        self.direction = env.direction
        self.length = robot.design.length
        self.current_limit = robot.design.drive.current_limit
        self.driven = robot.model.driven
        drive = robot.design.drive
        self.tension_limit = (drive.current_limit * drive.torque_constant * drive.gear_ratio * drive.gear_efficiency
                              / drive.spool_radius)  # fmt: skip
        self.times.append(robot.time)
        self.centres.append(robot.centre_of_mass_in_world())
        self.tensions.append(robot.tensions.copy())
        self.currents.append(robot.drives[:, CURRENT].copy())
        self.angles.append(robot.drives[:, ROTOR_ANGLE] / drive.gear_ratio)
        self.faces.append(env.meter.face)


def draw_gait(record: GaitRecorder, rows: Sequence[dict[str, Any]], out: Path) -> None:
    """Path with its tips, tensions, drive currents against their limit, and the speeds of all episodes."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    times, centres = np.array(record.times), np.array(record.centres)
    tensions, currents = np.array(record.tensions), np.array(record.currents)
    tips = np.flatnonzero(np.diff(record.faces)) + 1
    figure, axes = plt.subplots(2, 2, figsize=(12, 9))
    (path, speeds), (pull, load) = axes

    way = (centres[:, :2] - centres[0, :2]) / record.length
    path.plot(*way.T, "-", color="0.4", lw=1)
    path.scatter(*way[tips].T, s=18, color="tab:red", zorder=3, label=f"{len(tips)} tips")
    reach = float(np.abs(way).max())
    path.annotate("wanted direction", xytext=(0, 0), xy=tuple(record.direction * reach),
                  arrowprops={"arrowstyle": "->", "color": "tab:blue"}, color="tab:blue")  # fmt: skip
    path.set(xlabel="x [rod lengths]", ylabel="y [rod lengths]", aspect="equal", title="Way of the centre of mass")
    path.legend()

    speeds.hist([row["speed_lps"] for row in rows], bins=min(20, max(5, len(rows) // 5)), color="tab:blue")
    median = float(np.median([row["speed_lps"] for row in rows]))
    speeds.axvline(median, color="k", ls="--", label=f"median {median:.3f} L/s")
    speeds.set(xlabel="speed along the wanted direction [rod lengths/s]", ylabel="episodes", title="All episodes")
    speeds.legend()

    elastic = np.delete(tensions, np.arange(record.driven.start, record.driven.stop), axis=1)
    pull.fill_between(times, elastic.min(axis=1), elastic.max(axis=1), color="0.8", label="elastic, least to most")
    pull.plot(times, tensions[:, record.driven], lw=0.9)
    pull.axhline(record.tension_limit, color="k", ls="--", lw=1, label="drive's current limit")
    pull.set(xlabel="time [s]", ylabel="tension [N]", title="Cables (lines: stiff cables 1 to 6)")
    pull.legend()

    load.plot(times, currents, lw=0.9)
    for sign in (-1, 1):
        load.axhline(sign * record.current_limit, color="k", ls="--", lw=1)
    load.set(xlabel="time [s]", ylabel="current [A]", title="Drives 1 to 6 (dashed: limit)")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(out, dpi=110)
    plt.close(figure)


def write_video(frames: Sequence[np.ndarray], fps: int, out: Path) -> None:
    """H.264."""
    from moviepy import ImageSequenceClip

    ImageSequenceClip(list(frames), fps=fps).write_videofile(str(out), logger=None, audio=False)
