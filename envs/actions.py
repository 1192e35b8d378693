"""What is an action: numbers of the right shape, refused in one line before an environment has stepped."""

from __future__ import annotations

from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError
from tensegym.tables import show


def as_action(action: Any, shape: tuple[int, ...]) -> FloatArray:
    """(w,) the action of one robot within its bounds, -1 to 1. Raises DesignError."""
    values = _shaped(action, shape, "an action has shape", "one number a drive", "one entry a drive")
    if not np.isfinite(values).all():
        raise DesignError(f"action {values.tolist()} has an entry that is no finite number; give -1 to 1 a drive")
    return np.clip(values, -1, 1)


def as_actions(actions: Any, shape: tuple[int, ...]) -> FloatArray:
    """(n, w) actions of n robots, as they are. Raises DesignError."""
    values = _shaped(actions, shape, "actions have shape", "a row of numbers each robot", "a row each robot")
    for i in np.flatnonzero(~np.isfinite(values).all(axis=1)):
        raise DesignError(f"row {i} of the actions, {values[i].tolist()}, has an entry that is no finite number")
    return values


def _shaped(values: Any, shape: tuple[int, ...], what: str, numbers: str, entries: str) -> FloatArray:
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise DesignError(f"{what} {shape}, {numbers}; given {show(values)}") from None
    if array.shape != shape:
        raise DesignError(f"{what} {shape}, {entries}; given {array.shape}")
    return array
