"""The kernel's model of the engines' own turning, and what it makes of it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tensegym.design.design import RobotDesign
from tensegym.engine.rod_rotation import gyroscopic_change
from tensegym.physics.vectors import angular_velocity, arcsine_ratio, sine_ratios, turn
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import Structure, six_rod

vectors = st.tuples(*[st.floats(-20, 20)] * 3).map(np.array)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**31), vectors)
def test_closed_form_of_the_gyroscopic_step(seed, w):
    turn = Rotation.random(random_state=np.random.default_rng(seed))
    inertia, dt = np.array([0.02, 0.02, 5e-6]), 1e-3
    local = turn.inv().apply(w)
    expected = turn.apply(-dt * np.cross(local, inertia * local) / inertia)
    out = gyroscopic_change(w, turn.as_matrix()[:, 2].copy(), 0.02, 5e-6, dt)
    np.testing.assert_allclose(out, expected, atol=1e-9)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**31), vectors)
def test_angular_velocity_from_two_orientations(seed, w):
    turn = Rotation.random(random_state=np.random.default_rng(seed))
    first = np.r_[0, 0, 0, turn.as_quat()]
    second = np.r_[0, 0, 0, (Rotation.from_rotvec(1e-3 * w) * turn).as_quat()]
    out = angular_velocity(second, first, 1e-3)
    np.testing.assert_allclose(out, w, atol=1e-9)


def test_series_of_small_angles_are_exact_to_rounding():
    for angle in np.geomspace(1e-6, 0.0999999, 40):
        sine, versine = sine_ratios(angle**2)
        assert sine == pytest.approx(np.sin(angle) / angle, rel=3e-16, abs=0)
        assert versine == pytest.approx(2 * (np.sin(angle / 2) / angle) ** 2, rel=6e-16, abs=0)
        assert arcsine_ratio(angle**2) == pytest.approx(np.arcsin(angle) / angle, rel=5e-16, abs=0)
    assert sine_ratios(0.0) == (1.0, 0.5)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31), vectors, st.sampled_from([1e-3, -1e-3, 0.2]))
def test_turned_is_the_rotation_by_w_times_time(seed, w, time):
    axis = Rotation.random(random_state=np.random.default_rng(seed)).as_matrix()[:, 2].copy()
    np.testing.assert_allclose(turn(axis, w, time), Rotation.from_rotvec(w * time).apply(axis), atol=2e-15)


@pytest.mark.parametrize("rate", [(8.0, 0.0, 8.0), (3.0, 2.0, 20.0)])
def test_a_lone_spinning_rod_keeps_energy_momentum_and_spin(rate):
    """The engine alone, with explicit Euler, gains energy here; the kernel takes that out."""
    whole = six_rod()
    nodes = whole.nodes.copy()
    for i, rod in enumerate(whole.rods):
        nodes[rod] += [0, 0, 5.0 * i]  # out of one another's way
    bare = Structure(nodes, whole.rods, np.zeros((0, 2), int), np.zeros((0, 2), int))
    design = RobotDesign(structure=bare, form_finding=False, spin_damping=0.0)
    with TensegrityRobot(design, ground=False) as robot:
        poses = robot.model.rest_poses
        apart = 0.2 * (poses[:, :3] - poses[:, :3].mean(axis=0))
        turning = [Rotation.from_quat(p[3:]).apply(rate) for p in poses]
        robot.reset_rotated(Rotation.identity(), np.hstack([apart, turning]))
        energy, momentum = robot.energies().kinetic, robot.momentum_in_world()[1]
        robot.step(2000)
        assert robot.energies().kinetic == pytest.approx(energy, rel=1e-7)
        drift = np.linalg.norm(robot.momentum_in_world()[1] - momentum) / np.linalg.norm(momentum)
        assert drift < 1e-7
        local = Rotation.from_quat(robot.poses_in_world[0, 3:]).inv().apply(robot.velocities_in_world()[0, 3:])
        assert local[2] == pytest.approx(rate[2], rel=1e-6)
