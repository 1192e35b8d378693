"""Player: recordings in a page, side by side where there are several, with a slider over their time."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from tensegym.replay import Recording

from .frame import Frame, Stage
from .page import Page
from .plots import Plots
from .robot_scene import RobotScene
from .session import PERIOD
from .surroundings import Surroundings

SPEEDS = {"1/10": 0.1, "1/4": 0.25, "1": 1.0, "2": 2.0, "5": 5.0}
_APART = 2.0  # rod lengths between robots that stand side by side
_BESIDE = 6  # frames between two changes of the plots


class Player:
    """Plays recordings; the ground and the plots are the first one's.

    Args:
        page: to draw into.
        recordings: one or more.
        names: what stands above each robot, where there are several.
    """

    def __init__(self, page: Page, recordings: Sequence[Recording], names: Sequence[str] = ()) -> None:
        self.page, self.recordings = page, recordings
        first = recordings[0]
        self.seconds = max(each.seconds for each in recordings)
        self._ended, self._returned = threading.Event(), threading.Event()
        length = max(each.design.length for each in recordings)
        width = _APART * length * (len(recordings) - 1)
        away = 1.75 * (0.5 * width + 0.8 * length)  # all of a row between the panels
        page.initial_camera.position = (
            (away, 0.0, 0.45 * away) if width else (1.5 * length, -1.7 * length, 0.9 * length)
        )
        page.initial_camera.look_at = (0.0, 0.0, 0.4 * length)
        self.surroundings = Surroundings(page, Stage(first.design, first.ground, first.gravity, first.path))
        self.scenes = []
        for n, each in enumerate(recordings):
            across = _APART * length * n - width / 2
            stage = Stage(each.design, each.ground, each.gravity, each.path)
            self.scenes.append(RobotScene(page, stage, f"/world/robot {n + 1}", across))
            if names:
                page.scene.add_label(f"/world/name {n + 1}", names[n], position=(0.0, across, 1.2 * length),
                                     anchor="bottom-center")  # fmt: skip
        self._panel(page, first, f"The plots are of: {names[0]}" if names else first.title or first.design.name)
        self.show(0.0)

    def _panel(self, page: Page, first: Recording, title: str) -> None:
        page.gui.main_panel.dock_right()
        page.gui.add_markdown(title)
        self._play = page.gui.add_button("pause")
        self._play.on_click(lambda _: self._toggle())
        step = max(1e-3, round(self.seconds / 1000, 3))
        self.slider = page.gui.add_slider("time [s]", 0.0, max(step, self.seconds), step, 0.0)
        self.slider.on_update(self._scrub)
        self._speed = page.gui.add_dropdown("speed", tuple(SPEEDS), initial_value="1")
        self._follow = page.gui.add_checkbox("follow the robot", len(self.scenes) == 1)
        support = page.gui.add_checkbox("support and centre of mass", True)
        numbers = page.gui.add_checkbox("node numbers", False)
        for tick in (support, numbers):
            tick.on_update(lambda _: self._dress(support.value, numbers.value))
        self.plots = Plots(page, first.design)
        self.playing, self.time, self._wanted, self._shown = True, 0.0, 0.0, 0

    def _dress(self, support: bool, numbers: bool) -> None:
        for scene in self.scenes:
            scene.show_support(support)
            scene.show_numbers(numbers)

    def _toggle(self) -> None:
        self.playing = not self.playing
        self._play.label = "pause" if self.playing else "play"

    def _scrub(self, event: Any) -> None:
        if event.client_id is not None:  # a user's, not the player's own
            if self.playing:
                self._toggle()
            self._wanted = self.slider.value

    def show(self, seconds: float) -> None:
        """Show all recordings at a time since their start [s]; one that is over stays as it ended."""
        self.time = seconds
        with self.page.atomic():
            for scene, recording in zip(self.scenes, self.recordings, strict=True):
                frame = frame_at(recording, seconds)
                scene.draw(frame)
                if scene is self.scenes[0]:
                    self.surroundings.draw(frame, scene.centre)
                    self.plots.add(frame, recording.model.driven)
            if self._follow.value:
                self.surroundings.follow(self.scenes[0].centre)
        self._shown += 1
        if self._shown % _BESIDE == 0 or not self.playing:
            self.plots.draw()
            self.slider.value = round(min(seconds, self.slider.max), 3)

    def run(self) -> None:
        """Until it is interrupted, or told to `end`; a recording that is over begins again."""
        last = time.perf_counter()
        try:
            while not self._ended.is_set():
                now = time.perf_counter()
                if self.playing:
                    self._wanted = self.time + (now - last) * SPEEDS[self._speed.value]
                    self._wanted = 0.0 if self._wanted > self.seconds else self._wanted
                if self._wanted != self.time:
                    self.show(self._wanted)
                last = now
                time.sleep(max(0.0, PERIOD - (time.perf_counter() - now)))
        finally:
            self._returned.set()

    def end(self) -> None:
        """Let `run`, in whichever thread it is, return."""
        self._ended.set()
        self._returned.wait()


def frame_at(recording: Recording, seconds: float) -> Frame:
    """The row of a recording that is last at a time since its start [s]."""
    row = int(np.searchsorted(recording.times, recording.times[0] + seconds + 1e-9, side="right")) - 1
    row = min(max(row, 0), len(recording.times) - 1)
    return Frame(
        float(recording.times[row]), recording.poses[row], recording.tensions[row], recording.commands[row],
        recording.angles[row], recording.currents[row], recording.torques[row], recording.directions[row],
        recording.places[row], max(0, int(recording.faces[row])),
    )  # fmt: skip
