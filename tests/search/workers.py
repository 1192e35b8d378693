"""Evaluations that cost nothing, for the engines and the loop; importable by worker processes."""

import math
import os
import signal
from pathlib import Path

from tensegym.search.evaluate import TrialResult, TrialSpec

METRICS = {"sound": 1.0, "audit_excess": 0.0}


def quick(trial: TrialSpec) -> TrialResult:
    """A smooth function of the trial's fields, with the seeds in it; every seventh design is refused."""
    if trial.number % 7 == 6:
        return TrialResult(trial.number, refused="every seventh is")
    pretension = trial.design["elastic_cable"]["pretension"]
    lag = trial.controller["lags"][0]
    speed = math.exp(-(math.log(pretension / 9) ** 2) - (lag - 0.4) ** 2) + 1e-12 * trial.seeds[0]
    return TrialResult(trial.number, METRICS | {"speed_lps": speed, "mass": lag**2}, len(trial.seeds))


def killed_once(trial: TrialSpec) -> TrialResult:
    """Ends its process the hard way on trial 1, the first time; the folder to note that in is the policy's name."""
    note = Path(trial.controller["policy"])
    if trial.number == 1 and not note.exists():
        note.write_text("killed")
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(trial)
