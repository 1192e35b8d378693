"""A robot on each obstacle of the course: one picture of all, and a video of each and of all in a row.

    python benchmarks/course_pictures.py --policy rolling --picture docs/course.png --videos course

Of each obstacle the first start is shown from which the policy passes it, else the first one.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro
from numpy.typing import NDArray
from PIL import Image

from tensegym.control.table import make_controller
from tensegym.files import replace_path
from tensegym.plotting import COLOURS, new_figure, save
from tensegym.robot.rendering import render
from tensegym.robot.sight import FULL_SCALE, tension_colours
from tensegym.tasks.course import Course
from tensegym.tasks.episode import Episode
from tensegym.tasks.motions import as_task
from tensegym.tasks.obstacles import OBSTACLES
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.rollout import rollout


class Frames:
    """A watcher that keeps pictures, and which of them has the robot nearest the obstacle's middle."""

    period = 0.1

    def __init__(self, middle: float) -> None:
        self._middle, self._off, self.nearest = middle, np.inf, 0
        self.frames: list[NDArray[np.uint8]] = []

    def __call__(self, episode: Episode) -> None:
        off = abs(float(episode.robot.centre_of_mass_in_world()[0]) - self._middle)
        if off < self._off:
            self._off, self.nearest = off, len(self.frames)
        self.frames.append(render(episode.robot, direction=episode.bearing.direction))


@dataclass(frozen=True)
class Pictures:
    """A picture of all obstacles, a video of each and of all in a row."""

    policy: str = "rolling"
    """A shipped policy or a run's folder."""
    starts: int = 3
    """Starts looked at."""
    picture: Path = Path("course.png")
    """File to write."""
    videos: Path | None = None
    """Folder for a WebP animation of each."""

    def run(self) -> str:
        figure, axes = new_figure(2, 3, size=(12, 6.4), layout="tight")
        lines = []
        for axis, name in zip(axes.flat, OBSTACLES, strict=False):
            watched, ended = self._watched(name)
            axis.imshow(watched.frames[watched.nearest])
            axis.set_title(name)
            lines.append(f"{name}: {ended} after {len(watched.frames) * watched.period:.0f} s")
            if self.videos:
                _film(watched, self.videos / f"{name}.webp")
        if self.videos:
            watched, ended = self._watched("all")
            _film(watched, self.videos / "all.webp")
            lines.append(f"all: {ended} after {len(watched.frames) * watched.period:.0f} s")
        for axis in axes.flat:
            axis.axis("off")
        _draw_key(axes.flat[-1])
        save(figure, self.picture)
        return "\n".join(lines)

    def _watched(self, name: str) -> tuple[Frames, str]:
        task = as_task({"motion": "course", "obstacle": name})
        setup = policy_setup(self.policy, task=task)
        assert isinstance(task, Course)
        layout = task.layout(setup.design.length)
        first = None
        with closing(setup.robot()) as robot:
            for seed in range(FIRST_SEED, FIRST_SEED + self.starts):
                frames = Frames(float(layout.begins[0] + layout.ends[0]) / 2)
                result = rollout(robot, make_controller(setup.controller), setup.task, seed, watcher=frames)
                first = first or (frames, result.ended)
                if result.measures["success"]:
                    return frames, result.ended
        assert first is not None
        return first


def _film(watched: Frames, file: Path) -> None:
    """An animation at true speed, of half the pictures' size, which is a fifth of the bytes."""
    file.parent.mkdir(parents=True, exist_ok=True)
    first, *rest = (Image.fromarray(frame).reduce(2) for frame in watched.frames[::2])
    with replace_path(file) as fresh:
        pace = round(2000 * watched.period)
        first.save(fresh, format="webp", save_all=True, append_images=rest, duration=pace, quality=60)


def _draw_key(axis: Any) -> None:
    """What colours and arrow mean."""
    bar = axis.inset_axes((0.1, 0.62, 0.8, 0.07))
    bar.imshow(tension_colours(np.linspace(0, FULL_SCALE, 200))[None].astype(np.uint8), aspect="auto",
               extent=(0, FULL_SCALE, 0, 1))  # fmt: skip
    bar.set(yticks=(), xlabel="tension of a cable [N]; grey where slack")
    axis.set(xlim=(0, 1), ylim=(0, 1))
    axis.annotate("", (0.1, 0.3), (0.3, 0.3), arrowprops={"arrowstyle": "->", "color": COLOURS[0], "lw": 3})
    axis.text(0.35, 0.3, "wanted direction", va="center")


if __name__ == "__main__":
    print(tyro.cli(Pictures).run())
