"""The bound of the time step, from both sides: a robot at rest in flight stays so below it, and runs away above it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tensegym.design.design import Payload, RobotDesign, Rod, StiffCable
from tensegym.physics.robot_arrays import robot_model
from tensegym.physics.step_limit import margin, most, shares, standing
from tensegym.robot.robot import TensegrityRobot

DT = 2e-3
LIGHT = RobotDesign(passive_rod=Rod(end_mass=2e-3, tube_mass=2e-3, end_mass_radius=0.1))
BALL = RobotDesign(payload=Payload(mass=2e-3))


def pretension(value):
    return replace(RobotDesign().elastic_cable, stiffness=3e3, pretension=value)


KINDS = {
    "rods that cables spin": ("elastic", 100.0, lambda value: RobotDesign(elastic_cable=pretension(value))),
    "light rods that cables swing": ("elastic", 10.0, lambda value: LIGHT.with_(elastic_cable=pretension(value))),
    "a payload that cables turn": ("payload", 3.0, lambda value: BALL.with_(
        payload=replace(BALL.payload, stiffness=1e3, pretension=value))),
    "a damper of spins": ("spin damping", 3e-3, lambda value: RobotDesign(spin_damping=value)),
}  # fmt: skip


def fastest(design, dt, steps=300):
    """Largest speed of a body [m/s, rad/s] of a robot left alone in flight with a breath of motion."""
    with TensegrityRobot(design, dt=dt, ground=False) as robot:
        moving = 1e-7 * np.random.default_rng(0).standard_normal((len(robot.model.masses), 6))
        robot.reset_rotated(Rotation.identity(), moving)
        robot.step(steps)
        return np.abs(robot.velocities_in_world()).max()


def at_rest(design, dt=DT, implicit=True):
    model = robot_model(design)
    return margin(model, standing(model), dt, implicit), model


@pytest.mark.parametrize("kind", KINDS)
def test_a_design_at_rest_is_held_up_to_its_limit_and_no_farther(kind, monkeypatch):
    source, value, design = KINDS[kind]
    monkeypatch.setattr("tensegym.robot.robot.held_implicit", lambda *_: True)
    for _ in range(15):  # the pretension moves the shape a little, so the limit is closed in on
        found, model = at_rest(design(value))
        value *= most(model, standing(model), DT, True, source)
    assert at_rest(design(value))[0].ratio == pytest.approx(1, rel=1e-3)
    parts = shares(model, standing(model), DT, True, found.motion)
    assert max(parts, key=lambda name: parts[name]) == source
    assert sum(parts.values()) == pytest.approx(found.ratio, rel=1e-6)
    assert fastest(design(0.97 * value), DT) < 1e-2
    assert fastest(design(1.03 * value), DT) > 1.0


def test_explicit_forces_are_held_up_to_their_limit(monkeypatch):
    """The exact bound, which the explicit limit stays below: it is sufficient alone."""
    design = RobotDesign(elastic_cable=pretension(10.0), stiff_cable=StiffCable(stiffness=1e-3, damping=0))
    monkeypatch.setattr("tensegym.robot.robot.held_implicit", lambda *_: False)
    low, high = 1e-4, 1e-2
    while high > 1.001 * low:
        middle = np.sqrt(low * high)
        held = at_rest(design, middle, False)[0].ratio < 1
        low, high = (middle, high) if held else (low, middle)
    assert fastest(design, 0.97 * low) < 1e-2
    assert fastest(design, 1.03 * low) > 1.0
