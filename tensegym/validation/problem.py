"""Problem: one that the validation page measures, a function of an engine."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from .row import Findings

BOTH, PYBULLET, NONE = ("pybullet", "mujoco"), ("pybullet",), ("",)


class Problem(NamedTuple):
    """What is measured, and in which engines."""

    section: str
    title: str
    source: str
    """Where the expected values come from."""
    measure: Callable[[str], Findings]
    """Of an engine's name; its docstring says what is done."""
    engines: tuple[str, ...] = BOTH
    """In which it can be; one empty name where no engine takes part."""
    minutes: float = 0.1
    """About what it takes in one engine, to begin with the long ones."""
    needs: tuple[str, ...] = ()
    """Engines that it compares, and is left out without."""
