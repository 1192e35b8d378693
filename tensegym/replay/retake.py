"""Retakes: an episode of a set of trials once more, recorded; equal seeds give equal episodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tensegym.control.table import make_controller
from tensegym.tasks.trials import Setup, iterate

from .recorder import Recorder
from .recording import Recording


def retake(setup: Setup, seed: int, title: str = "") -> Recording:
    """The trial of a seed. Raises SimulationError where it diverged before there was anything to see."""
    recorder = Recorder(title)
    for _ in iterate(setup, make_controller(setup.controller), [seed], recorder):
        pass
    return recorder.recording()


def median_of(speeds: Sequence[float]) -> int:
    """Index of the median, of an even number the slower one of the two in the middle."""
    return int(np.argsort(speeds, kind="stable")[(len(speeds) - 1) // 2])
