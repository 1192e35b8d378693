"""Rows of a CSV as people's programs write them: commas, semicolons or tabs between, decimal points or commas."""

from __future__ import annotations

import csv
import io
import math
import re
from pathlib import Path
from typing import NamedTuple

from tensegym.errors import InputError

LARGEST = 20_000_000  # bytes
_COMMA = re.compile(r"[+-]?\d*,\d+(e[+-]?\d+)?", re.IGNORECASE)


class Rows(NamedTuple):
    """A CSV's header and cells."""

    header: list[str]
    cells: list[list[str]]
    """A list a row, as many as the header has."""
    lines: list[int]
    """Where in the file each row ends, from 1."""


def read_rows(path: Path, least: int = 1) -> Rows:
    """Header and rows of a CSV, blank lines and empty columns at the end left out.

    Columns stand between semicolons or tabs where the header has one, else between commas; with semicolons or tabs a
    number may have a decimal comma, which comes back as a point.

    Args:
        path: of the file, UTF-8 with or without a byte order mark.
        least: rows below the header.

    Raises:
        FileNotFoundError: where it is not there.
        InputError: for a file that is empty, no text, too large, or has a row of another width than its header.
    """
    if not path.is_file():
        raise FileNotFoundError(f"no file {path}")
    if path.stat().st_size > LARGEST:
        raise InputError(f"{path}: {path.stat().st_size / 1e6:.0f} MB; {LARGEST / 1e6:.0f} MB is the most")
    try:
        text = path.read_text(encoding="utf-8-sig")
        first = next((line for line in text.splitlines() if line.strip()), "")
        between = ";" if ";" in first else "\t" if "\t" in first else ","
        cells = csv.reader(io.StringIO(text, newline=""), delimiter=between)
        numbered = [([cell.strip() for cell in line], cells.line_num) for line in cells]
        lines = [line for line, _ in numbered if any(line)]
        numbers = [number for line, number in numbered if any(line)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: not a CSV text file") from error
    if len(lines) < 1 + least:
        raise InputError(f"{path}: no rows below the header" if lines else f"{path}: empty")
    header, *rows = lines
    while header and not header[-1] and all(len(row) < len(header) or not row[len(header) - 1] for row in rows):
        header.pop()
    out = []
    for number, row in zip(numbers[1:], rows, strict=True):
        while len(row) > len(header) and not row[-1]:
            row.pop()
        if len(row) != len(header):
            raise InputError(f"{path}, line {number}: {len(row)} cells where the header has {len(header)}")
        out.append([cell.replace(",", ".") if between != "," and _COMMA.fullmatch(cell) else cell for cell in row])
    return Rows(header, out, numbers[1:])


def number_of(cell: str, where: str) -> float:
    """The finite number of a cell, NaN for an empty one. Raises InputError that begins with ``where``."""
    if not cell:
        return math.nan
    try:
        value = float(cell) if "_" not in cell else math.inf
    except ValueError:
        value = math.inf
    if not math.isfinite(value):
        raise InputError(f"{where}: {cell[:60]!r} is not a number")
    return value
