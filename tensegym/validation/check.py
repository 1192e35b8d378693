"""One row of `tensegym validate`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray


@dataclass(frozen=True)
class Check:
    """One row: measured is within tolerance of expected, in the unit of the quantity."""

    id: str
    quantity: str
    expected: float
    measured: float
    tolerance: float

    @property
    def passed(self) -> bool:
        return bool(abs(self.measured - self.expected) <= self.tolerance)


def furthest(values: FloatArray, target: float) -> float:
    """The value that is furthest from ``target``."""
    return float(values[np.abs(values - target).argmax()])
