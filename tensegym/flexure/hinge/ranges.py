"""Ranges of numbers that hinges, joints and robots keep to; whatever is outside is a FlexureError of one line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.tables import as_number, as_whole, one_line, show


def check_positive(what: str, value: Any, unit: str = "") -> None:
    """Refuse a value that is no finite positive number, naming it with its unit."""
    if not (is_number(value) and value > 0):
        raise FlexureError(f"{what} = {shown(value)}{f' {unit}' if unit else ''}; give a finite value above 0")


def check_not_negative(what: str, value: Any, unit: str, hint: str = "give 0 or more") -> None:
    """Refuse a value that is no finite number of 0 or more."""
    if not (is_number(value) and value >= 0):
        raise FlexureError(f"{what} = {shown(value)} {unit}; {hint}")


def check_max_angle(angle: Any) -> None:
    """Refuse a largest rotation [rad] outside (0, pi/2)."""
    if not (is_number(angle) and 0 < angle < math.pi / 2):
        raise FlexureError(f"max_angle = {shown(angle)} rad is outside (0, pi/2)")


def check_count(what: str, value: Any, low: int, high: int, hint: str) -> None:
    """Refuse a value that is no whole number from low to high; ``hint`` says what is good."""
    if not low <= as_whole(value, what, FlexureError) <= high:
        raise FlexureError(f"{what} = {show(value)} is outside [{low}, {high}]; {hint}")


def check_choice(what: str, value: Any, allowed: Sequence[str]) -> None:
    """Refuse a value that is none of the allowed texts."""
    if not isinstance(value, str) or value not in allowed:
        raise FlexureError(f"{what} = {show(value)}; one of {', '.join(allowed)}")


def is_number(value: Any) -> bool:
    """Whether it is a finite real number; a bool is none."""
    try:
        as_number(value, "", FlexureError)
    except FlexureError:
        return False
    return True


def shown(value: Any) -> str:
    """A float with six digits, anything else as Python writes it."""
    return f"{value:g}" if isinstance(value, float) else show(value)


def number_array(value: Any, what: str) -> FloatArray:
    """An array of floats of any shape, NaN among them. Raises FlexureError for what holds no numbers."""
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise FlexureError(one_line(f"{what} = {show(value)} does not hold numbers in rows of one length")) from None


def finite_array(value: Any, what: str, count: int) -> FloatArray:
    """(count,) array of finite floats. Raises FlexureError for anything else."""
    array = number_array(value, what)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise FlexureError(f"{what} = {show(value)}; give {count} finite value{'s' * (count > 1)}")
    return array
