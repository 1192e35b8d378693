"""`tensegym evaluate` and `tensegym roll`: what a gait is worth, over many seeds, faces and headings."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tensegym.envs.rolling import RollingEnv
from tensegym.errors import InputError
from tensegym.report import Report, table
from tensegym.robot.rendering import draw_in_window
from tensegym.robot.robot import TensegrityRobot

from .controllers import Controller, policy_controller
from .trials import EPISODE_SECONDS, run_episode, run_trials, summarise

FIRST_SEED = 10_000  # evaluation episodes start here; training draws its seeds elsewhere


@dataclass(frozen=True)
class Evaluate:
    """Evaluate a policy and the baselines from random faces and headings; writes metrics.json, gait.png, roll.mp4."""

    policy: str = "rolling"
    """A run's folder, or a shipped policy: rolling, onboard, flexible, carry, climb, steep, conditioned."""
    out: Path = Path("evaluation")
    """Folder for metrics.json, gait.png and roll.mp4."""
    episodes: int = 100
    """Episodes, each from a random face at a random heading towards a random direction."""
    seconds: float = EPISODE_SECONDS
    """Length of an episode [s]."""
    dt: float | None = None
    """Physics time step [s]; default: the environment's."""
    baselines: bool = True
    """Also judge random commands and the open-loop walker on the same episodes."""
    half_step: bool = True
    """Also judge the policy at half the time step."""
    observation: str | None = None
    """Observation to evaluate with, in place of the policy's own."""
    video: bool = True
    """Write roll.mp4 of the first episode."""
    jobs: int = 0
    """Processes; 0 takes one a core."""

    def run(self) -> Report:
        if self.episodes < 1:
            raise InputError(f"episodes = {self.episodes} must be 1 or more")
        if not 1 <= self.seconds <= 3600:
            raise InputError(f"seconds = {self.seconds} is outside [1, 3600]")
        controller = policy_controller(self.policy)
        override: dict[str, Any] = {}
        if self.dt is not None:
            override["dt"] = self.dt
        if self.observation is not None:
            override["observation"] = self.observation
        with RollingEnv(**{**controller.env, **override}) as probe:
            controller.start(probe)  # a policy that does not fit fails here, before anything is written
            dt = probe.dt
        if self.out.exists() and not self.out.is_dir():
            raise InputError(f"--out {self.out} is a file; give a folder")
        self.out.mkdir(parents=True, exist_ok=True)

        seeds = range(FIRST_SEED, FIRST_SEED + self.episodes)
        trials = {self.policy: (controller, override)}
        if self.half_step:
            trials[f"{self.policy}, half time step"] = (controller, {**override, "dt": dt / 2})
        if self.baselines:
            plain = {**controller.env, **override}
            tips = None if "design" in plain else shipped_table()  # another design's walker makes its own table
            trials["open-loop walker"] = (Controller("walker", "walker", tips, plain), {})
            trials["random commands"] = (Controller("random", "random", None, plain), {})
        results = {
            name: run_trials(controller, seeds, seconds=self.seconds, jobs=self.jobs, env=env)
            for name, (controller, env) in trials.items()
        }
        summaries = {name: summarise(rows) for name, rows in results.items()}
        data = {"policy": self.policy, "dt": dt, "seconds": self.seconds, "summaries": summaries, "episodes": results}
        (self.out / "metrics.json").write_text(json.dumps(data, indent=1, allow_nan=False))

        from .gait_picture import GaitRecorder, draw_gait, write_video

        with RollingEnv(**{**controller.env, **override}) as env:
            recorder = GaitRecorder(env, frames=self.video)
            run_episode(env, controller.start(env)(FIRST_SEED), FIRST_SEED, self.seconds, recorder)
        draw_gait(recorder, results[self.policy], self.out / "gait.png")
        if self.video:
            write_video(recorder.frames, recorder.fps, self.out / "roll.mp4")
        return Report(_text(summaries), {"out": str(self.out), "dt": dt, "summaries": summaries})


def shipped_table() -> str:
    """The table of tips of the default design that comes with the package."""
    from .controllers import shipped

    return str(shipped("walker") / "tips.json")


def _text(summaries: dict[str, dict[str, Any]]) -> str:
    header = ["controller", "median L/s", "mean L/s [95 %]", "over half median", "slip share", "(summed)", "tips",
              "cost of transport", "audit failures"]  # fmt: skip
    rows = []
    for name, s in summaries.items():
        interval = "[-]" if s["speed_lps_mean_ci95"] is None else "[{:.3f}, {:.3f}]".format(*s["speed_lps_mean_ci95"])
        cost = s["cost_of_transport_median"]
        rows.append([
            name, f"{s['speed_lps_median']:.3f}", f"{s['speed_lps_mean']:.3f} {interval}",
            f"{s['share_over_half_median']:.0%}", f"{s['slip_share_median']:.2f}",
            f"{s['slip_share_sum_median']:.2f}", f"{s['tips_median']:.0f}",
            "-" if cost is None else f"{cost:.0f}", f"{s['audit_failures']} of {s['episodes']}",
        ])  # fmt: skip
    return table(header, rows)


@dataclass(frozen=True)
class Roll:
    """Watch the shipped policy roll: a quick evaluation with pictures and a video; baselines for the default robot."""

    policy: str = "rolling"
    """A run's folder, or a shipped policy: rolling, onboard, flexible, carry, climb, steep, conditioned."""
    out: Path = Path("roll")
    """Folder for metrics.json, gait.png and roll.mp4."""
    episodes: int = 10
    """Episodes in the table."""
    window: bool = False
    """Instead: watch one episode in PyBullet's window, in real time; needs a display, writes nothing."""

    def run(self) -> Report:
        if self.window:
            return self._watch()
        plain = "design" not in policy_controller(self.policy).env  # another robot's walker takes minutes to tabulate
        return Evaluate(self.policy, self.out, self.episodes, baselines=plain).run()

    def _watch(self) -> Report:
        controller = policy_controller(self.policy)
        with RollingEnv(**{**controller.env, "render_mode": "human"}) as env:
            clock = _Clock()
            env.watch, env.watch_period = clock, 1 / 30
            row = run_episode(env, controller.start(env)(FIRST_SEED), FIRST_SEED, EPISODE_SECONDS)
        text = table(["policy", "L/s", "tips", "slip share"],
                     [[self.policy, row["speed_lps"], row["tips"], row["slip_share"]]])  # fmt: skip
        return Report(text, row)


class _Clock:
    """Draws the robot and waits until the wall clock has caught up with its time."""

    def __init__(self) -> None:
        self.lead: float | None = None

    def __call__(self, robot: TensegrityRobot) -> None:
        draw_in_window(robot)
        if self.lead is None:
            self.lead = time.perf_counter() - robot.time
        time.sleep(max(0.0, robot.time + self.lead - time.perf_counter()))
