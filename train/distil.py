"""Fits the pattern generator's feedback to the commands of a policy: `python -m tensegym.train.distil`.

Least squares of the policy's commands, less one half, on `control.cpg.pose_terms`. In the first round the policy
drives; in the later ones the generator itself does, with the weights so far, and the policy says what it would have
commanded there (dataset aggregation), so that the fit also covers the poses in which only the generator gets stuck.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.control.bearing import Bearing
from tensegym.control.cpg import Cpg, CpgController, cable_ends_in_heading, drive_kinds, feedback_text, pose_terms
from tensegym.control.policy import PolicyController
from tensegym.files import write_text
from tensegym.robot.robot import TensegrityRobot
from tensegym.tasks.policy_trials import EPISODE_SECONDS, policy_setup
from tensegym.tasks.trials import iterate

from .script import run_script


@dataclass(frozen=True)
class Distil:
    """Fit the pattern generator's feedback weights to a policy."""

    policy: str = "rolling"
    """A run's folder, or a shipped policy."""
    rounds: int = 6
    """Rounds of episodes, the policy driving in the first."""
    episodes: int = 12
    """Episodes of 20 s in a round, seeds 0 and on."""
    out: Path = Path("tensegym/control/feedback.toml")
    """File to write."""

    def __call__(self) -> str:
        setup = policy_setup(self.policy, seconds=EPISODE_SECONDS)
        policy, kinds = PolicyController(self.policy), drive_kinds(setup.design)
        examples, speeds = _Examples(policy), []
        for number in range(self.rounds):
            examples.generator = self._generator(examples, kinds) if number else None
            seeds = range(number * self.episodes, (number + 1) * self.episodes)
            speeds.append(np.mean([result.gait.speed_lps for result in iterate(setup, examples, seeds)]))
        write_text(self.out, feedback_text(fit(np.array(examples.terms), np.array(examples.commands), kinds)))
        return f"{self.out}: mean speed round by round {', '.join(f'{speed:.3f}' for speed in speeds)} L/s"

    def _generator(self, examples: _Examples, kinds: IntArray) -> CpgController:
        weights = fit(np.array(examples.terms), np.array(examples.commands), kinds)
        count = len(weights)
        return CpgController(Cpg(feedback=tuple(weights.ravel()), amplitudes=(0.4,) * count, lags=(0.0,) * count))


class _Examples:
    """A controller that keeps what the policy commands in the poses that it is led to, by itself or by a generator."""

    def __init__(self, policy: PolicyController) -> None:
        self.policy, self.period = policy, policy.period
        self.generator: CpgController | None = None
        self.terms: list[FloatArray] = []
        self.commands: list[FloatArray] = []

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        self.policy.begin(robot, seed)
        if self.generator:
            self.generator.begin(robot, seed)

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        action = self.policy.action(robot, bearing).astype(float)
        self.terms.append(pose_terms(cable_ends_in_heading(robot, bearing.direction)))
        self.commands.append(action / 2)
        return self.generator.angles(robot, bearing) if self.generator else robot.angles_of(action)


def fit(terms: FloatArray, commands: FloatArray, kinds: IntArray) -> FloatArray:
    """(kinds, TERMS) least-squares weights from terms (t, w, TERMS) and commands (t, w)."""
    return np.array([
        np.linalg.lstsq(terms[:, kinds == kind].reshape(-1, terms.shape[2]), commands[:, kinds == kind].ravel())[0]
        for kind in range(int(kinds.max()) + 1)
    ])  # fmt: skip


if __name__ == "__main__":
    run_script(Distil)
