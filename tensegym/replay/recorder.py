"""Recorder: keeps what a robot does while it does it."""

from __future__ import annotations

import numpy as np

from tensegym.control.bearing import Bearing
from tensegym.errors import SimulationError
from tensegym.physics.drives import COMMAND, CURRENT, LOAD_TORQUE
from tensegym.physics.terrain import Ground
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.episode import Episode
from tensegym.tasks.path import Path

from .recording import SHAPES, Recording

MOST = 6000  # samples; a longer episode is kept at half the rate, and again
_MARGIN = 2.0  # m of rough ground about where the robot went
_PATH_POINTS = 400
_NOWHERE = np.array([np.nan, np.nan])


class Recorder:
    """A watcher of episodes; or call `look` with a robot of your own loop. `recording` gives what was seen so far.

    It holds at most MOST samples: of a long episode every second one goes, and it looks half as often from then on.

    Args:
        title: of the recording.
        period: how often to look [s].
    """

    def __init__(self, title: str = "", period: float = 0.02) -> None:
        self.title, self.period = title, period
        self._rows: list[dict[str, object]] = []
        self._robot: TensegrityRobot | None = None
        self._path = np.zeros((0, 2))

    def __call__(self, episode: Episode) -> None:
        """Look at an episode. One that begins anew is another recording."""
        goal, bearing = episode.goal, episode.bearing
        self._path = goal.points[:: max(1, len(goal.points) // _PATH_POINTS)] if isinstance(goal, Path) else self._path
        place = _NOWHERE
        if np.isfinite(bearing.distance):  # it was told at the last reading
            place = episode.reading.centre[:2] + bearing.distance * bearing.direction
        self.look(episode.robot, bearing, place, episode.meter.face)

    def due(self, robot: TensegrityRobot) -> bool:
        """Whether a period has gone by since the last look, for who sees a robot more often than is to be kept."""
        last = self._rows[-1]["times"] if self._rows and robot is self._robot else -np.inf
        return bool(robot.time < last or robot.time > last + 0.8 * self.period)  # type: ignore[operator]

    def look(
        self, robot: TensegrityRobot, bearing: Bearing | None = None, place: object = _NOWHERE, face: int = -1
    ) -> None:
        """Take a robot's present state in.

        Args:
            robot: the same one each time, at a later time; an earlier time begins another recording.
            bearing: what it is wanted to do.
            place: (2,) where it is to go to [m], nan for nowhere.
            face: index of the face it stands on.
        """
        if self._rows and (robot is not self._robot or robot.time <= self._rows[-1]["times"]):  # type: ignore[operator]
            self._rows.clear()
        self._robot, self._scene = robot, robot.world.scene
        drives = robot.drives
        self._rows.append({
            "times": robot.time, "poses": robot.poses_in_world.copy(), "bends": robot.flexure_angles,
            "tensions": robot.tensions.copy(), "commands": drives[:, COMMAND].copy(), "angles": robot.drive_angles,
            "currents": drives[:, CURRENT].copy(), "torques": drives[:, LOAD_TORQUE].copy(),
            "directions": bearing.direction if bearing else _NOWHERE, "places": place, "faces": face,
        })  # fmt: skip
        if len(self._rows) > MOST:
            del self._rows[1::2]
            self.period *= 2

    def recording(self) -> Recording:
        """What was seen since the last episode began. Raises SimulationError where nothing was."""
        robot = self._robot
        if robot is None:
            raise SimulationError("nothing was recorded: the robot diverged before a first look, or there was none")
        over_time = [name for name, shape in SHAPES.items() if shape[0] == "t"]
        seen = {name: np.array([row[name] for row in self._rows]) for name in over_time}
        ground = self._scene.ground
        if ground is not None and ground.rough:
            ground = _about(ground, float(np.abs(seen["poses"][:, :, :2]).max()) + _MARGIN)
        return Recording(robot.design, **seen, path=self._path.copy(), ground=ground, gravity=robot.gravity.copy(),
                         title=self.title, engine=robot.engine, dt=robot.dt)  # fmt: skip


def _about(ground: Ground, reach: float) -> Ground:
    """The part of rough ground nearer to the origin than ``reach`` [m] in x and in y."""
    middle = len(ground.heights) // 2
    cells = min(middle, int(np.ceil(reach / ground.cell)))
    part = slice(middle - cells, middle + cells + 1)
    return ground._replace(heights=ground.heights[part, part].copy())
