"""RollingEnv: a cable-driven tensegrity robot and a task, as a Gymnasium environment."""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium.utils import EzPickle
from numpy.typing import NDArray

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design
from tensegym.design.variation import parse_variation
from tensegym.errors import DesignError, SimulationError
from tensegym.robot.fallen import FALLEN, FLAT
from tensegym.tables import as_whole, known, show
from tensegym.tasks.episode import Episode, Watcher
from tensegym.tasks.motions import as_task
from tensegym.tasks.rollout import whole_steps
from tensegym.tasks.start import OPTIONS, check_options
from tensegym.tasks.task import Task

from . import CONTROL_PERIOD
from .actions import as_action
from .draws import Draws
from .stage import Stage

REDRAWS = 20  # designs in a row that may all diverge while they settle


class RollingEnv(Stage, EzPickle):
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

    Observations ``full-goal`` and ``onboard-goal`` end with three entries more: the distance to the place to go to, as
    a part of 4 rod lengths and of 1, at most 1 (the wanted direction points there), and 1 where it is to stop there.

    Observations ``onboard-memory`` and ``onboard-goal-memory`` are three of these: now, and at the two steps before.

    With ``vary``, which maps fields of the design to ranges (see `tensegym.design.variation`), the robot is another one
    every ``episodes_per_design`` episodes and at every seeded reset: drawn uniformly, refused ones again. Either
    observation then ends with where the design lies in each range, -1 to 1. With 0 episodes the design stays as given.

    An episode whose nodes leave their bound has diverged or come apart, and ends; so the bounds hold.

    Reward: progress of the centre of mass along the wanted direction, less ``slip`` times the path of the grounded
    feet's centres (mean over the feet), both in rod lengths, less ``energy`` times the joules drawn. The terms are in
    ``info["reward_terms"]``; ``info["gait"]`` holds the gait metrics since the reset, ``info["measures"]`` those of the
    task's own.

    Start: at rest on a random face, at a random heading, towards a random direction, settled for ``settle`` seconds.

    Ends: when the task says so, with ``info["termination"]`` saying why; rolling never does (`gymnasium.make` adds the
    time limit of 20 s, which truncates). A diverged simulation terminates too, with zeros as the observation and the
    gait metrics of the last step that could be trusted.

    Arguments: design (a preset, a TOML file, a dict as one, or a RobotDesign), observation, control_period [s], task (a
    motion such as roll, climb or cross, a table as in a task file, ``module:Class``, or a Task), render_mode (None,
    rgb_array, human), vary, episodes_per_design; and in place of the task's own: dt [s], settle [s], slope [deg]
    (uphill along the wanted direction; what the robot sees of it is how its parts move), reward (weights to change, see
    RewardWeights), disturb (ranges of what goes otherwise than designed, see `tensegym.tasks.disturbance`), engine
    (pybullet or mujoco), obstacle (of a course: blocks, corridor, bar, incline, rough or all).

    ``reset(options=...)``: face (index), heading [rad], direction [rad], and design, which puts another robot with as
    many nodes, cables and drives into the same environment.

    A robot that has fallen flat when an episode begins, or lay so when it ended, is warned of (UserWarning), once a
    design; `tensegym.standing_verdict` says beforehand.

    Version 0: first.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]  # the base class annotates an instance variable
        "render_modes": ["rgb_array", "human"],
        "render_fps": 1 / CONTROL_PERIOD,  # a picture a control period: a video of them plays at true speed
    }

    def __init__(
        self,
        design: str | dict[str, Any] | RobotDesign = "six_rod",
        observation: str = "full",
        control_period: float = CONTROL_PERIOD,
        dt: float | None = None,
        settle: float | None = None,
        reward: dict[str, float] | None = None,
        render_mode: str | None = None,
        vary: dict[str, dict[str, Any]] | None = None,
        episodes_per_design: int = 1,
        slope: float | None = None,
        task: str | dict[str, Any] | Task = "roll",
        disturb: dict[str, Any] | None = None,
        engine: str | None = None,
        obstacle: str | None = None,
    ) -> None:
        EzPickle.__init__(
            self, design, observation, control_period, dt, settle, reward, render_mode, vary, episodes_per_design,
            slope, task, disturb, engine, obstacle,
        )
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise DesignError(f"render_mode = {render_mode!r} is not one of None, rgb_array, human")
        self.task = as_task(task).changed(
            dt=dt, settle=settle, slope=slope, reward=reward, disturb=disturb, engine=engine, obstacle=obstacle
        )
        self.dt = self.task.dt
        self.substeps = whole_steps(control_period, self.dt)
        self.render_mode = render_mode
        self.metadata = {**type(self).metadata, "render_fps": 1 / control_period}  # type: ignore[misc]
        base = self.task.equipped(as_design(design))
        variation = None if vary is None else parse_variation(vary, base)
        self._set(self.task, base, Draws(base, variation, episodes_per_design, self.task.disturb), observation)
        self.task.disturb.sensors(np.random.default_rng(0)).check(self.observation.parts)
        self.watcher: Watcher | None = None  # looks on while the robot moves

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Start an episode; see the class for the options. Raises DesignError, or SimulationError where no design
        of those tried comes to rest."""
        self._check_open()
        if seed is not None:
            seed = as_whole(seed, "seed", DesignError, "a whole number, 0 or more")
        options = dict(known({} if options is None else options, ("design", *OPTIONS), "reset options", DesignError))
        if "design" not in options:
            check_options(options, len(self.robot.faces.triangles))
        try:
            super().reset(seed=seed)
        except gym.error.Error as error:
            raise DesignError(f"seed = {show(seed)}: {error}") from error
        self._warn_if_fallen(FLAT)
        if self.episode and self.episode.diverged:  # what is left in the engine's caches may be no numbers either
            self._use(self.robot.design)
        design, redraw = options.pop("design", None), False
        if design is not None:
            nominal = self.task.equipped(as_design(design))
            self.task.disturb.check(nominal)
            self._use(nominal)
            self._draws.nominal = nominal
        else:
            redraw = self._draws.due(seed is not None)
        episode = self._begin(options, redraw)
        self._warn_if_fallen(FALLEN)
        info = episode.start._asdict() | ({"redrawn": self._redrawn} if self._redrawn else {})
        if episode.faults:
            info["disturbed"] = self._draws.factors | episode.faults.as_dict()
        return self._seen(episode), info

    def _begin(self, options: dict[str, Any], redraw: bool) -> Episode:
        """An episode whose robot has come to rest: another design of the variation where one does not."""
        draws = self._draws
        for self._redrawn in range(REDRAWS):
            if redraw:
                self._use(draws.draw(self.np_random))
                draws.nominal = self.robot.design
            if draws.rebuilds:
                self._use(draws.build(self.np_random))
            self.episode = Episode(self.robot, self.task, self.np_random, options)
            if not self.episode.diverged:
                return self.episode
            redraw = draws.varies
            if not (redraw or draws.rebuilds):
                break
        raise SimulationError(f"no episode can begin: the robot {self.robot.design.name!r} diverged "
                              f"{self.episode.ended if self.episode else ''}; "
                              f"take a smaller time step than dt = {self.dt:g} s, or another design")  # fmt: skip

    def step(self, action: NDArray[Any]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Command the drives and hold for a control period. Raises DesignError for what is no action, and
        SimulationError before the first reset; the environment is as it was then."""
        command = as_action(action, self.action_space.shape)
        episode = self._running()
        terms = episode.advance(self.robot.angles_of(command), self.substeps, self.watcher)
        info: dict[str, Any] = {"reward_terms": terms, "gait": episode.gait.as_dict()}
        if self.task.MEASURES:
            info["measures"] = self.task.measures(episode)
        if episode.ended:
            info["termination"] = episode.ended
        if self.render_mode == "human":
            self.render()
        return self._seen(episode), sum(terms.values()), episode.ended is not None, False, info

    def _running(self) -> Episode:
        self._check_open()
        if self.episode is None:
            raise SimulationError("step() before the first reset(): call reset() to begin an episode")
        if self.episode.ended:
            raise SimulationError(f"the episode has ended ({self.episode.ended}): call reset() to begin another one")
        return self.episode

    def _seen(self, episode: Episode) -> NDArray[np.float32]:
        if episode.diverged:
            return np.zeros(self.observation_space.shape, np.float32)
        return self.observation.see(self.robot, episode.bearing, episode.reading)
