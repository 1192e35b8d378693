"""What to try next: Optuna's samplers behind ask and tell, such that a search can be replayed exactly.

The Optuna study in here lives in memory. Each batch has a sampler seeded by (seed, batch), and outcomes are told in
the order in which they were asked for, so the same outcomes always lead to the same questions: a search that was
killed is resumed by asking again from the start and telling what is stored, whatever state a sampler keeps.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import optuna
from optuna.distributions import BaseDistribution, CategoricalDistribution, FloatDistribution
from optuna.trial import Trial, TrialState

from .evaluate import TrialResult
from .measure import Objective
from .problem import Problem
from .space import Dimension, Value

PENALTY = 1.0  # added to the objective of cmaes, which knows no constraints, for each unit of a broken one


def distribution(dimension: Dimension) -> BaseDistribution:
    """A dimension as Optuna has it; a choice is the index into its choices."""
    if dimension.choices:
        return CategoricalDistribution(tuple(range(len(dimension.choices))))
    return FloatDistribution(dimension.range.low, dimension.range.high, log=dimension.range.log)


class Asker:
    """ask and tell by batches; batch 0 is the start alone."""

    def __init__(self, problem: Problem) -> None:
        self.problem, self.settings = problem, problem.settings
        self.distributions = {d.name: distribution(d) for d in problem.space.dimensions}
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        self._study = optuna.create_study(directions=[o.direction for o in self.settings.objectives])
        self._asked: list[Trial] = []
        self._batch = 0

    def ask(self) -> list[dict[str, Value]]:
        """Values of the next batch's trials, by dimension name."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # samplers call some of their arguments experimental
            self._study.sampler = self._sampler(int(np.random.SeedSequence(
                (self.settings.seed, self._batch)).generate_state(1)[0]))  # fmt: skip
            if self._batch == 0:
                self._study.enqueue_trial(self.problem.space.start)
            count = self.settings.batch if self._batch else 1
            self._asked = [self._study.ask(fixed_distributions=self.distributions) for _ in range(count)]
        self._batch += 1
        return [dict(trial.params) for trial in self._asked]

    def tell(self, outcomes: Sequence[TrialResult]) -> None:
        """Outcomes of the whole batch, in the order asked. A refused design tells the sampler nothing but that."""
        for trial, outcome in zip(self._asked, outcomes, strict=True):
            if outcome.refused is not None:
                self._study.tell(trial, state=TrialState.FAIL)
                continue
            if self.settings.sampler in ("nsga2", "tpe"):
                for i, broken in enumerate(self.problem.losses(outcome.metrics)):
                    trial.set_constraint(f"c{i}", broken)
            self._study.tell(trial, self.values(outcome.metrics))

    def values(self, metrics: dict[str, float]) -> list[float]:
        """Objectives as told to the sampler."""
        values = [metrics[o.metric] for o in self.settings.objectives]
        if self.settings.sampler == "cmaes":
            values = [penalised(self.problem, metrics)]
        return values

    def _sampler(self, seed: int) -> optuna.samplers.BaseSampler:
        samplers = optuna.samplers
        if self.settings.sampler == "cmaes":
            return samplers.CmaEsSampler(  # begins in the middle of the ranges, where random search is on average
                sigma0=self.settings.sigma, popsize=self.settings.batch, seed=seed,
                warn_independent_sampling=False, independent_sampler=samplers.RandomSampler(seed=seed),
            )  # fmt: skip
        if self.settings.sampler == "nsga2":
            return samplers.NSGAIISampler(population_size=self.settings.batch, seed=seed)
        if self.settings.sampler == "tpe":
            return samplers.TPESampler(seed=seed, multivariate=True)
        return samplers.RandomSampler(seed=seed)


def penalised(problem: Problem, metrics: dict[str, float]) -> float:
    """The first objective, made worse by PENALTY for each unit of a broken constraint."""
    objective: Objective = problem.settings.objectives[0]
    broken = sum(max(0.0, loss) for loss in problem.losses(metrics))
    return metrics[objective.metric] + (-PENALTY if objective.maximise else PENALTY) * broken
