"""Live: a page, and the robot in another process that it shows and asks."""

from __future__ import annotations

import tempfile
import threading
import time
from collections import deque
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import numpy as np

from tensegym.errors import TensegymError
from tensegym.physics.robot_arrays import robot_model
from tensegym.processes import Worker
from tensegym.replay import write_replay

from .choice import Choice
from .controls import Controls, Request
from .frame import Frame, Stage
from .page import Page
from .plots import Plots
from .robot_scene import RobotScene
from .session import PERIOD, Session
from .surroundings import Surroundings

_BESIDE = 6  # frames between two changes of what is beside the scene: plots, words
_LATE = 0.5  # s: further behind the clock than this, time that was lost is given up


class Live:
    """A robot that runs in a page.

    The worker is told the next control step before the last one is shown, so that it computes while the page is drawn;
    what users ask for waits until it has answered.

    Attributes:
        requests: what users asked for and was not served yet.
        frame: that was shown last; ``shown`` counts them.

    Raises: as `Session`.
    """

    def __init__(self, page: Page, choice: Choice) -> None:
        self.page, self.worker = page, Worker(Session, choice)
        self.requests: SimpleQueue[Request] = SimpleQueue()
        self.shown = 0
        self._ended, self._returned = threading.Event(), threading.Event()
        try:
            self.worker.started()
            stage = self._asked("stage")
            self._build(choice, stage)
            self._set_stage(choice, stage)
        except BaseException:
            self.worker.kill()
            raise

    def close(self) -> None:
        """End the robot's process."""
        self.worker.kill()

    def end(self) -> None:
        """Let `run`, in whichever thread it is, return; then end the robot's process."""
        self._ended.set()
        self._returned.wait()
        self.close()

    def _build(self, choice: Choice, stage: Stage) -> None:
        """The panels, for as many drives as there are."""
        length = stage.design.length
        self.page.initial_camera.position = (1.5 * length, -1.7 * length, 0.9 * length)
        self.page.initial_camera.look_at = (0.0, 0.0, 0.4 * length)
        self.page.gui.reset()
        self.page.gui.main_panel.dock_right()
        self.controls = Controls(self.page, choice, stage, self._asked("command_limit"), self.requests)
        self.plots = Plots(self.page, stage.design)

    def _set_stage(self, choice: Choice, stage: Stage) -> None:
        """The scene, and what the panels say of it."""
        if len(stage.design.structure.stiff_cables) != len(self.controls.sliders):
            self._build(choice, stage)
        self.page.scene.reset()
        self.surroundings, self.scene = Surroundings(self.page, stage), RobotScene(self.page, stage)
        self.page.scene.on_click()(self._clicked)
        self.controls.take(choice, stage)
        self.controls.dress(self.scene)
        self._wound = robot_model(stage.design).driven
        self._frames: deque[Frame] = deque()
        self._told, self._since = False, time.perf_counter()
        self._show(self._asked("frame"))

    # -- what a page asks ---------------------------------------------------------------------------------------------

    def tell(self, method: str, *arguments: Any) -> Any:
        """Call a method of the session, once it has answered what it was told."""
        if self._told:
            self._frames.extend(self.worker.answer())
            self._told = False
        return self._asked(method, *arguments)

    def _asked(self, method: str, *arguments: Any) -> Any:
        self.worker.tell(method, *arguments)
        return self.worker.answer()

    def choose(self, choice: Choice) -> None:
        """Begin anew. Raises as `Session`, and goes on as before then."""
        stage = self.tell("choose", choice)
        self._set_stage(choice, stage)

    def step(self) -> None:
        """One control step on, shown at once."""
        self._frames.extend(self.tell("step"))
        while self._frames:
            self._show(self._frames.popleft())

    def give_replay(self, client: Any) -> None:
        """Let a browser download what was recorded."""
        recording = self.tell("recorded")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "replay.html")
            write_replay(recording, path)
            client.send_file_download(path.name, path.read_bytes(), save_immediately=True)

    def _clicked(self, event: Any) -> None:
        place = self.surroundings.place_of(np.array(event.ray_origin), np.array(event.ray_direction))
        if place is not None:
            self.requests.put(lambda live: live.tell("go_to", *place.tolist()))

    # -- the loop -----------------------------------------------------------------------------------------------------

    def run(self) -> None:
        """Until it is interrupted, or told to `end`. Raises WorkerDied where the robot's process ends."""
        due = time.perf_counter()
        try:
            while not self._ended.is_set():
                self.turn()
                due = max(due + PERIOD, time.perf_counter() - _LATE)
                time.sleep(max(0.0, due - time.perf_counter()))
        finally:
            self._returned.set()

    def turn(self) -> None:
        """Serve what was asked for, and show the next frame where time goes on."""
        while not self.requests.empty():
            try:
                self.requests.get()(self)
            except (TensegymError, OSError) as error:
                self.controls.complain(str(error))
        if self.controls.playing:
            self._show(self._next())

    def _next(self) -> Frame:
        if not self._frames:
            self._tell_ahead()
            self._frames.extend(self.worker.answer())
            self._told = False
        frame = self._frames.popleft()
        if len(self._frames) < 2:
            self._tell_ahead()
        return frame

    def _tell_ahead(self) -> None:
        if self._told:
            return
        speed = self.controls.speed
        self.worker.tell(*(("run", PERIOD) if np.isinf(speed) else ("step", PERIOD * speed)))
        self._told = True

    def _show(self, frame: Frame) -> None:
        with self.page.atomic():
            self.scene.draw(frame)
            self.surroundings.draw(frame, self.scene.centre)
            if self.controls.follow.value:
                self.surroundings.follow(self.scene.centre)
        self.frame = frame
        self.plots.add(frame, self._wound)
        self.shown += 1
        if self.shown % _BESIDE == 0:
            now = time.perf_counter()
            self.plots.draw()
            self.controls.show(frame, _BESIDE / (now - self._since))
            self._since = now
