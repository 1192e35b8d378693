"""Controls: the panel of a live page. What its user does becomes requests, which the loop of `live.py` serves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from queue import SimpleQueue
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.structure.faces import hull_faces

from .choice import SLIDERS, Choice, drivers
from .frame import Frame, Stage
from .page import Page
from .robot_scene import RobotScene

Request = Callable[[Any], None]
"""What a user wants, done to the loop that serves it."""
SPEEDS = {"1": 1.0, "1/2": 0.5, "1/5": 0.2, "1/20": 0.05, "max": np.inf}
"""Names of how fast the robot's time goes, and its rate against the wall's clock."""


class Controls:
    """The panel of a robot that runs.

    Args:
        page: that has it.
        choice, stage: what runs.
        limits: (w,) deepest pull of each drive [rad].
        requests: what users ask for goes there; callbacks do nothing else, so they need no locks.

    Attributes:
        playing, speed: whether and how fast time goes.
    """

    def __init__(
        self, page: Page, choice: Choice, stage: Stage, limits: FloatArray, requests: SimpleQueue[Request]
    ) -> None:
        self.requests, self.choice = requests, choice
        self.playing, self.speed = True, 1.0
        gui = page.gui
        self._says = gui.add_markdown("starting")
        with gui.add_folder("Time"):
            self._play = gui.add_button("pause")
            _on_click(self._play, self._toggle)
            _on_click(gui.add_button("step", hint="one control step on"), lambda: self._ask(lambda live: live.step()))
            _on_click(gui.add_button("restart"), lambda: self._ask(lambda live: live.choose(self.choice)))
            _on_update(gui.add_dropdown("speed", tuple(SPEEDS), initial_value="1"), self._set_speed)
            self._face = gui.add_dropdown("start face", tuple(hull_faces(stage.design.standing).names()))
            self._record = gui.add_button("record", hint="a replay: one file, which any browser plays")
            self._record.on_click(self._take_record)
        with gui.add_folder("Robot"):
            options = drivers()
            options += [] if choice.driver in options else [choice.driver]
            self._driver = gui.add_dropdown("driven by", tuple(options), initial_value=choice.driver)
            self._payload = gui.add_checkbox("payload", False)
            self._flexible = gui.add_checkbox("flexible rods", False)
        with gui.add_folder("Drives", expand_by_default=True):
            self.sliders = [gui.add_slider(f"drive {d + 1} [rad]", 0.0, math.floor(10 * limit) / 10, 0.1, 0.0)
                            for d, limit in enumerate(limits)]  # fmt: skip
            for slider in self.sliders:
                _on_update(slider, self._drive)
            _on_click(gui.add_button("release all"), self._release)
        with gui.add_folder("Show"):
            self.follow = gui.add_checkbox("follow the robot", True)
            self._support = gui.add_checkbox("support and centre of mass", True)
            self._numbers = gui.add_checkbox("node numbers", False)
            for checkbox in (self._support, self._numbers):
                _on_update(checkbox, lambda _: self._ask(lambda live: self.dress(live.scene)))
            gui.add_markdown("A click on the ground makes that place the goal.")
        for handle, field in ((self._face, "face"), (self._driver, "driver"), (self._payload, "payload"),
                              (self._flexible, "flexible")):  # fmt: skip
            self._chosen(handle, field)

    def take(self, choice: Choice, stage: Stage) -> None:
        """Show another choice, and the robot it has led to."""
        self.choice, self._design = choice, stage.design
        self._tick()
        for slider in self.sliders:
            slider.value, slider.disabled = 0.0, choice.driver != SLIDERS

    def _tick(self) -> None:
        self._driver.value = self.choice.driver
        self._payload.value, self._flexible.value = self._design.payload is not None, self._design.flexure is not None

    def dress(self, scene: RobotScene) -> None:
        """Let a robot show what is ticked."""
        scene.show_support(self._support.value)
        scene.show_numbers(self._numbers.value)

    def _ask(self, request: Request) -> None:
        self.requests.put(request)

    def _toggle(self) -> None:
        self.playing = not self.playing
        self._play.label = "pause" if self.playing else "play"

    def _take_record(self, event: Any) -> None:
        if self._record.label == "record":
            self._ask(lambda live: live.tell("record"))
            self._record.label = "end and download the replay"
        else:
            self._ask(lambda live: live.give_replay(event.client))
            self._record.label = "record"

    def _set_speed(self, name: str) -> None:
        self.speed = SPEEDS[name]

    def _chosen(self, handle: Any, field: str) -> None:
        def take(value: Any) -> None:
            choice = replace(self.choice, **{field: value})
            if field == "driver":  # which brings its own robot, as the command would
                choice = replace(choice, payload=None, flexible=None)
            self._ask(lambda live: live.choose(choice))

        _on_update(handle, take)

    def _drive(self, _: float) -> None:
        angles = np.array([slider.value for slider in self.sliders])
        self._ask(lambda live: live.tell("drive", angles))

    def _release(self) -> None:
        for slider in self.sliders:
            slider.value = 0.0
        self._drive(0.0)

    def show(self, frame: Frame, rate: float) -> None:
        """Tell a frame in words, with the updates a second; sliders that do not drive show what does."""
        self._says.content = f"t = {frame.time:.2f} s: {frame.says}; {rate:.0f} updates/s"
        if self.choice.driver != SLIDERS:
            for slider, angle in zip(self.sliders, frame.commands, strict=True):
                slider.value = float(np.clip(angle, 0.0, slider.max))

    def complain(self, error: str) -> None:
        """Tell what did not work, and stop; what runs is as it was."""
        self._tick()
        self.playing, self._play.label = False, "play"
        self._says.content = f"**{error}**"


def _on_update(handle: Any, act: Callable[[Any], None]) -> None:
    """Call with the value that a user gave, not with one that the program did."""
    handle.on_update(lambda event: act(handle.value) if event.client_id is not None else None)


def _on_click(button: Any, act: Callable[[], None]) -> None:
    button.on_click(lambda _: act())
