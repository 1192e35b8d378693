"""Start: where an episode begins, drawn at random unless it is told."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tensegym.errors import DesignError

OPTIONS = ("face", "heading", "direction")


class Start(NamedTuple):
    """Standing on a face."""

    face: int
    """Index into the robot's faces."""
    heading: float
    """Turn about the vertical [rad]."""
    direction: float
    """Angle of a direction from the world's x axis [rad], for goals that want one."""


def draw_start(faces: Sequence[int], rng: np.random.Generator, options: Mapping[str, Any]) -> Start:
    """A random start, with what the options give in its place: the same draws are made whatever they give.

    Args:
        faces: that it may be on, one as often as it is there.
        rng: makes three draws.
        options: face, heading, direction; others are left alone.
    """
    face, heading = faces[int(rng.integers(len(faces)))], float(rng.uniform(-math.pi, math.pi))
    direction = float(rng.uniform(-math.pi, math.pi))
    return Start(options.get("face", face), options.get("heading", heading), options.get("direction", direction))


def check_options(options: Mapping[str, Any], faces: int) -> None:
    """Raises DesignError naming the first of face, heading and direction that is none."""
    for name in ("heading", "direction"):
        value = options.get(name, 0.0)
        number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
        if not (number and math.isfinite(value)):
            raise DesignError(f"reset option {name} = {value!r} must be a finite angle [rad]")
    face = options.get("face", 0)
    if isinstance(face, bool) or not isinstance(face, int | np.integer):
        raise DesignError(f"reset option face = {face!r} must be a whole number")
    if not 0 <= face < faces:
        raise DesignError(f"reset option face = {face} is outside 0..{faces - 1}")
