"""Part: what one comparison comes to."""

from __future__ import annotations

from typing import Any, NamedTuple

ENGINES = ("pybullet", "mujoco")  # whose second is compared with its first


class Part(NamedTuple):
    """A comparison's table, and what it says."""

    title: str
    header: list[str]
    rows: list[list[Any]]
    agrees: bool
    """Whether the engines are as near as the comparison asks for."""
    verdict: str
    """By how much they differ, and why, in a sentence or two."""
    curves: dict[str, Any]
    """What the picture draws: plain JSON types, named with their units."""
