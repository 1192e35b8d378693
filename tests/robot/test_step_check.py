"""Which designs a time step holds, and what is said of the others."""

from dataclasses import replace

import numpy as np
import pytest

from tensegym.design.design import PRESETS, ElasticCable, Payload, RobotDesign, Rod, StiffCable
from tensegym.design.design_file import design_from_dict
from tensegym.design.variation import parse_variation
from tensegym.errors import DesignError, SimulationError
from tensegym.physics.robot_arrays import robot_model
from tensegym.robot.gait import GaitMeter
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.step_check import held_implicit


@pytest.mark.parametrize("payload", [False, True])
@pytest.mark.parametrize("preset", PRESETS)
def test_the_presets_are_held_at_every_time_step_in_use(preset, payload):
    design = design_from_dict({"preset": preset} | ({"payload": {}} if payload else {}))
    model = robot_model(design)
    for dt in (2.5e-4, 1e-3, 2e-3, 4e-3):
        assert held_implicit(design, model, dt) or dt < 2e-3


def test_the_ranges_that_ship_are_held_at_the_environments_step():
    base = design_from_dict({"payload": {"mass": 0.5}})
    ranges, rng = parse_variation("payload_body", base), np.random.default_rng(0)
    for _ in range(30):
        design = ranges.draw(base, rng)
        assert held_implicit(design, robot_model(design), 2e-3)


REFUSED = {
    "spin_damping": (RobotDesign(spin_damping=0.01), r"spin_damping = 0\.01 .* spins rod 7-8, .* below 0\.00\d+ N m"),
    "pretension": (RobotDesign(elastic_cable=ElasticCable(stiffness=1e6, pretension=3000)),
                   r"at rest: ElasticCable\.pretension = 3000 N spins rod .* below \d+ N, or dt below 0\.000\d+ s"),
    "light payload": (RobotDesign(payload=Payload(mass=1e-3)), r"Payload\.pretension = 4 N spins the payload"),
    "light rods": (RobotDesign(passive_rod=Rod(end_mass=2e-3, tube_mass=2e-3, end_mass_radius=0.1),
                               elastic_cable=ElasticCable(stiffness=3e3, pretension=700)),
                   r"swings rod|shakes rod"),
    "pulled": (RobotDesign(elastic_cable=ElasticCable(stiffness=1e6)), r"at the deepest pull: a tension of \d+ N"),
    "drives": (RobotDesign(drive=replace(RobotDesign().drive, position_gain=100)),
               r"drives hunt .*position_gain = 100 V/rad must be below 57"),
    "velocity": (RobotDesign(drive=replace(RobotDesign().drive, velocity_gain=0.3)),
                 r"drives hunt .*velocity_gain = 0\.3 V s/rad must be below 0\.05"),
    "lag": (RobotDesign(stiff_cable=StiffCable(damping=1e4)), r"StiffCable\.damping = 10000 .*below 7\.\d+e\+03 N s/m"),
    "apart": (RobotDesign(elastic_cable=ElasticCable(natural_length=30, two_way=True, stiffness=1e4)),
              r"ElasticCable\.natural_length = 30 m is far from"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_time_step_does_not_hold_is_refused_by_name_with_its_limit(case):
    design, says = REFUSED[case]
    with pytest.raises(DesignError, match=says) as refused:
        TensegrityRobot(design, dt=2e-3)
    assert len(str(refused.value)) < 300


def test_the_step_that_would_do_does():
    design = RobotDesign(elastic_cable=ElasticCable(stiffness=1e6, pretension=3000))
    with pytest.raises(DesignError) as refused:
        TensegrityRobot(design, dt=2e-3)
    told = float(str(refused.value).split("dt below ")[1].split(" s")[0])
    TensegrityRobot(design, dt=0.98 * told).close()
    with pytest.raises(DesignError):
        TensegrityRobot(design, dt=1.03 * told)


def test_explicit_forces_give_way_where_a_pull_would_break_them():
    """At rest they are within their limit at 1 ms; pulled, cables tied far from the axis turn the rods."""
    design = RobotDesign(attachment_radius=0.1)
    with TensegrityRobot(design, dt=1e-3) as robot:
        assert robot.implicit
        robot.reset(0)
        robot.command(robot.command_limit)
        robot.step(1500)
    with pytest.raises(DesignError, match="deepest pull"):
        TensegrityRobot(design, dt=1e-3, integrator="explicit")


def test_the_deepest_pull_breaks_a_design_that_is_refused_for_it(monkeypatch):
    design = RobotDesign(passive_rod=Rod(end_mass_radius=1e-4), elastic_cable=ElasticCable(stiffness=400))
    with pytest.raises(DesignError, match="at the deepest pull"):
        TensegrityRobot(design, dt=2e-3)
    TensegrityRobot(design, dt=1e-3).close()
    monkeypatch.setattr("tensegym.robot.robot.held_implicit", lambda *_: True)
    assert _pulled(design, 2e-3) > 0.01
    assert _pulled(design, 1e-3) < 0.001


def _pulled(design, dt):
    """Audit excess of a robot pulled as deep as it can in flight; infinite where it diverges."""
    with TensegrityRobot(design, dt=dt, ground=False) as robot:
        meter = GaitMeter(robot, np.array([1.0, 0.0]))
        robot.command(robot.command_limit)
        try:
            for _ in range(15):
                robot.step(round(0.1 / dt))
                meter.update()
        except SimulationError:
            return np.inf
        return meter.metrics().audit_excess
