"""A robot that does what a page asks of it."""

import numpy as np
import pytest

from tensegym.errors import DesignError, SimulationError, StructureError
from tensegym.tasks.trials import Setup
from tensegym.view.choice import Choice
from tensegym.view.session import HOLD, PERIOD, Session


@pytest.fixture
def opened():
    sessions = []

    def open_session(*choice, **options):
        sessions.append(Session(Choice(*choice, **options)))
        return sessions[-1]

    yield open_session
    for session in sessions:
        session.close()


def test_sliders_turn_the_drives_within_their_limits(opened):
    session = opened()
    limit = session.command_limit()
    session.drive(np.array([1e9, -1.0, 0, 0, 0, 0]))
    frames = [frame for _ in range(10) for frame in session.step()]
    assert frames[-1].commands.tolist() == [limit[0], 0, 0, 0, 0, 0]
    assert 0 < frames[0].angles[0] < frames[-1].angles[0] <= limit[0] * 1.001
    assert np.diff([frame.time for frame in frames]) == pytest.approx(PERIOD, abs=2e-3)
    assert frames[-1].time - frames[0].time == pytest.approx(10 * HOLD - PERIOD, abs=3e-3)


def test_slow_motion_is_the_same_motion_in_more_pictures(opened):
    quick, slow = opened("random"), opened("random")
    few, many = quick.step()[-1], slow.step(PERIOD / 5)
    assert len(many) == pytest.approx(0.4 / (PERIOD / 5), abs=1)
    assert np.array_equal(many[-1].poses, few.poses)


def test_a_place_becomes_the_goal_and_the_way_leads_there(opened):
    session = opened("walker")
    session.go_to(2.0, -1.0)
    frame = [session.step() for _ in range(8)][-1][-1]
    centre = session.frame().poses[:, :2].mean(axis=0)
    assert frame.place == pytest.approx([2.0, -1.0], abs=0.1)
    assert frame.direction @ (np.array([2.0, -1.0]) - centre) > 0.9 * np.linalg.norm(np.array([2.0, -1.0]) - centre)
    session.head(np.pi / 2)
    frame = session.step()[-1]
    assert not np.isfinite(frame.place).any()
    assert frame.direction == pytest.approx([0, 1])


def test_a_recording_looks_as_often_at_any_speed_and_begins_anew_with_the_robot(opened):
    session = opened("random")
    session.record()
    begun = session.frame().time
    session.step(PERIOD / 5)  # slow motion: more pictures, no more of them kept
    slow = session.frame().time
    session.run(1e-3)  # as fast as it goes: one control step, and no picture of it
    times = session.recorded().times
    assert (times[0], times[-1]) == (begun, session.frame().time)
    assert session.frame().time > slow > begun
    assert np.diff(times) == pytest.approx(PERIOD, abs=0.3 * PERIOD)
    session.record()
    session.step()
    session.choose(Choice("random", payload=True))
    again = session.frame().time
    session.step()
    kept = session.recorded()
    assert kept.times[0] == again
    assert kept.design.payload is not None
    with pytest.raises(SimulationError, match="nothing was recorded"):
        session.recorded()


def test_a_choice_that_fails_leaves_what_runs(opened):
    session = opened()
    session.step()
    before = session.frame()
    with pytest.raises(StructureError, match="no face"):
        session.choose(Choice(face="1-2-12"))
    with pytest.raises(DesignError, match="six_rod"):
        session.choose(Choice(design="prism"))
    assert np.array_equal(session.frame().poses, before.poses)
    stage = session.choose(Choice(payload=True))
    assert stage.design.payload is not None
    assert session.frame().time < before.time


@pytest.mark.parametrize(("wanted", "payload", "flexure"), [
    ({}, False, False), ({"payload": True}, True, False), ({"flexible": True}, False, True),
    ({"task": "carry"}, True, False), ({"task": "carry", "payload": False}, False, False),
    ({"design": "six_rod_flexible"}, False, True), ({"design": "six_rod_flexible", "flexible": False}, False, False),
])  # fmt: skip
def test_payload_and_flexures_come_and_go(wanted, payload, flexure):
    setup = Choice(**wanted).setup()
    assert isinstance(setup, Setup)
    assert (setup.design.payload is not None, setup.design.flexure is not None) == (payload, flexure)


def test_a_slope_leans_the_gravity_and_a_path_is_on_the_stage(opened):
    stage = opened(task="climb").stage()
    assert stage.gravity[0] == pytest.approx(-9.81 * np.sin(np.radians(10)))
    assert len(opened(task="path").stage().path) > 100
    assert len(stage.path) == 0
