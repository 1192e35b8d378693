"""One root exception; every error is also the builtin a caller would expect."""

import re

LONGEST = 300  # characters of a message, whatever stood in the input that it names
LONG_WORD = re.compile(r"(?<!\S)\S+(?=\S{40})")  # what stands before the last 40 characters of a word, such as a path


class TensegymError(Exception):
    """Root of every error this package raises on purpose; its text is one line of at most 300 characters."""

    def __str__(self) -> str:
        return one_line(super().__str__())


def one_line(text: str) -> str:
    """A message without line breaks; a long one leaves out the start of long words (a path), then its middle."""
    text = " ".join(text.split())
    if len(text) > LONGEST:
        text = LONG_WORD.sub("...", text)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 105]} ... {text[-100:]}"


class StructureError(TensegymError, ValueError):
    """Nodes, rods or cables that do not make a tensegrity, or that no self-stress can hold."""


class DesignError(TensegymError, ValueError):
    """A design field that is unknown, missing or outside its allowed range."""


class ShapeError(DesignError, StructureError):
    """A shape that the cables of a structure do not make, or do not hold."""


class FlexureError(TensegymError, ValueError):
    """A hinge, a joint model or measured data that cannot be used as given."""


class InputError(TensegymError, ValueError):
    """A file or a command-line value that cannot be used as given."""


class SimulationError(TensegymError, RuntimeError):
    """The simulation left the states it can be trusted in."""
