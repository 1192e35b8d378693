"""`tensegym evaluate`: what a gait is worth, over many seeds, faces and headings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from tensegym.errors import InputError
from tensegym.files import VERSION, lock_folder, write_text
from tensegym.replay.gait_figure import draw_gait
from tensegym.replay.replay_file import check_replay, write_replay
from tensegym.replay.retake import median_of, retake
from tensegym.replay.video import write_video
from tensegym.report import Report, table, to_json
from tensegym.robot.step_check import LARGEST_TIME_STEP, LEAST_TIME_STEP
from tensegym.tables import fill, in_file, read_toml
from tensegym.tasks.disturbance import Disturbance
from tensegym.tasks.motions import load_task
from tensegym.tasks.policy_trials import FIRST_SEED, baseline_setups, policy_setup
from tensegym.tasks.rollout import Result
from tensegym.tasks.trials import Setup, check_setup, run_trials, summarise

from .options import Count, Jobs, Within
from .standing import tell_unless_standing


@dataclass(frozen=True)
class Evaluate:
    """Evaluate a policy and the baselines from random faces and headings; writes metrics.json, gait.png, roll.mp4."""

    policy: str = "rolling"
    """A run's folder, or a shipped policy: rolling, onboard, fast, flexible, carry, climb, steep, sprint, agile,
    agile_onboard, steer, steer_onboard, steer_first, carry_steer, robust, three_rod, four_rod,
    four_rod_fast, conditioned."""
    out: Path = Path("evaluation")
    """Folder for metrics.json, gait.png and roll.mp4."""
    episodes: Count = 100
    """Episodes, each from a random face at a random heading towards a random direction."""
    task: str | None = None
    """A motion (roll, climb, cross, step, steer, places, path, course) or a TOML file with a [task] table, in place of
    the policy's own task."""
    disturb: Path | None = None
    """A TOML file of what goes otherwise than designed, as in mass = 0.2 (`tensegym fields disturbance`); default: as
    in the training."""
    seconds: Annotated[float, Within(1.0, 3600.0, "s")] | None = None
    """Length of an episode [s]; default: 20, or the given task's own."""
    dt: Annotated[float, Within(LEAST_TIME_STEP, LARGEST_TIME_STEP, "s")] | None = None
    """Physics time step [s]; default: the environment's."""
    engine: str | None = None
    """Physics engine: pybullet, or mujoco (extra mujoco); default: the task's."""
    baselines: bool = True
    """Also judge random commands and the open-loop walker on the same episodes."""
    half_step: bool = True
    """Also judge the policy at half the time step."""
    observation: str | None = None
    """Observation to evaluate with, in place of the policy's own."""
    video: bool = True
    """Write roll.mp4 of the median episode."""
    replay: Path | None = None
    """Write the median episode as one HTML file, such as run.html, that any browser plays without a network."""
    jobs: Jobs | None = None
    """Processes; default: one a core."""

    def run(self) -> Report:
        setup = policy_setup(
            self.policy, seconds=self.seconds, dt=self.dt, observation=self.observation,
            task=None if self.task is None else load_task(self.task), engine=self.engine,
        )  # fmt: skip
        if self.disturb is not None:
            with in_file(str(self.disturb)):
                disturb = fill(Disturbance, read_toml(self.disturb, "disturbance", InputError), "disturb", InputError)
            setup = replace(setup, task=setup.task.changed(disturb=disturb))
        check_setup(setup)  # a policy that does not fit fails here, before anything is written
        if self.replay is not None:
            check_replay(self.replay, self.out)
        with lock_folder(self.out):
            tell_unless_standing(setup.design, setup.task.engine)
            return self._evaluate(setup)

    def _evaluate(self, setup: Setup) -> Report:
        dt = setup.task.dt
        setups = {self.policy: setup}
        if self.half_step:
            setups[f"{self.policy}, half time step"] = setup.at(dt / 2)
        if self.baselines:
            setups |= baseline_setups(setup)
        seeds = range(FIRST_SEED, FIRST_SEED + self.episodes)
        results = {name: run_trials(each, seeds, jobs=self.jobs or 0) for name, each in setups.items()}
        summaries = {name: summarise(each) for name, each in results.items()}
        data = {"policy": self.policy, "engine": setup.task.engine, "dt": dt, "seconds": setup.task.seconds,
                "summaries": summaries,
                "episodes": {name: [result.row() for result in each] for name, each in results.items()}}  # fmt: skip
        write_text(self.out / "metrics.json", to_json({"version": VERSION, **data}, indent=1) + "\n")
        self._draw(setup, results[self.policy])
        return Report(_text(summaries, setup.task.MEASURES), {"out": str(self.out), "dt": dt, "summaries": summaries})

    def _draw(self, setup: Setup, results: Sequence[Result]) -> None:
        speeds = [result.gait.speed_lps for result in results]
        seed = results[median_of(speeds)].seed
        recording = retake(setup, seed, f"{self.policy}: the median of {len(speeds)} episodes, seed {seed}")
        draw_gait(recording, speeds, self.out / "gait.png")
        if self.video:
            write_video(recording, self.out / "roll.mp4")
        if self.replay is not None:
            write_replay(recording, self.replay)


def _text(summaries: dict[str, dict[str, Any]], measures: tuple[str, ...]) -> str:
    header = ["controller", "median L/s", "mean L/s [95 %]", "over half median", "slip share", "(summed)", "tips",
              "cost of transport", "s to stride", "drive load", "peak tension N", "audit failures"]  # fmt: skip
    rows = []
    for name, s in summaries.items():
        interval = "[-]" if s["speed_lps_mean_ci95"] is None else "[{:.3f}, {:.3f}]".format(*s["speed_lps_mean_ci95"])
        cost = s["cost_of_transport_median"]
        rows.append([
            name, f"{s['speed_lps_median']:.3f}", f"{s['speed_lps_mean']:.3f} {interval}",
            f"{s['share_over_half_median']:.0%}", f"{s['slip_share_median']:.2f}",
            f"{s['slip_share_sum_median']:.2f}", f"{s['tips_median']:.0f}",
            "-" if cost is None else f"{cost:.1f}", f"{s['stride_median']:.1f}", f"{s['drive_load_max']:.2f}",
            f"{s['peak_tension_max']:.0f}", f"{s['audit_failures']} of {s['episodes']}",
        ])  # fmt: skip
    texts = [table(header, rows)]
    if measures:
        shown = [[name, *("{median:.3g} [{least:.3g}, {most:.3g}]".format(**s["measures"][measure])
                          for measure in measures)] for name, s in summaries.items()]  # fmt: skip
        texts.append("median [least, most] of\n" + table(["controller", *measures], shown))
    fallen = [f"{name}: {s['fallen']} of {s['episodes']} episodes ended flat on the ground and make no way"
              for name, s in summaries.items() if s["fallen"]]  # fmt: skip
    faults = [f"{name}, first audit failure: {s['audit_fault']}" for name, s in summaries.items() if s["audit_fault"]]
    return "\n\n".join([*texts, *fallen, *faults])
