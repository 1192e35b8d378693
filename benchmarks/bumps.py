"""How fast the default design, a search's start and what it found cross bumps of growing height, on new starts.

    tensegym design run --task cross --budget 61 --out runs/cross
    python benchmarks/bumps.py --folder runs/cross

Prints mean speeds [L/s] with their standard errors over root mean square heights of the ground [m].
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import tyro
from grounds import side_by_side


@dataclass(frozen=True)
class Bumps:
    """Speed over heights of the ground's bumps of the default design, a search's start and its best trial."""

    folder: Path
    """Folder of the search."""
    roughness: tuple[float, ...] = (0.0, 0.02, 0.05, 0.08)
    """Heights [m]."""
    episodes: int = 24
    """Starts a height."""
    candidates: int = 5
    """The best so many trials as searched, of which the best on other starts is taken."""

    def run(self) -> str:
        return side_by_side(self.folder, "roughness", self.roughness, self.episodes, self.candidates)[0]


if __name__ == "__main__":
    print(tyro.cli(Bumps).run())
