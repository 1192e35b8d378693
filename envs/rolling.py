"""RollingEnv: roll a cable-driven tensegrity robot in a wanted direction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.utils import EzPickle

from tensegym.control.observation import NODE_REACH, OBSERVATIONS, observer
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design
from tensegym.design.variation import variation
from tensegym.errors import DesignError, SimulationError
from tensegym.robot.gait import GaitMeter
from tensegym.robot.rendering import draw_in_window, render
from tensegym.robot.robot import LARGEST_TIME_STEP, LEAST_TIME_STEP, TensegrityRobot

from . import CONTROL_PERIOD
from .reward import RewardWeights, reward_terms


class RollingEnv(gym.Env[np.ndarray, np.ndarray], EzPickle):
    """Roll a tensegrity robot along a wanted direction by winding its stiff cables.

    One step commands a spool angle to every drive and holds it for the control period, while drives, cables and
    contacts are integrated at the physics step.

    Action, `Box(-1, 1, (w,))`, one entry a drive (6 for the six-rod robot): -1 lets the cable out to its rest length,
    +1 winds it in to the design's ``max_pull``.

    Observation ``full``, in this order; the heading frame has x along the wanted direction and z up, and horizontal
    positions are from the centre of mass:

    | part | entries (six rods) | unit | bound |
    |---|---|---|---|
    | node position | 12 x 3 | rod lengths | 2 |
    | node velocity | 12 x 3 | rod lengths/s | 50 m/s over the rod length |
    | foot contact | 12 | 0 or 1 | 1 |
    | drive angle | 6 | -1 released, +1 deepest pull | 2 |
    | drive speed | 6 | of the rotor's speed limit | 1 |
    | drive current | 6 | of the current limit | 1 |
    | tension | 30 (36 with payload) | five pretensions | what the stiffest cable gives across the position bound |

    Observation ``onboard``: rod axis (6 x 3) and turn rate across the axis (6 x 3, in 5 rad/s) in the heading frame,
    as an inertial unit on each rod reports them, then drive angle, speed and current.

    With ``vary``, which maps fields of the design to ranges (see `tensegym.design.variation`), the robot is another one
    every ``episodes_per_design`` episodes and at every seeded reset: drawn uniformly, refused ones again. Either
    observation then ends with where the design lies in each range, -1 to 1. With 0 episodes the design stays as given.

    An episode that leaves a bound has diverged or come apart, and ends; so the bounds hold by construction.

    Reward: progress of the centre of mass along the wanted direction, less ``slip`` times the path of the grounded
    feet's centres (mean over the feet), both in rod lengths, less ``energy`` times the joules drawn. The terms are in
    ``info["reward_terms"]``; ``info["gait"]`` holds the gait metrics since the reset.

    Start: at rest on a random face, at a random heading, towards a random direction, settled for ``settle`` seconds.

    Ends: never by itself in a sound simulation (`gymnasium.make` adds the time limit of 20 s, which truncates); a
    diverged one terminates, with ``info["termination"]`` saying why, zeros as the observation, and the gait metrics of
    the last step that could be trusted.

    Arguments: design (a preset, a TOML file, a dict as one, or a RobotDesign), observation, control_period [s], dt
    [s], settle [s], reward (weights to change, see RewardWeights), render_mode (None, rgb_array, human), vary,
    episodes_per_design, slope [deg] (of the ground, uphill along the wanted direction; what the robot sees of it is how
    its parts move).

    ``reset(options=...)``: face (index), heading [rad], direction [rad], and design, which puts another robot with as
    many nodes, cables and drives into the same environment.

    Version 0: first.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]  # the base class annotates an instance variable
        "render_modes": ["rgb_array", "human"],
        "render_fps": round(1 / CONTROL_PERIOD),
    }

    def __init__(
        self,
        design: str | dict[str, Any] | RobotDesign = "six_rod",
        observation: str = "full",
        control_period: float = CONTROL_PERIOD,
        dt: float = 2e-3,
        settle: float = 0.3,
        reward: dict[str, float] | None = None,
        render_mode: str | None = None,
        vary: dict[str, dict[str, Any]] | None = None,
        episodes_per_design: int = 1,
        slope: float = 0.0,
    ) -> None:
        EzPickle.__init__(
            self, design, observation, control_period, dt, settle, reward, render_mode, vary, episodes_per_design,
            slope,
        )
        if observation not in OBSERVATIONS:
            raise DesignError(f"observation = {observation!r} is not one of {', '.join(OBSERVATIONS)}")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise DesignError(f"render_mode = {render_mode!r} is not one of None, rgb_array, human")
        if reward and set(reward) - {f.name for f in fields(RewardWeights)}:
            allowed = ", ".join(f.name for f in fields(RewardWeights))
            raise DesignError(f"unknown reward weight in {reward!r}; allowed: {allowed}")
        for name, value, low, high, unit in (("dt", dt, LEAST_TIME_STEP, LARGEST_TIME_STEP, "s"),
                                             ("control_period", control_period, 1e-6, 60.0, "s"),
                                             ("settle", settle, 0.0, 60.0, "s"),
                                             ("slope", slope, 0.0, 60.0, "deg")):  # fmt: skip
            if not (isinstance(value, int | float) and low <= value <= high):
                raise DesignError(f"{name} = {value!r} is outside [{low:g}, {high:g}] {unit}")
        if not (isinstance(episodes_per_design, int) and episodes_per_design >= 0):
            raise DesignError(f"episodes_per_design = {episodes_per_design!r} must be a whole number, 0 or more")
        self.substeps = round(control_period / dt)
        if not (self.substeps >= 1 and math.isclose(self.substeps * dt, control_period, rel_tol=1e-6)):
            raise DesignError(f"control_period = {control_period!r} s must be a whole number of steps of dt = {dt!r} s")
        self.weights = RewardWeights(**(reward or {}))
        self.render_mode = render_mode
        self.metadata = {**type(self).metadata, "render_fps": 1 / control_period}  # type: ignore[misc]
        self.settle_steps = round(settle / dt)
        self.dt, self.slope = dt, slope
        self._observation_kind = observation
        self._base = as_design(design)
        self._variation = None if vary is None else variation(vary, self._base)
        self._episodes_per_design, self._episodes_left = episodes_per_design, 0
        self.robot = self._build(self._base)
        self._diverged = False
        bound = self.observer.bound
        self.observation_space: spaces.Box = spaces.Box(-bound, bound, dtype=np.float32)
        self.action_space: spaces.Box = spaces.Box(-1.0, 1.0, (len(self.robot.drives),), dtype=np.float32)
        self.direction = np.array([1.0, 0.0])
        self.watch: Callable[[TensegrityRobot], None] | None = None  # called every `watch_period` while stepping
        self.watch_period = control_period

    def _advance(self) -> None:
        if self.watch is None:
            self.robot.step(self.substeps)
            return
        parts = max(1, round(self.substeps * self.dt / self.watch_period))
        for part in np.array_split(np.arange(self.substeps), parts):
            self.robot.step(len(part))
            self.watch(self.robot)

    def _build(self, design: RobotDesign) -> TensegrityRobot:
        robot = TensegrityRobot(design, dt=self.dt, gui=self.render_mode == "human")
        self.observer = observer(self._observation_kind, robot, self._variation)
        return robot

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        options = options or {}
        unknown = set(options) - {"design", "face", "heading", "direction"}
        if unknown:
            raise DesignError(f"unknown reset option {sorted(unknown)[0]!r}; allowed: design, face, heading, direction")
        for name in ("heading", "direction"):
            value = options.get(name, 0.0)
            if not (isinstance(value, int | float | np.number) and math.isfinite(value)):
                raise DesignError(f"reset option {name} = {value!r} must be a finite angle [rad]")
        if not isinstance(options.get("face", 0), int | np.integer):
            raise DesignError(f"reset option face = {options['face']!r} must be a whole number")
        if self._diverged:  # what is left in the engine's caches may be no numbers either
            self.robot.close()
            self.robot = self._build(self.robot.design)
            self._diverged = False
        if "design" in options:
            self._change_design(as_design(options["design"]))
        elif self._variation and self._episodes_per_design:
            if seed is not None or not self._episodes_left:
                self._change_design(self._variation.draw(self._base, self.np_random))
                self._episodes_left = self._episodes_per_design
            self._episodes_left -= 1
        face = options.get("face", int(self.np_random.integers(len(self.robot.faces.triangles))))
        heading = options.get("heading", self.np_random.uniform(-math.pi, math.pi))
        direction = options.get("direction", self.np_random.uniform(-math.pi, math.pi))
        self.direction = np.array([math.cos(direction), math.sin(direction)])
        self.robot.reset(face, heading)
        if self.slope:
            self.robot.slope(math.radians(self.slope), self.direction)
        self.robot.step(self.settle_steps)
        self.meter = GaitMeter(self.robot, self.direction)
        self._gait = self.meter.metrics().as_dict()
        self._totals = self.robot.totals()
        self._along = float(self.direction @ self.robot.centre_of_mass_in_world()[:2])
        observation, _, _ = self._observe()
        return observation, {"face": face, "heading": heading, "direction": direction}

    def _change_design(self, design: RobotDesign) -> None:
        old_robot, old_observer = self.robot, self.observer
        robot = self._build(design)
        new, old = self.observer, old_observer
        if [(p.name, p.rows) for p in new.parts] != [(p.name, p.rows) for p in old.parts]:
            self.observer = old_observer
            robot.close()
            rows = ", ".join(
                f"{p.name} {p.rows} (here {q.rows})" for p, q in zip(new.parts, old.parts, strict=True)
                if p.rows != q.rows
            )  # fmt: skip
            raise DesignError(
                f"design {design.name!r} observes {new.bound.size} values, this environment {old.bound.size}: {rows}; "
                "make an environment for it"
            )
        self.robot = robot
        self.observation_space = spaces.Box(-new.bound, new.bound, dtype=np.float32)
        old_robot.close()

    def _observe(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        values, nodes, velocities = self.observer.read(self.robot, self.direction)
        return values.astype(np.float32), nodes, velocities

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        action = np.clip(np.asarray(action, dtype=float), -1, 1)
        if action.shape != self.action_space.shape:
            raise DesignError(f"an action has shape {self.action_space.shape}, one entry a drive; given {action.shape}")
        robot = self.robot
        robot.command((action + 1) / 2 * robot.command_limit)
        reason = None
        try:
            self._advance()
            observation, nodes, velocities = self._observe()
        except SimulationError as error:
            reason = str(error)
        else:
            if not (np.abs(observation) <= self.observer.bound).all():
                reason = f"left the observation's bounds ({NODE_REACH:g} rod lengths from the centre)"
        if reason:
            self._diverged = True
            return (np.zeros(self.observation_space.shape, np.float32), 0.0, True, False,
                    {"termination": reason, "reward_terms": reward_terms(self.weights, 0.0, 0.0, 0.0),
                     "gait": self._gait})  # fmt: skip
        self.meter.update(nodes, velocities)
        totals, length = robot.totals(), robot.design.length
        along = float(self.direction @ robot.centre_of_mass_in_world()[:2])
        terms = reward_terms(
            self.weights,
            (along - self._along) / length,
            (totals.foot_path - self._totals.foot_path) / length,
            totals.electrical_energy - self._totals.electrical_energy,
        )
        self._along, self._totals = along, totals
        if self.render_mode == "human":
            self.render()
        self._gait = self.meter.metrics().as_dict()
        info = {"reward_terms": terms, "gait": self._gait}
        return observation, sum(terms.values()), False, False, info

    def render(self) -> np.ndarray | None:
        """(360, 480, 3) picture that follows the robot, cables coloured by tension; None in human mode."""
        if self.render_mode == "rgb_array":
            return render(self.robot)
        if self.render_mode == "human":
            draw_in_window(self.robot)
        return None

    def close(self) -> None:
        self.robot.close()
