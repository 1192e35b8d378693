"""Report: what a command has to say, as text for people and as one JSON object for programs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Report:
    """Result of one command.

    ``text`` is the readable table, ``data`` the same facts as plain JSON types; ``passed`` False makes the exit
    status 1.
    """

    text: str
    data: dict[str, Any]
    passed: bool = True


def table(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Left-aligned plain-text table; floats print with four significant digits."""
    cells = [list(header)] + [[f"{c:.4g}" if isinstance(c, float) else str(c) for c in row] for row in rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in cells]
    return "\n".join([lines[0], "  ".join("-" * w for w in widths), *lines[1:]])
