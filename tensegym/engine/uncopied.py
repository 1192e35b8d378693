"""What lives in an engine: it is not copied, and something else stands in its place when it is closed."""

from __future__ import annotations

from typing import Any, NoReturn

from tensegym.errors import SimulationError


class Uncopied:
    """Base of what lives in an engine or in processes. Copying or pickling it raises SimulationError."""

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        raise SimulationError(f"a {type(self).__name__} is not copied and not pickled, since two would share one "
                              "simulation: make another one")  # fmt: skip


class Closed(Uncopied):
    """In place of a world that was closed: whatever is asked of it raises SimulationError."""

    def close(self) -> None:
        """Once more changes nothing."""

    def __getattr__(self, name: str) -> NoReturn:
        raise SimulationError("the robot is closed: make another one")
