"""Measured states of a hinge: a CSV whose header names every unit, read as ``States``.

A header is QUANTITY_UNIT, as in ``angle_deg,x_mm,y_mm,force_N``. Quantities, in base axes (origin at the hinge's fixed
end A, x along the undeformed arm):

    angle (also theta)   turn of the tip; the only column every row must fill
    x, y                 position of the tip; both or neither
    force                the dynamometer's, at the arm's end, along +y whatever the angle: its guide stands across the
                         undeformed arm
    Fx, Fy               instead of ``force``: components at the arm's end
    torque (also Mz)     moment about the tip; the forces beside it, if any, then act at the tip (as `solve` counts)

An empty cell was not measured. Columns that name none of these quantities (``image``, notes) are passed over. Columns
may stand between semicolons or tabs, with decimal commas (tensegym/tables/rows.py).
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import InputError
from tensegym.flexure.hinge import States
from tensegym.tables import number_of, read_rows

PAPER_LENGTH, ARM_LENGTH = 0.04, 0.12
"""The paper's hinges from base to tip, and its arm beyond the tip [m]"""

_LENGTH, _FORCE = {"mm": 1e-3, "m": 1.0}, {"N": 1.0, "mN": 1e-3}
UNITS: dict[str, dict[str, float]] = {
    "angle": {"deg": math.pi / 180.0, "rad": 1.0},
    "x": _LENGTH,
    "y": _LENGTH,
    "force": _FORCE,
    "Fx": _FORCE,
    "Fy": _FORCE,
    "torque": {"Nmm": 1e-3, "Nm": 1.0},
}
"""Allowed units of every quantity and their size in SI."""

MOST = 1e6  # m, N, Nm; what a stand measures is far below, and a point too few or digits too many far above

LOADS = ("force", "Fx", "Fy", "torque")
_NAMES = {name.lower(): name for name in UNITS} | {"theta": "angle", "mz": "torque"}


def quantity(header: str) -> tuple[str, float] | None:
    """Quantity and unit size of a column's header, None for a column that is none of ours.

    Raises InputError, naming the column and the units allowed, if the unit is missing or unknown.
    """
    word, rest = re.fullmatch(r"([A-Za-z]*)(.*)", header.strip(), re.DOTALL).groups()  # type: ignore[union-attr]
    name = _NAMES.get(word.lower())
    if name is None:
        return None
    units = UNITS[name]
    if rest.startswith("_") and rest[1:] in units:
        return name, units[rest[1:]]
    fault = f"has the unknown unit {rest[1:]!r}" if rest.startswith("_") and rest[1:] else "has no unit"
    raise InputError(f"column {header.strip()!r} {fault}; write {' or '.join(f'{word}_{unit}' for unit in units)}")


def read_measured(path: Path, arm_length: float = ARM_LENGTH) -> States:
    """States measured on a stand.

    Args:
        path: of the CSV.
        arm_length: from the tip to the arm's end, where ``force``, ``Fx`` and ``Fy`` act [m].

    Raises:
        FileNotFoundError: where it is not there.
        InputError: naming file, column and row: a unit missing or unknown, a column missing, given twice or half a
            pair, a cell that is no number, an angle not measured or past a quarter turn, a number
            above MOST, loads that say nothing.
    """
    header, rows, _ = read_rows(path)
    columns: dict[str, FloatArray] = {}
    for k, title in enumerate(header):
        try:
            known = quantity(title)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        if known is None:
            continue
        name, unit = known
        if name in columns:
            raise InputError(f"{path}: {name} is given twice")
        values = [number_of(row[k], f"{path}: row {n}, {title}") for n, row in enumerate(rows, 1)]
        columns[name] = unit * np.array(values)
    _refuse_gaps(path, columns)
    return _states(columns, len(rows), arm_length)


def _refuse_gaps(path: Path, columns: dict[str, FloatArray]) -> None:
    if "angle" not in columns:
        raise InputError(f"{path}: no column angle_deg or angle_rad")
    if np.isnan(columns["angle"]).any():
        raise InputError(f"{path}: row {int(np.isnan(columns['angle']).argmax()) + 1} has no angle")
    if (past := np.abs(columns["angle"]) >= math.pi / 2).any():
        row, angle = int(past.argmax()), columns["angle"][past.argmax()]
        raise InputError(f"{path}: row {row + 1}: an angle of {math.degrees(angle):.4g} deg; a hinge turns less than "
                         "90 deg: is the column in degrees under a header in rad?")  # fmt: skip
    for name, values in columns.items():
        if (past := np.abs(values) > MOST).any():
            row = int(past.argmax())
            raise InputError(f"{path}: row {row + 1}: {name} = {values[row]:.4g} in SI units is above {MOST:g}")
    for one, other in (("x", "y"), ("Fx", "Fy")):
        if (one in columns) != (other in columns):
            lone, missing = (one, other) if one in columns else (other, one)
            raise InputError(f"{path}: a column {lone} without {missing}")
    if "force" in columns and "Fx" in columns:
        raise InputError(f"{path}: force beside Fx and Fy; give one of them")
    if not any(name in columns for name in LOADS):
        raise InputError(f"{path}: no load: a column force_N, Fx_N and Fy_N, or torque_Nmm is needed")


def _states(columns: dict[str, FloatArray], n: int, arm_length: float) -> States:
    unknown, none = np.full(n, math.nan), np.zeros(n)
    theta = columns["angle"]
    tip = np.stack([columns.get("x", unknown), columns.get("y", unknown)], axis=1)
    force = np.stack([columns.get("Fx", none), columns.get("Fy", columns.get("force", none))], axis=1)
    moment = columns.get("torque")
    if moment is None:
        moment = arm_length * (np.cos(theta) * force[:, 1] - np.sin(theta) * force[:, 0])
    return States(theta, tip, force, moment)
