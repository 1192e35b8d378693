"""Row and Findings: what a problem of the validation page comes to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .check import Check


@dataclass(frozen=True)
class Row(Check):
    """A check at a time step, with what is to be said about it."""

    dt: float | None = None
    """Time step [s]; None where nothing is stepped."""
    note: str = ""
    """Why it fails, or what else to know."""


@dataclass(frozen=True)
class Findings:
    """Rows of a problem, and what its figure is drawn from: plain JSON types, named with their units."""

    rows: list[Row]
    curves: dict[str, Any] = field(default_factory=dict)
