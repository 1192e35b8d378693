"""`tensegym roll`: a shipped policy at work, quickly, with pictures; or in a window."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from tensegym.control.policy import policy_env
from tensegym.control.table import make_controller
from tensegym.report import Report, table
from tensegym.robot.rendering import draw_in_window
from tensegym.tasks.episode import Episode
from tensegym.tasks.policy_trials import FIRST_SEED, policy_setup
from tensegym.tasks.rollout import rollout

from .evaluate import Evaluate
from .options import Count
from .standing import tell_unless_standing


@dataclass(frozen=True)
class Roll:
    """Watch the shipped policy roll: a quick evaluation with pictures and a video; baselines for the default robot."""

    policy: str = "rolling"
    """A run's folder, or a shipped policy: rolling, onboard, fast, flexible, carry, climb, steep, sprint, agile,
    agile_onboard, steer, steer_onboard, steer_first, carry_steer, robust, three_rod, four_rod,
    four_rod_fast, conditioned."""
    out: Path = Path("roll")
    """Folder for metrics.json, gait.png and roll.mp4."""
    episodes: Count = 10
    """Episodes in the table."""
    engine: str | None = None
    """Physics engine: pybullet, or mujoco (extra mujoco); default: the task's."""
    replay: Path | None = None
    """Write the median episode as one HTML file, such as run.html, that any browser plays without a network."""
    window: bool = False
    """Instead: watch one episode in PyBullet's window, in real time; needs a display, writes nothing."""

    def run(self) -> Report:
        if self.window:
            return self._watch()
        plain = "design" not in policy_env(self.policy)  # another robot's walker takes minutes to tabulate
        return Evaluate(self.policy, self.out, self.episodes, engine=self.engine, baselines=plain,
                        replay=self.replay).run()  # fmt: skip

    def _watch(self) -> Report:
        setup = policy_setup(self.policy, engine=self.engine)
        tell_unless_standing(setup.design, setup.task.engine)
        with setup.robot(gui=True) as robot:
            result = rollout(robot, make_controller(setup.controller), setup.task, FIRST_SEED, watcher=_Clock())
        gait = result.gait
        row = [self.policy, gait.speed_lps, gait.tips, gait.slip_share]
        return Report(table(["policy", "L/s", "tips", "slip share"], [row]), result.row())


class _Clock:
    """Draws the robot and waits until the wall clock has caught up with its time."""

    period = 1 / 30

    def __init__(self) -> None:
        self._lead: float | None = None

    def __call__(self, episode: Episode) -> None:
        draw_in_window(episode.robot)
        if self._lead is None:
            self._lead = time.perf_counter() - episode.robot.time
        time.sleep(max(0.0, episode.robot.time + self._lead - time.perf_counter()))
