"""The problems of the validation page in small, in every engine; and that what is wrong is caught."""

from functools import partial

import numpy as np
import pytest

from tensegym.bullet import bodies as bullet_bodies
from tensegym.engine import world
from tensegym.robot.engines import ENGINES
from tensegym.robot.robot import TensegrityRobot
from tensegym.validation.free_bodies import FreeBodies, body
from tensegym.validation.problems import (
    PROBLEMS,
    beams,
    energy_audit,
    flight_order,
    friction,
    loops,
    pendulum,
    rolling,
    rolling_ball,
    shared_nodes,
)
from tensegym.validation.problems import torque_free as turning

engines = pytest.mark.parametrize("engine", ENGINES)


def failing(findings):
    return [row.quantity for row in findings.rows if not row.passed]


@engines
@pytest.mark.parametrize("measure", [turning.kane, rolling_ball.bowling, flight_order.flight_order,
                                     shared_nodes.shared_nodes],
                         ids=lambda measure: measure.__name__)  # fmt: skip
def test_every_row_passes(measure, engine):
    pytest.importorskip(engine)
    findings = measure(engine)
    assert findings.rows
    assert failing(findings) == []


@pytest.mark.parametrize("measure", [beams.elastica, beams.princeton, beams.wittrick],
                         ids=lambda measure: measure.__name__)  # fmt: skip
def test_flexures_meet_their_closed_forms(measure):
    assert failing(measure("")) == []


def test_the_pushed_box_and_its_balls():
    assert failing(rolling_ball.pushed_box("pybullet", seconds=0.3)) == []


def test_rods_stop_and_slide_by_coulombs_law():
    assert failing(friction.stopping("pybullet")) == []
    assert failing(friction.slope("pybullet")) == []


def test_a_robot_stays_where_it_is():
    assert failing(friction.creep("pybullet", seconds=3.0)) == []


def test_the_pendulums_period():
    period, speed, change = pendulum.swing(4e-3, 4.0)
    assert period == pytest.approx(2.36784195, abs=2e-4)
    assert speed == pytest.approx(4.42944692, abs=2e-3)
    assert change < 1e-3


@pytest.mark.parametrize(("rods", "held", "gravity", "thick"), [
    (loops.FOUR_BARS, loops.FOUR_BARS_HELD, (0, 0, -9.81), 0.0), (loops.BRICARD, loops.BRICARD_HELD, (0, -9.81, 0), 0.1)
])  # fmt: skip
def test_loops_keep_their_energy_while_they_fall(rods, held, gravity, thick):
    total = loops.energies(rods, held, gravity, 1e-3, thick, 1.0)
    assert np.abs(total - total[0]).max() < 0.05
    loose = loops.energies(rods, (), gravity, 1e-3, thick, 0.2)
    assert abs(loose[-1] - loose[0]) < 0.05  # a chain too


@engines
def test_rolling_in_small(engine):
    pytest.importorskip(engine)
    findings = rolling.contacts(engine, seeds=1, seconds=4.0)
    assert failing(findings) == []
    assert len(findings.curves["gap, mm"]) > 100
    speeds = rolling.time_steps(engine, seeds=2, seconds=2.0)
    assert [row.dt for row in speeds.rows] == [0.5e-3, 2e-3, 4e-3]


def test_two_ways_part_at_a_positive_rate():
    findings = rolling.parting("pybullet", seeds=2, seconds=4.0)
    _, apart = findings.curves["apart, mm"]
    assert 1e2 * apart[0] < apart[-1] < 10.0
    assert min(findings.curves["rate, 1/s"]) > 0


def test_the_audit_names_its_worst_episode():
    findings = energy_audit.energy_audit("pybullet", episodes=3, seconds=1.2)
    assert failing(findings) == []
    assert f"seed {findings.curves['worst seed']}, is " in findings.rows[2].note
    assert len(findings.curves["excess"]) == 3


def test_energy_from_nowhere_is_caught():
    watcher = energy_audit.EnergyWatcher()
    watcher.times, watcher.energy, watcher.allowed = [0.0, 0.02, 0.04], [1.0, 1.02, 0.9], [1.0, 1.0, 1.1]
    assert watcher.excess == pytest.approx(0.02)


def test_other_friction_is_caught(monkeypatch):
    """The rod then stops elsewhere, and slides from another slope on."""
    right = bullet_bodies.make_ground
    def weaker(client, mu, *more):
        return right(client, 0.9 * mu, *more)

    monkeypatch.setattr("tensegym.bullet.client.make_ground", weaker)
    assert len(failing(friction.stopping("pybullet"))) == 4
    assert len(failing(friction.slope("pybullet"))) >= 4


def test_a_step_of_the_engine_alone_is_caught(monkeypatch):
    """Without what mends the turning, a spinning rod gains momentum."""
    monkeypatch.setattr(FreeBodies, "run", lambda self, count: [self.step(np.zeros((1, 6))) for _ in range(count)])
    assert "J / I = 0.5: angular momentum, relative change" in failing(turning.kane("pybullet"))


def test_rods_that_nothing_joins_are_caught(monkeypatch):
    right = world.engine_substep

    def loose(model, *args):
        right(model._replace(joint_bodies=model.joint_bodies[:0]), *args)

    monkeypatch.setattr(world, "engine_substep", loose)
    monkeypatch.setattr(shared_nodes, "TensegrityRobot", partial(TensegrityRobot, compiled=False))
    *_, widest = shared_nodes.chain_in_flight("pybullet", 1e-3, seconds=0.1)
    assert widest > 1e-2


@engines
def test_bodies_move_by_their_masses(engine):
    pytest.importorskip(engine)
    with FreeBodies(engine, [body("a", 2.0, [1, 1, 1]), body("b", 4.0, [1, 1, 1])], 1e-3) as free:
        free.start(np.array([[0, 0, 0, 0, 0, 0, 1.0], [3, 0, 0, 0, 0, 0, 1.0]]), np.zeros((2, 6)))
        free.step(np.array([[1.0, 0, 0, 0, 0, 0]] * 2))
        np.testing.assert_allclose(free.velocities[:, 0], [0.5e-3, 0.25e-3], rtol=1e-6)


def test_every_problem_says_what_it_does_and_whence():
    for problem in PROBLEMS.values():
        assert len(problem.measure.__doc__) > 40
        assert problem.source
