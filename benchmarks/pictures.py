"""What a picture costs: the package's own painter beside PyBullet's software renderer, whose picture lacks the cables.

    python benchmarks/pictures.py
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

from tensegym.report import table
from tensegym.robot.rendering import render
from tensegym.robot.robot import TensegrityRobot

ROUNDS = 15


def seconds(call: Callable[[], object]) -> float:
    """That one call takes [s]."""
    begun = time.perf_counter()
    call()
    return time.perf_counter() - begun


def main() -> None:
    rows = []
    with TensegrityRobot(dt=2e-3) as robot:
        robot.command(0.5 * robot.command_limit)
        robot.step(300)
        camera = robot.world.camera  # type: ignore[attr-defined]  # PyBullet's
        for width, height in ((84, 84), (320, 240), (480, 360), (640, 480)):
            ours: Callable[[], object] = lambda w=width, h=height: render(robot, w, h)  # noqa: E731
            theirs: Callable[[], object] = lambda w=width, h=height: camera.image([1.5, 1.5, 1], [0, 0, 0.2], w, h)  # noqa: E731
            pairs = [(seconds(ours), seconds(theirs)) for _ in range(ROUNDS + 1)][1:]
            mine, other = (statistics.median(column) for column in zip(*pairs, strict=True))
            ratios = np.quantile([b / a for a, b in pairs], [0.25, 0.75])
            spread = "{:.3g} to {:.3g}".format(*ratios)
            rows.append([f"{width} x {height}", 1e3 * mine, 1e3 * other, other / mine, spread])
    print(table(["picture", "painter ms", "TinyRenderer ms", "ratio", "middle half"], rows))


if __name__ == "__main__":
    main()
