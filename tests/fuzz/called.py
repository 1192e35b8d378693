"""What is called with odd input, not read: a strategy of inputs, what takes one, and how to forget what broke it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from hypothesis.strategies import SearchStrategy

from tests.fuzz import arguments, commands
from tests.fuzz.environment import CALLS, Environment

Called = tuple[SearchStrategy[Any], Callable[[Any], None], Callable[[], None]]


def _nothing() -> None:
    """Nothing is kept between two calls."""


def _environment(folder: Path) -> Called:
    environment = Environment()
    return CALLS, environment.call, environment.close


def _command_lines(folder: Path) -> Called:
    commands.stand_in(folder)
    return commands.lines(), commands.run, _nothing


CALLED: dict[str, Callable[[Path], Called]] = {
    "environment": _environment,
    "gym.make": lambda folder: (arguments.MADE, arguments.make, _nothing),
    "copies": lambda folder: (arguments.COPIED, arguments.copied, _nothing),
    "command lines": _command_lines,
}
