"""The closed forms of `tensegym validate`."""

from __future__ import annotations

from tensegym.validation import TOPICS
from tensegym.validation.row import Findings, Row

_PLACES = {"breathing mode in PyBullet": "breathing mode", "breathing mode in MuJoCo": "breathing mode"}


def closed_forms(engine: str) -> Findings:
    """Statics, geometry, modes, drives, and free flight in the engine: what each is, and where it comes from, is in
    [physics.md](physics.md#closed-forms-tensegym-validate)."""
    rows = []
    for rows_of in TOPICS.values():
        for check in rows_of(engine):
            quantity = check.quantity
            for long, short in _PLACES.items():
                quantity = quantity.replace(long, short)
            dt = 1e-3 if check.id in ("M1", "M3", "I1") else None
            rows.append(Row(check.id, f"{check.id}: {quantity}", check.expected, check.measured, check.tolerance, dt))
    return Findings(rows)
