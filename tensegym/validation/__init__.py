"""The physics against closed forms, each measured on the running code: one topic a file, one row a closed form.

Where the expected values come from is in docs/physics.md.
"""

from collections.abc import Callable, Iterator

from . import breathing, drives, flight, geometry, modes, statics
from .check import Check

__all__ = ["TOPICS", "Check"]

TOPICS: dict[str, Callable[[str], Iterator[Check]]] = {  # of an engine
    "statics": statics.rows,
    "breathing": breathing.rows,
    "modes": modes.rows,
    "geometry": geometry.rows,
    "flight": flight.rows,
    "drives": drives.rows,
}
