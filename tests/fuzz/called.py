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


def _warm() -> None:
    """Compile the kernels that calls need, where no one waits for it."""
    for make, move in arguments.LIVING.values():
        living = make("begun")
        move(living)
        arguments.close(living)


def _environment(folder: Path) -> Called:
    _warm()
    environment = Environment()
    return CALLS, environment.call, environment.close


def _made(folder: Path) -> Called:
    _warm()
    return arguments.MADE, arguments.make, _nothing


def _copies(folder: Path) -> Called:
    _warm()
    return arguments.COPIED, arguments.copied, _nothing


def _command_lines(folder: Path) -> Called:
    _warm()
    commands.stand_in(folder)
    return commands.lines(), commands.run, _nothing


CALLED: dict[str, Callable[[Path], Called]] = {
    "environment": _environment,
    "gym.make": _made,
    "copies": _copies,
    "command lines": _command_lines,
}
