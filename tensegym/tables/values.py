"""Values as a table gives them: checked one by one, shown in short."""

from __future__ import annotations

import difflib
import math
import numbers
import reprlib
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import TensegymError
from tensegym.errors import one_line as one_line

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = 60
_SHORT.maxlong, _SHORT.maxlist, _SHORT.maxtuple, _SHORT.maxdict, _SHORT.maxlevel = 40, 4, 4, 3, 3

Error = type[TensegymError]


def show(value: Any) -> str:
    """A value as Python writes it, shortened to what a message has room for."""
    try:
        text = _SHORT.repr(value)
    except ValueError:  # an integer of more digits than Python writes
        return "a number of thousands of digits"
    return text if len(text) <= 120 else text[:117] + "..."


@contextmanager
def in_file(name: str) -> Iterator[None]:
    """Put a file's name before the message of any of the project's errors raised in the block."""
    try:
        yield
    except TensegymError as error:
        raise type(error)(one_line(f"{name}: {error}")) from error


def mapping(value: Any, where: str, error: Error) -> dict[str, Any]:
    """The value if it is a table. Raises ``error`` naming it by ``where``."""
    if not isinstance(value, dict):
        raise error(one_line(f"{where} = {show(value)} must be a table of fields"))
    return value


def known(table: Any, allowed: Collection[str], where: str, error: Error) -> dict[str, Any]:
    """The table if it has no field but the allowed ones.

    Args:
        table: what is read.
        allowed: names of the fields.
        where: names the table in messages.
        error: what is raised: an unknown field, with the nearest that there is.
    """
    fields = mapping(table, where, error)
    for name in fields:
        if name not in allowed:
            raise error(one_line(f"unknown field {show(name)} in {where}; {hint(name, allowed)}"))
    return fields


def hint(name: Any, allowed: Collection[str]) -> str:
    """For a message about a name that there is not: the nearest that there is, or all of them."""
    close = difflib.get_close_matches(str(name)[:100], allowed, 1)
    return f"did you mean {close[0]!r}?" if close else f"one of {', '.join(sorted(allowed))}"


def as_number(value: Any, where: str, error: Error, wanted: str = "a finite number") -> float:
    """A finite float; whole numbers are taken, true and false are none.

    Args:
        value: what is read.
        where: names the value in messages.
        error: what is raised.
        wanted: what to give, for the message.
    """
    if isinstance(value, numbers.Real) and not isinstance(value, bool | np.bool_):
        try:
            number = float(value)
        except OverflowError:  # an integer beyond every float
            number = math.inf
        if math.isfinite(number):
            return number
    raise error(one_line(f"{where} = {show(value)} {_kind(value)}; give {wanted}"))


def as_whole(value: Any, where: str, error: Error, wanted: str = "a whole number") -> int:
    """A whole number. Raises ``error`` naming it by ``where``, with ``wanted`` as what to give."""
    if isinstance(value, numbers.Integral) and not isinstance(value, bool | np.bool_):
        return int(value)
    raise error(one_line(f"{where} = {show(value)} is no whole number; give {wanted}"))


def as_text(value: Any, where: str, error: Error) -> str:
    """A text. Raises ``error`` naming it by ``where``."""
    if isinstance(value, str):
        return value
    raise error(one_line(f"{where} = {show(value)} must be a text"))


def as_numbers(value: Any, count: int | None, where: str, error: Error) -> tuple[float, ...]:
    """A list of finite numbers, ``count`` of them unless that is None. Raises ``error`` naming the entry."""
    many = "numbers" if count is None else f"{count} numbers"
    if not isinstance(value, list | tuple | np.ndarray) or (count is not None and len(value) != count):
        raise error(one_line(f"{where} = {show(value)}; give a list of {many}"))
    return tuple(as_number(v, f"{where}[{i + 1}]", error) for i, v in enumerate(value))


def as_rows(value: Any, width: int, where: str, error: Error, wanted: str = "") -> FloatArray:
    """Rows of finite numbers.

    Args:
        value: what is read; [] is no row.
        width: numbers in every row.
        where: names the table in messages, which count its rows from 1.
        error: what is raised, naming the first row that is none.
        wanted: what a row holds, for the message.

    Returns:
        (rows, width) array.
    """
    wanted = wanted or f"{width} numbers"
    value = value.tolist() if isinstance(value, np.ndarray) else value
    if not isinstance(value, list | tuple):
        raise error(one_line(f"{where} = {show(value)}; give a list of rows of {wanted}"))
    for i, row in enumerate(value):
        if not isinstance(row, list | tuple) or len(row) != width:
            count = f" has {len(row)} entries" if isinstance(row, list | tuple) else ""
            raise error(one_line(f"{where} row {i + 1} = {show(row)}{count}; a row holds {wanted}"))
    rows = [as_numbers(row, width, f"{where} row {i + 1}", error) for i, row in enumerate(value)]
    return np.array(rows, dtype=float).reshape(-1, width)


def as_whole_rows(value: Any, width: int, where: str, error: Error, wanted: str = "") -> IntArray:
    """Rows of whole numbers; arguments as of `as_rows`."""
    rows = as_rows(value, width, where, error, wanted)
    broken = np.argwhere((rows != np.rint(rows)) | (np.abs(rows) > 2**53))
    if len(broken):
        row, entry = broken[0].tolist()
        given = show(rows[row].tolist())
        raise error(one_line(f"{where} row {row + 1} = {given}: entry {entry + 1} is no whole number"))
    return rows.astype(np.int64)


def _kind(value: Any) -> str:
    if isinstance(value, bool | np.bool_):
        return "is true or false, no number"
    if isinstance(value, list | tuple):
        return f"is a list of {len(value)} where one value stands"
    if isinstance(value, str):
        try:
            float(value)
        except ValueError:
            return "is a text, no number"
        return "is a text; write it without quotation marks, and in YAML 1.0e-4 for 1e-4"
    return "is no finite number"
