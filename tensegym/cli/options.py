"""Numbers on a command line: each option that is one carries its range, and is checked before its command runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from tyro.constructors import PrimitiveConstructorSpec

from tensegym.errors import InputError


class Within(PrimitiveConstructorSpec[Any]):
    """A number in [low, high], shown as such by --help; ``jobs: Annotated[int, Within(1, 512)] = 1``.

    Args:
        low, high: the ends, both allowed. They are integers where the option is one.
        unit: of the number, for people.
    """

    def __init__(self, low: float, high: float, unit: str = "") -> None:
        kind = type(high)
        super().__init__(
            nargs=1,
            metavar=f"{low:g}..{high:g} {unit}".rstrip(),
            instance_from_str=lambda words: kind(words[0]),
            is_instance=lambda value: isinstance(value, kind),
            str_from_instance=lambda value: [str(value)],
        )
        self.low, self.high, self.unit = low, high, unit


MOST = 10**9  # more than any count of episodes, trials or steps that ends
Count = Annotated[int, Within(1, MOST)]
Seed = Annotated[int, Within(0, 2**31 - 1)]
Jobs = Annotated[int, Within(1, 512)]


def check_ranges(command: Any) -> None:
    """Look at every number of a command, those of nested groups of options too.

    Raises:
        InputError: one is no number or outside its range; named as its option is.
    """
    hints = get_type_hints(type(command), include_extras=True)
    for field in fields(command):
        value = getattr(command, field.name)
        if is_dataclass(value):
            check_ranges(value)
        for within in _ranges(hints[field.name]):
            for number in value if isinstance(value, tuple) else (value,):
                if number is not None and not within.low <= number <= within.high:  # nan is nowhere within
                    allowed = f"[{within.low:g}, {within.high:g}] {within.unit}".rstrip()
                    raise InputError(f"{field.name} = {number!r} is outside {allowed}")


def _ranges(hint: Any) -> Iterator[Within]:
    if get_origin(hint) is Annotated:
        yield from (extra for extra in hint.__metadata__ if isinstance(extra, Within))
    for part in get_args(hint):
        yield from _ranges(part)
