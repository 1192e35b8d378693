"""Stride: how long a robot takes until it goes as fast as it will."""

from __future__ import annotations

import math

import numpy as np

from tensegym.arrays import FloatArray

WINDOW = 3.0  # s: a speed is that over so long a time
_SHARE = 0.9


def time_to_stride(way: FloatArray, period: float) -> tuple[float, float]:
    """Seconds from the start until the speed over the next `WINDOW` seconds is first 90 % of the steady one, and that.

    The steady speed is the mean one of the second half.

    Args:
        way: (n,) made along what was wanted [any length], one entry a period from the start on.
        period: between two entries [s].

    Returns:
        (seconds, steady speed); inf where it makes no way in the second half.
    """
    window, middle = max(1, round(WINDOW / period)), len(way) // 2
    steady = (way[-1] - way[middle]) / ((len(way) - 1 - middle) * period)
    if not steady > 0:
        return math.inf, float(steady)
    speeds = (way[window:] - way[:-window]) / (window * period)
    reached = np.flatnonzero(speeds >= _SHARE * steady)
    return (float(reached[0] * period) if len(reached) else math.inf), float(steady)
