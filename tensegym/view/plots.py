"""Plots: tension, current and torque over the last seconds, each against its limit."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.plotting import COLOURS

from .frame import Frame
from .page import Page

SPAN = 10.0  # s that are shown
_MOST = 150  # points a line
_HEIGHT, _MARGIN = 172, (12, 12, 0, 0)  # pixels; above and to the right for half a number of an axis


class Plots:
    """Three plots of the drives and their cables, in a panel of their own."""

    def __init__(self, page: Page, design: RobotDesign) -> None:
        count = len(design.structure.stiff_cables)
        drive = max(design.each_drive, key=lambda each: each.torque_limit, default=design.drive)
        torque = drive.torque_limit
        self._rows: deque[FloatArray] = deque(maxlen=_MOST)
        self._panel = page.gui.add_panel()
        self._panel.dock_left()
        self._panel.set_width(340)
        names = [f"drive {d + 1}" for d in range(count)]
        with self._panel.add_tab("Drives"):
            page.gui.add_markdown("&ensp;".join(f'<span style="color:{_colour(n)}">&#9632;</span> {n + 1}'
                                                for n in range(count)))  # fmt: skip
            self._plots = [
                _plot(page, "tension of the wound cables [N]", names, torque / drive.spool_radius),
                _plot(page, "current [A]", names, drive.current_limit),
                _plot(page, "load torque at the spool [N m]", names, torque),
            ]

    def add(self, frame: Frame, wound: slice) -> None:
        """Take a frame in; what is shown changes with `draw`."""
        if self._rows and frame.time < self._rows[-1][0]:
            self._rows.clear()
        if not self._rows or frame.time - self._rows[-1][0] >= SPAN / _MOST:
            self._rows.append(np.concatenate([[frame.time], frame.tensions[wound], frame.currents, frame.torques]))

    def draw(self) -> None:
        """Show what was taken in."""
        if not self._rows:
            return
        times, *columns = np.array(self._rows).T
        count = len(columns) // 3
        for n, (plot, limit) in enumerate(self._plots):
            lines = columns[n * count : (n + 1) * count]
            plot.data = (times, *lines, np.full(len(times), limit))

    def remove(self) -> None:
        """Take the panel out of the page."""
        self._panel.remove()


def _colour(drive: int) -> str:
    return COLOURS[drive % len(COLOURS)]


def _plot(page: Page, title: str, names: list[str], limit: float) -> tuple[Any, float]:
    bare: dict[str, Any] = {"points": {"show": False}}
    lines = [{"label": name, "stroke": _colour(n), "width": 1.5, "dash": [] if n < len(COLOURS) else [5, 3], **bare}
             for n, name in enumerate(names)]  # fmt: skip
    limit_line = {"label": "limit", "stroke": "#888888", "width": 1, "dash": [6, 4], **bare}
    empty = tuple(np.zeros(1) for _ in range(len(lines) + 2))
    plot = page.gui.add_uplot(
        empty, ({"label": "time [s]"}, *lines, limit_line), title=title, height=_HEIGHT,
        scales={"x": {"time": False}}, legend={"show": False}, axes=({"label": "time [s]"}, {}), padding=_MARGIN,
    )  # fmt: skip
    return plot, limit
