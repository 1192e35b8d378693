"""Report: what a command has to say, as text for people and as one JSON object for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np


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


def to_json(data: Mapping[str, Any], indent: int | None = None) -> str:
    """JSON text of a table of facts, NumPy's numbers and arrays in it as plain ones.

    JSON knows no nan and no infinity: they become null, and ``not_finite`` at the end says where they stood and what
    they were, as in {"gait.cost_of_transport": "inf"}.
    """
    lost: dict[str, str] = {}
    plain = _plain(data, (), lost)
    return json.dumps(plain | ({"not_finite": lost} if lost else {}), indent=indent, allow_nan=False)


def _plain(value: Any, path: tuple[str, ...], lost: dict[str, str]) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(part, (*path, str(key)), lost) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part, (*path, str(n)), lost) for n, part in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        lost[".".join(path)] = str(value)
        return None
    return value
