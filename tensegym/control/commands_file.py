"""Drive-angle commands against time from a CSV, as people's programs and loggers write it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import InputError
from tensegym.tables import number_of, one_line, read_rows

LONGEST_STEP = 3.0  # typical steps: jitter and rounded stamps stay far below, a row that was lost does not


def read_commands(path: Path, count: int) -> tuple[FloatArray, FloatArray]:
    """Times (t,) [s] and commanded spool angles (t, count) [rad].

    Times need not be even, since commands are linear in between: a logger's rounded stamps and its jitter are read.

    Args:
        path: CSV with the columns time_s, drive_1_rad, drive_2_rad and so on, as `tensegym.tables.rows` reads it.
        count: of drives.

    Raises:
        FileNotFoundError: where it is not there.
        InputError: naming the line: wrong columns, a cell that is no finite number, times that do not grow, a gap of
            more than LONGEST_STEP typical steps.
    """
    header, rows, lines = read_rows(path)
    wanted = ["time_s", *(f"drive_{i + 1}_rad" for i in range(count))]
    if header != wanted:
        raise InputError(one_line(f"{path}: the header must be {', '.join(wanted)}; found {', '.join(header)}"))
    values = np.array([[number_of(cell, f"{path}, line {line}: {name}") for name, cell in zip(wanted, row, strict=True)]
                       for row, line in zip(rows, lines, strict=True)])  # fmt: skip
    if not np.isfinite(values).all():
        row, column = np.argwhere(~np.isfinite(values))[0]
        raise InputError(f"{path}, line {lines[row]}: {wanted[column]} = '' is no finite number; fill the gap")
    if len(values) < 2:
        raise InputError(f"{path}: {len(values)} rows of commands; give two or more")
    steps = np.diff(values[:, 0])
    if (steps <= 0).any():
        raise InputError(f"{path}, line {lines[int(np.argmax(steps <= 0)) + 1]}: time_s must grow from row to row")
    typical = float(np.median(steps))
    longest = int(steps.argmax())
    if steps[longest] > LONGEST_STEP * typical:
        raise InputError(
            f"{path}, line {lines[longest + 1]}: a step of {steps[longest]:g} s where the others are {typical:g} s, a "
            f"gap; steps of up to {LONGEST_STEP:g} times the typical one are read"
        )
    return values[:, 0], values[:, 1:]
