"""The robots of a design study, each once more at its task, from one start, to be seen side by side."""

from __future__ import annotations

from tensegym.errors import InputError, TensegymError
from tensegym.replay import Recording
from tensegym.replay.retake import retake
from tensegym.search.evaluate import TrialSpec
from tensegym.search.problem import Problem
from tensegym.search.store import Finished
from tensegym.search.winner import ranked
from tensegym.tasks.policy_trials import FIRST_SEED

START = "start"


def study_recordings(problem: Problem, finished: Finished, most: int) -> tuple[list[Recording], list[str]]:
    """What the study began with and its best trials do, and a name for each: its number and first objective.

    Robots that cannot be shown, since they diverge at once, are left out.

    Raises:
        InputError: none is left.
    """
    objective = problem.settings.objectives[0]
    rows = [(START, problem.space.start)]
    rows += [(f"trial {n}: {objective.metric} {finished[n][1].metrics[objective.metric]:.3g}", finished[n][0])
             for n in ranked(problem, finished)[:most]]  # fmt: skip
    recordings, names = list[Recording](), list[str]()
    for number, (name, values) in enumerate(rows):
        tables = problem.space.apply(values)
        spec = TrialSpec(number, tables["design"], tables["controller"], problem.task, (FIRST_SEED,))
        try:
            recordings.append(retake(spec.setup(), FIRST_SEED, name))
        except TensegymError:
            continue
        names.append(name)
    if not recordings:
        raise InputError(f"none of the study's {len(rows)} robots can be shown: all diverge at once")
    return recordings, names
