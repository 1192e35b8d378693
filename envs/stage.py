"""The robot of an environment and what is observed of it: made, put in another's place, drawn, closed."""

from __future__ import annotations

import warnings

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from tensegym.control.observation import Observation
from tensegym.control.observations import make_observation
from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError, SimulationError
from tensegym.robot.fallen import has_fallen
from tensegym.robot.rendering import draw_in_window, render
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.episode import Episode
from tensegym.tasks.task import Task

from .draws import Draws


class Stage(gym.Env[np.ndarray, np.ndarray]):
    """An environment with a robot on it: `RollingEnv` without its episodes."""

    episode: Episode | None = None

    def _set(self, task: Task, design: RobotDesign, draws: Draws, observation: str) -> None:
        """Make the first robot and the spaces. ``self.render_mode`` stands."""
        self.task, self._draws, self._observation_kind = task, draws, observation
        self.robot, self.observation = self._build(design)
        self.observation_space: spaces.Box = _box(self.observation)
        self.action_space: spaces.Box = spaces.Box(-1.0, 1.0, (len(self.robot.drives),), dtype=np.float32)
        self._fallen: RobotDesign | None = None
        self._closed = False

    def _build(self, design: RobotDesign) -> tuple[TensegrityRobot, Observation]:
        robot = self.task.robot(design, self.render_mode == "human")
        try:
            return robot, make_observation(self._observation_kind, robot, self._draws.variation)
        except BaseException:
            robot.close()
            raise

    def _use(self, design: RobotDesign) -> None:
        """Put another robot into this environment. Raises DesignError where it observes other parts."""
        robot, new = self._build(design)
        if [(p.name, p.rows) for p in new.parts] != [(p.name, p.rows) for p in self.observation.parts]:
            robot.close()
            rows = ", ".join(
                f"{p.name} {p.rows} (here {q.rows})" for p, q in zip(new.parts, self.observation.parts, strict=True)
                if p.rows != q.rows
            )  # fmt: skip
            raise DesignError(
                f"design {design.name!r} observes {new.bound.size} values, this environment "
                f"{self.observation.bound.size}: {rows}; make an environment for it"
            )
        self.robot.close()
        self.robot, self.observation, self.observation_space = robot, new, _box(new)

    def _warn_if_fallen(self, left: float) -> None:
        """Say once of a design that with it an episode began, or ended, flat on the ground."""
        episode, design = self.episode, self.robot.design
        if episode and not episode.diverged and design is not self._fallen and has_fallen(self.robot, left):
            self._fallen = design
            warnings.warn(f"robot {design.name!r} has fallen flat; tensegym.standing_verdict(design) says what would "
                          "hold it", UserWarning, stacklevel=3)  # fmt: skip

    def render(self) -> NDArray[np.uint8] | None:
        """(360, 480, 3) picture that follows the robot, cables coloured by tension, an arrow where it is to go; None in
        human mode."""
        if self.render_mode == "rgb_array":
            return render(self.robot, direction=self.episode.bearing.direction if self.episode else None)
        if self.render_mode == "human":
            draw_in_window(self.robot)
        return None

    def close(self) -> None:
        """Free the physics client; the environment cannot be used again."""
        self._closed = True
        self.robot.close()

    def _check_open(self) -> None:
        if self._closed:
            raise SimulationError("the environment is closed: make another one")


def _box(observation: Observation) -> spaces.Box:
    return spaces.Box(-observation.bound, observation.bound, dtype=np.float32)
