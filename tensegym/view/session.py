"""Session: a robot that does what a viewer's page asks of it, in a process of its own."""

from __future__ import annotations

import time

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.control.controller import Controller
from tensegym.control.table import make_controller
from tensegym.physics.drives import COMMAND, CURRENT, LOAD_TORQUE
from tensegym.replay import Recorder, Recording
from tensegym.tasks.episode import Episode, Watcher
from tensegym.tasks.goal import Heading, Place
from tensegym.tasks.path import Path
from tensegym.tasks.rollout import whole_steps

from .choice import Choice
from .frame import Frame, Stage

PERIOD = 1 / 30  # s between two frames
HOLD = 0.1  # s, that a slider's command is held
_SEED = 0  # of a start, whose face and headings are given
_NOWHERE = np.array([np.nan, np.nan])
_PATH_POINTS = 200


class Session:
    """An episode that no time limit ends, of the robot that a choice asks for.

    Its commands come from the controller that the choice names, or else from `drive`, a control step at a time, as in
    an evaluation.

    Raises: as `Choice.setup`, and DesignError where the controller does not fit the robot.
    """

    def __init__(self, choice: Choice) -> None:
        setup = choice.setup()
        face = choice.face_of(setup.design)
        controller = make_controller(setup.controller) if setup.controller else None
        self._hold = whole_steps(controller.period if controller else HOLD, setup.task.dt)
        robot = setup.robot()
        try:
            self._begin(choice, Episode(robot, setup.task, np.random.default_rng(_SEED), _start(face)), controller)
        except BaseException:
            robot.close()
            raise

    def _begin(self, choice: Choice, episode: Episode, controller: Controller | None) -> None:
        if controller and not episode.diverged:
            controller.begin(episode.robot, _SEED)
        self.choice, self._episode, self._controller = choice, episode, controller
        self.recorder: Recorder | None = None
        """What keeps frames, while it is asked to."""
        self._angles: FloatArray = np.zeros(len(episode.robot.drives))

    def close(self) -> None:
        """Free the engine."""
        self._episode.robot.close()

    def stage(self) -> Stage:
        """What stands still around the robot."""
        robot, goal = self._episode.robot, self._episode.goal
        path = goal.points[:: max(1, len(goal.points) // _PATH_POINTS)] if isinstance(goal, Path) else np.zeros((0, 2))
        return Stage(robot.design, robot.world.scene.ground, robot.gravity.copy(), path)

    def command_limit(self) -> FloatArray:
        """(w,) deepest pull of each drive [rad]."""
        return self._episode.robot.command_limit

    # -- what a page asks ---------------------------------------------------------------------------------------------

    def choose(self, choice: Choice) -> Stage:
        """Begin anew with another choice, what is recorded too. Raises as the session's making does, and goes on with
        the old one then."""
        other = Session(choice)
        if self.recorder:
            other.record()
        self.close()
        self.__dict__ = other.__dict__
        return self.stage()

    def drive(self, angles: FloatArray) -> None:
        """Command spool angles (w,) [rad]; a controller takes no notice."""
        self._angles = np.clip(angles, 0.0, self._episode.robot.command_limit)

    def go_to(self, x: float, y: float) -> None:
        """Make a place [m] the goal, in place of the task's."""
        self._aim(Place(np.array([x, y])))

    def head(self, angle: float) -> None:
        """Make a direction the goal: an angle from the world's x axis [rad]."""
        self._aim(Heading.at(angle))

    def _aim(self, goal: Place | Heading) -> None:
        episode = self._episode
        episode.goal = goal
        episode.bearing = goal.bearing(episode.robot)
        episode.meter.turn(episode.bearing.direction)

    def record(self) -> None:
        """Keep what it does from now on."""
        self.recorder = Recorder(f"{self._episode.robot.design.name}, {self.choice.driver}", PERIOD)
        if not self._episode.diverged:
            self.recorder(self._episode)

    def recorded(self) -> Recording:
        """What was kept; it keeps no more. Raises SimulationError where nothing was."""
        recorder, self.recorder = self.recorder or Recorder(), None
        return recorder.recording()

    # -- what it does -------------------------------------------------------------------------------------------------

    def step(self, period: float = PERIOD) -> list[Frame]:
        """Go on by one control step: what was seen of it every ``period`` [s] of the robot's time."""
        seen = _Seen(self, period)
        self._step(seen)
        return seen.frames or [self.frame()]

    def run(self, seconds: float) -> list[Frame]:
        """Go on by control steps, as fast as it can, for so long on the wall's clock [s]; what is seen in the end."""
        end = time.perf_counter() + seconds
        while time.perf_counter() < end and not self._episode.diverged:
            self._step(self.recorder)
        return [self.frame()]

    def _step(self, watcher: Watcher | None = None) -> None:
        episode = self._episode
        if episode.diverged:
            return
        if self._controller:
            self._angles = self._controller.angles(episode.robot, episode.bearing)
        episode.advance(self._angles, self._hold, watcher)

    def frame(self) -> Frame:
        """The robot now."""
        episode, robot = self._episode, self._episode.robot
        place, direction = _NOWHERE, _NOWHERE
        if not episode.diverged:
            bearing = episode.bearing
            direction = bearing.direction
            if np.isfinite(bearing.distance):
                place = episode.reading.centre[:2] + bearing.distance * direction
        drives = robot.drives
        return Frame(
            robot.time, robot.poses_in_world.copy(), robot.tensions.copy(), drives[:, COMMAND].copy(),
            robot.drive_angles.copy(), drives[:, CURRENT].copy(), drives[:, LOAD_TORQUE].copy(), direction, place,
            episode.meter.face if not episode.diverged else 0, self._says(),
        )  # fmt: skip

    def _says(self) -> str:
        episode = self._episode
        if episode.diverged:
            return f"stopped: {episode.ended}"
        gait = episode.gait
        return f"{gait.tips} tips, {gait.speed_lps:.2f} L/s, slip {gait.slip_share:.2f}, {gait.energy:.0f} J"


class _Seen:
    """Frames of a control step."""

    def __init__(self, session: Session, period: float) -> None:
        self.period, self.frames = period, list[Frame]()
        self._session = session

    def __call__(self, episode: Episode) -> None:
        self.frames.append(self._session.frame())
        recorder = self._session.recorder
        if recorder and recorder.due(episode.robot):
            recorder(episode)


def _start(face: int) -> dict[str, float]:
    return {"face": face, "heading": 0.0, "direction": 0.0}
