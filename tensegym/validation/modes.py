"""M2: frequencies of free flight, linearised about rest."""

from __future__ import annotations

from collections.abc import Iterator

from tensegym.structure.modes import free_modes
from tensegym.structure.structure import six_rod

from .check import Check

PRINTED_MODES = ((1.819, 1), (5.238, 3), (6.581, 3), (7.290, 2), (9.301, 3), (11.048, 3), (12.328, 2), (14.052, 3),
                 (19.004, 3), (21.236, 1))  # fmt: skip


def rows(engine: str = "pybullet") -> Iterator[Check]:
    """M2: free elastic modes, L 1 m, m 1 kg slender rods, k 1000 N/m, T 10 N; no engine takes part."""
    found = free_modes(six_rod(1.0), 10.0, 1000.0, 1.0, 1 / 12).multiplicities()
    yield Check("M2", "distinct frequencies", len(PRINTED_MODES), len(found), 0)
    for (frequency, count), (measured, repeats) in zip(PRINTED_MODES, found, strict=True):
        yield Check("M2", f"mode of {frequency:.3f} Hz, {count}-fold: Hz", frequency, measured, 5.1e-4)
        yield Check("M2", f"mode of {frequency:.3f} Hz: multiplicity", count, repeats, 0)
