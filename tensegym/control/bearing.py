"""Bearing: where to, as a controller is told it at each of its periods."""

from __future__ import annotations

import math
from typing import NamedTuple

from tensegym.arrays import FloatArray


class Bearing(NamedTuple):
    """The way to go from where a robot is."""

    direction: FloatArray
    """(2,) unit vector in the world's horizontal plane."""
    distance: float = math.inf
    """To the place to go to [m]; inf where a direction is all that is wanted."""
    stay: bool = False
    """Whether to stop at that place."""
