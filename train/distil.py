"""Fits the pattern generator's feedback to the commands of a policy: `python -m tensegym.train.distil`.

Least squares of the policy's commands, less one half, on `control.cpg.pose_terms`. In the first round the policy
drives; in the later ones the generator itself does, with the weights so far, and the policy says what it would have
commanded there (dataset aggregation), so that the fit also covers the poses in which only the generator gets stuck.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro

from tensegym.arrays import FloatArray, IntArray
from tensegym.control.cpg import Cpg, CpgController, cable_ends_in_heading, drive_kinds, feedback_text, pose_terms
from tensegym.envs.rolling import RollingEnv

from .controllers import policy_controller

STEPS = 50  # of an episode


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

    def run(self) -> str:
        controller = policy_controller(self.policy)
        terms: list[FloatArray] = []
        commands: list[FloatArray] = []
        speeds: list[float] = []
        weights: FloatArray | None = None
        with RollingEnv(**controller.env) as env:
            episode = controller.start(env)
            kinds = drive_kinds(env.robot.design)
            for seed in range(self.rounds * self.episodes):
                if seed and seed % self.episodes == 0:
                    weights = fit(np.array(terms), np.array(commands), kinds)
                observation, _ = env.reset(seed=seed)
                act = episode(seed)
                generator = None
                if weights is not None:
                    generator = CpgController(env.robot, Cpg(feedback=tuple(weights.ravel())), env.direction)
                for _ in range(STEPS):
                    action = np.clip(act(observation), -1, 1)
                    terms.append(pose_terms(cable_ends_in_heading(env.robot, env.direction)))
                    commands.append(action / 2)
                    if generator:
                        action = 2 * generator.angles() / env.robot.command_limit - 1
                    observation, _, _, _, info = env.step(action)
                speeds.append(info["gait"]["speed_lps"])
        weights = fit(np.array(terms), np.array(commands), kinds)
        self.out.write_text(feedback_text(weights))
        means = np.mean(np.reshape(speeds, (self.rounds, self.episodes)), axis=1)
        return f"{self.out}: mean speed round by round {', '.join(f'{m:.3f}' for m in means)} L/s"


def fit(terms: FloatArray, commands: FloatArray, kinds: IntArray) -> FloatArray:
    """(kinds, TERMS) least-squares weights from terms (t, w, TERMS) and commands (t, w)."""
    return np.array([
        np.linalg.lstsq(terms[:, kinds == kind].reshape(-1, terms.shape[2]), commands[:, kinds == kind].ravel())[0]
        for kind in range(int(kinds.max()) + 1)
    ])  # fmt: skip


if __name__ == "__main__":
    print(tyro.cli(Distil).run())
