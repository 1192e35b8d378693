"""Draws rolling.webp, the animation of the README: `python -m docs.animation`.

The shipped policy, from a seed of its evaluation, in real time; cables are coloured by tension.
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image

from tensegym.control.table import make_controller
from tensegym.robot.rendering import render
from tensegym.tasks.episode import Episode
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.rollout import rollout

SECONDS, WIDTH, HEIGHT = 8.0, 480, 360


class Frames:
    """Takes a picture a period."""

    period = 0.08  # s

    def __init__(self) -> None:
        self.pictures = list[Image.Image]()

    def __call__(self, episode: Episode) -> None:
        picture = render(episode.robot, WIDTH, HEIGHT, direction=episode.bearing.direction)
        self.pictures.append(Image.fromarray(picture))


def main(out: Path = Path(__file__).parent / "rolling.webp") -> None:
    """Roll, draw, write."""
    setup, frames = policy_setup("rolling", seconds=SECONDS), Frames()
    with setup.robot() as robot:
        result = rollout(robot, make_controller(setup.controller), setup.task, FIRST_SEED, watcher=frames)
    first, *rest = frames.pictures
    pace = round(1000 * frames.period)
    first.save(out, save_all=True, append_images=rest, duration=pace, loop=0, quality=60, method=2)
    print(f"{out}: {len(rest) + 1} pictures, {out.stat().st_size / 1e6:.2f} MB, {result.gait.speed_lps:.3f} L/s")


if __name__ == "__main__":
    main()
