"""`tensegym validate`, row by row; and that a broken law is caught."""

from functools import partial

import numpy as np
import pytest

from tensegym.physics import drives
from tensegym.physics import substep as kernel
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation import checks
from tensegym.validation.checks import ALL, Check

WANTED = {*(f"S{n}" for n in range(1, 8)), "M1", "M2", "M3", "G1", "G2", "G3", "I1", "drive"}


@pytest.fixture(scope="module")
def rows():
    return {group.__name__: list(group()) for group in ALL}


@pytest.mark.parametrize("group", [group.__name__ for group in ALL])
def test_every_row_passes(group, rows):
    assert rows[group]
    failed = [row for row in rows[group] if not row.passed]
    assert failed == []


def test_every_id_of_the_plan_is_there(rows):
    assert {row.id for group in rows.values() for row in group} == WANTED
    assert sum(row.id == "drive" for row in rows["drive_figures"]) == 4


def test_no_quantity_is_listed_twice(rows):
    names = [(row.id, row.quantity) for group in rows.values() for row in group]
    assert len(set(names)) == len(names)


def test_tolerances_are_those_of_the_plan(rows):
    by_id = {}
    for group in rows.values():
        for row in group:
            by_id.setdefault(row.id, []).append(row)
    m1 = by_id["M1"][0]
    assert m1.tolerance == pytest.approx(5e-4 * m1.expected)
    momentum = [row for row in by_id["I1"] if "momentum" in row.quantity]
    assert len(momentum) == 4  # of rigid and of flexible rods
    assert all(row.tolerance == 1e-6 and row.expected == 0 for row in momentum)
    assert [(row.expected, row.tolerance) for row in by_id["drive"]] == [
        (0.197, 0.002), (0.121, 0.002), (41.0, 1.0), (82.0, 1.5)
    ]  # fmt: skip
    assert all(row.tolerance == 0 for row in by_id["S5"] + by_id["S6"] + by_id["S7"])


@pytest.mark.parametrize(("measured", "passes"), [(1.05, True), (1.0501, False), (0.95, True), (np.nan, False)])
def test_a_row_passes_within_its_tolerance(measured, passes):
    assert Check("S1", "", 1.0, measured, 0.05000001).passed is passes


def failing(group):
    return {row.id for row in group() if not row.passed}


def test_a_wrong_frequency_is_caught(monkeypatch):
    right = checks.breathing_frequency
    monkeypatch.setattr(checks, "breathing_frequency", lambda *args: 1.001 * right(*args))
    assert failing(checks.breathing) == {"M1"}


def test_wrong_statics_are_caught(monkeypatch):
    right = checks.form_find

    def stretched(*args):
        found = right(*args)
        return found.with_nodes(found.nodes * np.array([1.0001, 1.0, 1.0]))

    monkeypatch.setattr(checks, "form_find", stretched)
    assert failing(checks.statics) == {"S1", "S2"}


def test_wrong_geometry_is_caught(monkeypatch):
    right = checks.resting_height
    monkeypatch.setattr(checks, "resting_height", lambda *args: 1.0001 * right(*args))
    assert failing(checks.geometry) == {"G1"}


def test_a_weaker_drive_is_caught(monkeypatch):
    right = drives.drive_constants

    def weaker(drive):
        constants = right(drive)
        constants[5] *= 0.95  # torque constant
        return constants

    monkeypatch.setattr(checks.drive_kernel, "drive_constants", weaker)
    assert failing(checks.drive_figures) == {"drive"}


def test_a_force_without_its_reaction_is_caught(monkeypatch):
    """Leave a thousandth of one rod's force out: momentum is no longer kept."""
    right = kernel.substep

    def lame(*args):
        right(*args)
        args[2][0, :3] *= 0.999

    monkeypatch.setattr(kernel, "substep", lame)
    monkeypatch.setattr(checks, "TensegrityRobot", partial(TensegrityRobot, compiled=False))
    assert failing(checks.flight) == {"I1"}
