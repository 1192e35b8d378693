"""The steepest incline that the default design, a search's start and what it found climb, on starts no search draws.

    tensegym design run --task climb --budget 113 --out runs/climb
    python benchmarks/inclines.py --folder runs/climb

Prints mean uphill speeds [L/s] with their standard errors. A slope is climbed at a mean of 0.05 L/s or more.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import tyro
from grounds import side_by_side

CLIMBED = 0.05  # L/s


@dataclass(frozen=True)
class Inclines:
    """Uphill speed over slopes of the default design, a search's start and its best trial."""

    folder: Path
    """Folder of the search."""
    slopes: tuple[float, ...] = (0.0, 4.0, 8.0, 10.0, 12.0, 14.0, 16.0)
    """Slopes [deg]."""
    episodes: int = 24
    """Starts a slope."""
    candidates: int = 10
    """The best so many trials as searched, of which the best on other starts is taken."""

    def run(self) -> str:
        text, tried = side_by_side(self.folder, "slope", self.slopes, self.episodes, self.candidates)
        for place, who in enumerate(("default", "start", "found")):
            climbed = [f"{s:g} deg" for s, row in zip(self.slopes, tried, strict=True) if row[place].speed >= CLIMBED]
            text += f"\nsteepest at {CLIMBED:g} L/s or more, {who}: {climbed[-1] if climbed else 'none'}"
        return text


if __name__ == "__main__":
    print(tyro.cli(Inclines).run())
