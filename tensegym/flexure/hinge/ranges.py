"""Ranges of numbers that several parts of a hinge or a joint keep to."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any

from tensegym.errors import FlexureError


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


def is_number(value: Any) -> bool:
    """Whether it is a finite real number; a bool is none."""
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def shown(value: Any) -> str:
    """A number with six digits, anything else as Python writes it."""
    return f"{value:g}" if isinstance(value, Real) and not isinstance(value, bool) else repr(value)
