"""Sensors: what stands between a robot and what a controller sees of it: noise, bias, delay."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import DesignError


class Error(NamedTuple):
    """Of one kind of reading, in SI units."""

    noise: float = 0.0
    """Standard deviation of what is drawn anew at each reading."""
    bias: float = 0.0
    """Standard deviation of what is drawn once an episode, for each entry."""


class Entries(Protocol):
    """A run of an observation."""

    @property
    def name(self) -> str: ...

    @property
    def size(self) -> int: ...

    @property
    def bound(self) -> float: ...

    @property
    def scale(self) -> float:
        """What an entry of 1 is in SI units."""


class Sensors:
    """Those of one episode.

    Args:
        errors: by the name of the part of an observation that they are of; other parts are exact.
        delay: readings that an observation comes late.
        rng: draws the biases, and then the noise.
    """

    def __init__(self, errors: Mapping[str, Error], delay: int, rng: np.random.Generator) -> None:
        self._errors, self._rng = dict(errors), rng
        self._biases: dict[str, FloatArray] = {}
        self._seen: deque[FloatArray] = deque(maxlen=delay + 1)

    def check(self, parts: Sequence[Entries]) -> None:
        """Raise DesignError where an observation of these parts has not what the errors are of."""
        names = [part.name for part in parts]
        for name in self._errors.keys() - names:
            raise DesignError(f"Disturbance: errors of the {name} are given, which this observation does not have; "
                              "take an onboard one, or leave them 0")  # fmt: skip

    def through(self, values: FloatArray, parts: Sequence[Entries]) -> FloatArray:
        """(size,) what is seen of the values of an observation of these parts; the first until it has come.

        Raises as `check`.
        """
        if not self._seen:
            self.check(parts)
        values, start = values.copy(), 0
        for part in parts:
            own = values[start : start + part.size]
            start += part.size
            error = self._errors.get(part.name)
            if error is None:
                continue
            if part.name not in self._biases:
                self._biases[part.name] = error.bias * self._rng.standard_normal(part.size)
            own += (self._biases[part.name] + error.noise * self._rng.standard_normal(part.size)) / part.scale
            own.clip(-part.bound, part.bound, out=own)
        self._seen.append(values)
        return self._seen[0]
