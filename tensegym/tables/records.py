"""A JSON file of one list: a dataclass a row, under the list's name."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from .fields import fill
from .text import read_json
from .values import Error, in_file, show

T = TypeVar("T")


def read_records(path: Path, name: str, kind: type[T], origin: str, error: Error) -> list[T]:
    """The rows of the list called ``name``, or of a file that is the list alone.

    Raises ``error`` naming the row and the field, or FileNotFoundError, which says of what ``origin`` such a file is.
    """
    what = f"table of {name}"
    if not path.is_file():
        raise FileNotFoundError(f"no {what} {path}; make one with `{origin}`")
    data = read_json(path, what, error)
    rows = data.get(name) if isinstance(data, dict) else data
    with in_file(f"{what} {path}"):
        if not isinstance(rows, list) or not rows:
            raise error(f"{name} = {show(rows)} must be a list of one row or more")
        return [fill(kind, row, f"{name} row {number}", error) for number, row in enumerate(rows, 1)]
