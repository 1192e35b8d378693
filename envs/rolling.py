"""RollingEnv: roll a cable-driven tensegrity robot in a wanted direction."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.utils import EzPickle

from tensegym.design import RobotDesign
from tensegym.design_file import as_design
from tensegym.errors import DesignError, SimulationError
from tensegym.gait import GaitMeter
from tensegym.robot import TensegrityRobot

from . import CONTROL_PERIOD
from .observation import NODE_REACH, OBSERVATIONS
from .reward import RewardWeights, reward_terms


class RollingEnv(gym.Env[np.ndarray, np.ndarray], EzPickle):
    """Placeholder docstring."""

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array", "human"], "render_fps": round(1 / CONTROL_PERIOD)}

    def __init__(
        self,
        design: str | dict[str, Any] | RobotDesign = "six_rod",
        observation: str = "full",
        control_period: float = CONTROL_PERIOD,
        dt: float = 2e-3,
        settle: float = 0.3,
        reward: dict[str, float] | None = None,
        render_mode: str | None = None,
    ) -> None:
        EzPickle.__init__(self, design, observation, control_period, dt, settle, reward, render_mode)
        if observation not in OBSERVATIONS:
            raise DesignError(f"observation = {observation!r} is not one of {', '.join(OBSERVATIONS)}")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise DesignError(f"render_mode = {render_mode!r} is not one of None, rgb_array, human")
        self.substeps = round(control_period / dt)
        if not (self.substeps >= 1 and math.isclose(self.substeps * dt, control_period, rel_tol=1e-6)):
            raise DesignError(f"control_period = {control_period!r} s must be a whole number of steps of dt = {dt!r} s")
        self.weights = RewardWeights(**(reward or {}))
        self.render_mode = render_mode
        self.settle_steps = round(settle / dt)
        self.dt = dt
        self._observation_kind = observation
        self.robot = self._build(as_design(design))
        bound = self.observer.bound
        self.observation_space = spaces.Box(-bound, bound, dtype=np.float32)
        self.action_space = spaces.Box(-1.0, 1.0, (len(self.robot.drives),), dtype=np.float32)
        self.direction = np.array([1.0, 0.0])

    def _build(self, design: RobotDesign) -> TensegrityRobot:
        robot = TensegrityRobot(design, dt=self.dt, gui=self.render_mode == "human")
        self.observer = OBSERVATIONS[self._observation_kind](robot)
        return robot

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        options = options or {}
        unknown = set(options) - {"design", "face", "heading", "direction"}
        if unknown:
            raise DesignError(f"unknown reset option {sorted(unknown)[0]!r}; allowed: design, face, heading, direction")
        if "design" in options:
            self._change_design(as_design(options["design"]))
        face = options.get("face", int(self.np_random.integers(len(self.robot.faces.triangles))))
        heading = options.get("heading", self.np_random.uniform(-math.pi, math.pi))
        direction = options.get("direction", self.np_random.uniform(-math.pi, math.pi))
        self.direction = np.array([math.cos(direction), math.sin(direction)])
        self.robot.reset(face, heading)
        self.robot.step(self.settle_steps)
        self.meter = GaitMeter(self.robot, self.direction)
        self._account = self.robot.account()
        self._along = float(self.direction @ self.robot.centre_of_mass_in_world()[:2])
        observation, _, _ = self._observe()
        return observation, {"face": face, "heading": heading, "direction": direction}

    def _change_design(self, design: RobotDesign) -> None:
        old = self.robot
        self.robot = self._build(design)
        old.close()
        if self.observer.bound.shape != self.observation_space.shape:
            raise DesignError(
                f"the new design observes {self.observer.bound.size} values, this environment "
                f"{self.observation_space.shape}; make an environment for it"
            )

    def _observe(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        values, nodes, velocities = self.observer.read(self.robot, self.direction)
        return values.astype(np.float32), nodes, velocities

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        action = np.clip(np.asarray(action, dtype=float), -1, 1)
        robot = self.robot
        robot.command((action + 1) / 2 * robot.command_limit)
        reason = None
        try:
            robot.step(self.substeps)
            observation, nodes, velocities = self._observe()
        except SimulationError as error:
            reason = str(error)
        else:
            if not (np.abs(observation) <= self.observer.bound).all():
                reason = f"left the observation's bounds ({NODE_REACH:g} rod lengths from the centre)"
        if reason:
            self.render_state = None
            return (np.zeros(self.observation_space.shape, np.float32), 0.0, True, False,
                    {"termination": reason, "gait": self.meter.metrics().as_dict()})  # fmt: skip
        self.meter.update(nodes, velocities)
        account, length = robot.account(), robot.design.length
        along = float(self.direction @ robot.centre_of_mass_in_world()[:2])
        terms = reward_terms(
            self.weights,
            (along - self._along) / length,
            (account.foot_path - self._account.foot_path) / length,
            account.electrical_energy - self._account.electrical_energy,
        )
        self._along, self._account = along, account
        info = {"reward_terms": terms, "gait": self.meter.metrics().as_dict()}
        return observation, sum(terms.values()), False, False, info

    def close(self) -> None:
        self.robot.close()
