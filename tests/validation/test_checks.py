"""`tensegym validate`, row by row; and that a broken law is caught."""

from functools import partial

import numpy as np
import pytest

from tensegym.engine import world
from tensegym.physics import drives as drive_kernel
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation import TOPICS, Check, breathing, drives, flight, geometry, statics

WANTED = {*(f"S{n}" for n in range(1, 8)), "M1", "M2", "M3", "G1", "G2", "G3", "I1", "drive"}


@pytest.fixture(scope="module")
def rows():
    return {topic: list(rows_of("pybullet")) for topic, rows_of in TOPICS.items()}


@pytest.mark.parametrize("topic", [breathing, flight], ids=["breathing", "flight"])
def test_the_rows_of_an_engine_pass_in_mujoco_too(topic):
    assert [row for row in topic.rows("mujoco") if not row.passed] == []


@pytest.mark.parametrize("topic", TOPICS)
def test_every_row_passes(topic, rows):
    assert rows[topic]
    failed = [row for row in rows[topic] if not row.passed]
    assert failed == []


def test_every_id_is_there(rows):
    assert {row.id for topic in rows.values() for row in topic} == WANTED
    assert sum(row.id == "drive" for row in rows["drives"]) == 4


def test_no_quantity_is_listed_twice(rows):
    names = [(row.id, row.quantity) for topic in rows.values() for row in topic]
    assert len(set(names)) == len(names)


def test_tolerances_are_not_loosened(rows):
    by_id = {}
    for topic in rows.values():
        for row in topic:
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


def failing(topic):
    return {row.id for row in topic.rows() if not row.passed}


def test_a_wrong_frequency_is_caught(monkeypatch):
    right = breathing.breathing_frequency
    monkeypatch.setattr(breathing, "breathing_frequency", lambda *args: 1.001 * right(*args))
    assert failing(breathing) == {"M1"}


def test_wrong_statics_are_caught(monkeypatch):
    right = statics.form_find

    def stretched(*args):
        found = right(*args)
        return found.with_nodes(found.nodes * np.array([1.0001, 1.0, 1.0]))

    monkeypatch.setattr(statics, "form_find", stretched)
    assert failing(statics) == {"S1", "S2"}


def test_wrong_geometry_is_caught(monkeypatch):
    right = geometry.resting_height
    monkeypatch.setattr(geometry, "resting_height", lambda *args: 1.0001 * right(*args))
    assert failing(geometry) == {"G1"}


def test_a_weaker_drive_is_caught(monkeypatch):
    right = drive_kernel.drive_constants

    def weaker(drive):
        constants = right(drive)
        constants[5] *= 0.95  # torque constant
        return constants

    monkeypatch.setattr(drive_kernel, "drive_constants", weaker)
    assert failing(drives) == {"drive"}


def test_a_force_without_its_reaction_is_caught(monkeypatch):
    """Leave a thousandth of one rod's force out: momentum is no longer kept."""
    right = world.engine_substep

    def lame(*args):
        right(*args)
        args[3].wrenches[0, :3] *= 0.999

    monkeypatch.setattr(world, "engine_substep", lame)
    monkeypatch.setattr(flight, "TensegrityRobot", partial(TensegrityRobot, compiled=False))
    assert failing(flight) == {"I1"}
