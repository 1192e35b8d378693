"""The stepper: what it expects of a table in closed form, steps it makes, and what is refused."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from tensegym import as_task
from tensegym.control.hold import Hold
from tensegym.control.stepper import Stepper, holds_left
from tensegym.control.table import make_controller, with_defaults
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import face_by_nodes
from tensegym.tasks.episode import Episode

TABLE = [Hold(0, (0.1,), ((1, 0.25), (0, 0.75))), Hold(0, (0.2,), ((2, 1.0),)), Hold(2, (0.3,), ((1, 0.5), (0, 0.5)))]


def test_expected_holds_are_those_of_a_markov_chain():
    """Straight on: one in four leads there, so four holds. By face 2: x = 1 + 1 + x / 2, so four as well."""
    assert holds_left(TABLE[:1], 1)[0] == pytest.approx(4)
    assert holds_left(TABLE[1:], 1)[0] == pytest.approx(4, abs=1e-6)
    assert holds_left(TABLE, 1)[2] == pytest.approx(3, abs=1e-6)
    straight = holds_left(TABLE[1:], 1, here=0)
    assert straight[0] > 100  # no hold leads there in one step
    assert holds_left(TABLE, 1, here=0)[0] == pytest.approx(4)


def test_what_a_hold_did_counts_for_more_than_the_table():
    stepper = Stepper([Hold(0, (0.1,), ((1, 1.0),)), Hold(0, (0.2,), ((1, 0.5), (0, 0.5)))])
    stepper._holds, stepper._wanted = list(stepper._table), 1
    first = stepper._choose(0)
    assert first == stepper._table[0]
    stepper._learn(first, 0)  # it has not tipped
    assert stepper._choose(0) == stepper._table[1]


def stepped(start: str, onto: str, **settings) -> tuple[str | None, dict[str, float], float]:
    """What came of a step from one face onto a neighbour."""
    task = as_task("stand")
    with TensegrityRobot(dt=task.dt) as robot:
        face, to = (face_by_nodes(robot.faces, name) for name in (start, onto))
        for seed in range(40):
            episode = Episode(robot, task, np.random.default_rng(seed), {"face": face, "heading": 1.0})
            if episode.goal.face == to:
                break
        stepper = make_controller({"kind": "stepper", **settings})
        stepper.begin(robot, 0)
        while not episode.ended and robot.time < 30:
            episode.advance(stepper.angles(robot, episode.bearing), 50)
        assert episode.gait.audit_passed
        return episode.ended, task.measures(episode), robot.time


@pytest.mark.parametrize(("start", "onto"), [("1-3-5", "1-5-11"), ("3-5-12", "1-3-5"), ("1-3-5", "1-3-6")])
def test_it_steps_onto_the_neighbour_wanted_and_rests(start, onto):
    """An open face onto a closed one, a closed one onto an open one, and over an edge without a cable."""
    ended, measures, seconds = stepped(start, onto)
    assert (ended, measures["arrived"], measures["direct"]) == ("arrived", 1, 1)
    assert seconds > 1.0  # it has rested


def test_where_nothing_leads_straight_it_goes_around_if_it_may():
    ended, measures, _ = stepped("1-5-11", "1-3-5")
    assert (ended, measures["arrived"], measures["direct"]) == ("arrived", 1, 0)


def test_the_environment_of_steps_tells_the_direction_of_the_edge():
    env = gym.make("tensegym/SixRodStep-v0")
    env.reset(seed=0)
    info = env.step(np.full(6, -1.0))[4]
    assert info["measures"] == {"arrived": 0, "direct": 0}
    env.close()


def test_what_does_not_fit_is_refused():
    with TensegrityRobot(dt=2e-3) as robot, pytest.raises(DesignError, match="of a robot with 3 faces and 1 drives"):
        Stepper(TABLE).begin(robot)
    with pytest.raises(DesignError, match=r"around = 3 must be true or false"):
        make_controller({"kind": "stepper", "around": 3})
    with pytest.raises(FileNotFoundError, match="no table of holds"):
        make_controller({"kind": "stepper", "holds": "nowhere.json"})
    assert with_defaults({"kind": "stepper"}) == {"kind": "stepper", "around": True}
