"""The potential: gradient, Hessian, explicit pose, passivity, certificate, refusals."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import PAPER_HINGES, preset
from tensegym.flexure.models.certificate import certify, lower_bound, rotation_stiffness
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.passivity import loop_work
from tensegym.flexure.models.potential import Potential
from tensegym.flexure.models.potential_kernel import SK, SU, G
from tensegym.flexure.models.potential_terms import mask_of


@pytest.fixture(scope="module")
def joints():
    return {name: fit_joint(preset(name)) for name in PAPER_HINGES}


def wild(potential, seed):
    """The same joint with every odd and even term present."""
    noise = 0.1 * np.random.default_rng(seed).normal(size=potential.coefficients.shape) * mask_of("none")
    return replace(potential, coefficients=potential.coefficients + noise)


POSE = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1), st.integers(0, 5))


@settings(deadline=None)
@given(POSE)
def test_wrench_and_stiffness_are_the_energys_derivatives(pose):
    potential = wild(BASE, pose[3])
    q = np.array([0.04 + 1e-3 * pose[0], 5e-3 * pose[1], 0.5 * pose[2]])
    step = np.array([1e-8, 1e-8, 1e-6])
    wrench, stiffness = np.array(potential.wrench(*q)), potential.stiffness(*q)
    np.testing.assert_array_equal(stiffness, stiffness.T)
    for i in range(3):
        up, down = q + step * np.eye(3)[i], q - step * np.eye(3)[i]
        slope = (potential.energy(*up) - potential.energy(*down)) / (2 * step[i])
        assert slope == pytest.approx(wrench[i], rel=1e-5, abs=1e-6 * np.abs(wrench).max() + 1e-7)
        row = (np.array(potential.wrench(*up)) - np.array(potential.wrench(*down))) / (2 * step[i])
        np.testing.assert_allclose(row, stiffness[i], rtol=1e-5, atol=1e-6 * np.abs(stiffness[i]).max())


BASE = fit_joint(preset("leaf-spring"), count=64, held_out=0).models["potential"]
assert isinstance(BASE, Potential)


@settings(deadline=None)
@given(POSE)
def test_energy_is_positive_away_from_rest_and_zero_there(pose):
    q = np.array([0.04 + 1e-3 * pose[0], 5e-3 * pose[1], 0.5 * pose[2]])
    assert BASE.energy(*q) >= 0
    assert (BASE.energy(*q) > 0) == bool(np.abs(q - [0.04, 0, 0]).max() > 0) or BASE.energy(*q) < 1e-15
    assert BASE.energy(0.04, 0, 0) == 0 and BASE.wrench(0.04, 0, 0) == (0, 0, 0)


@settings(deadline=None)
@given(POSE)
def test_the_explicit_pose_is_held_by_its_load(pose):
    theta, force = 0.5 * pose[0], BASE.box.max_force * np.array([pose[1], pose[2]])
    states = BASE.poses(theta, force)
    wrench = BASE.wrench(*states.tip[0], theta)
    assert wrench == pytest.approx((*force, states.moment[0]), rel=1e-8, abs=1e-10)


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_held_out_loads(name, joints):
    """The figures asked of the fit: tip RMS at most 5 um, torque RMS at most 0.05 % of the 30 deg moment."""
    errors = joints[name].errors
    assert errors["potential"].count == 300 and errors["potential"].lost == 0
    assert errors["potential"].tip_rms < 5e-6
    assert errors["potential"].moment_rms < 5e-4
    for other in ("planar", "paper", "torsion"):
        assert errors[other].tip_rms > 100 * errors["potential"].tip_rms
        assert errors[other].moment_rms > 100 * errors["potential"].moment_rms


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_closed_loops_make_no_energy(name, joints):
    potential, paper = joints[name].models["potential"], joints[name].models["paper"]
    assert loop_work(potential, potential).largest < 1e-7
    assert loop_work(paper, potential).largest > 1e-3  # k(theta) in the wrench is no gradient


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_certificate(name, joints):
    proof = joints[name].certificate()
    assert min(proof.transverse, proof.axial, proof.rotational, proof.buckling) > 0
    potential = joints[name].models["potential"]
    rng = np.random.default_rng(1)
    theta = rng.uniform(-1, 1, 500) * potential.box.max_angle
    force = rng.uniform(-1, 1, (500, 2)) * potential.box.max_force
    assert (rotation_stiffness(potential, theta, force) > 0).all()
    assert (
        np.linalg.eigvalsh(potential.stiffnesses(np.column_stack([potential.poses(theta, force).tip, theta]))) > 0
    ).all()


def test_certificate_is_refused_past_buckling():
    rows = BASE.coefficients.copy()
    rows[G, 0] *= 50
    with pytest.raises(FlexureError, match=r"K - 2 g n is not positive on all of \+-30 deg"):
        certify(replace(BASE, coefficients=rows))
    rows = BASE.coefficients.copy()
    rows[SU, 2] = -2 * rows[SU, 0]
    with pytest.raises(FlexureError, match="su is not positive"):
        certify(replace(BASE, coefficients=rows))
    rows = BASE.coefficients.copy()
    rows[SK, 2] = -1.5 * rows[SK, 0]
    with pytest.raises(FlexureError, match="K is not positive"):
        certify(replace(BASE, coefficients=rows))


@settings(deadline=None)
@given(st.lists(st.floats(-3, 3), min_size=1, max_size=8))
def test_lower_bound_is_below_the_minimum_and_near_it(coefficients):
    grid = np.polynomial.polynomial.polyval(np.linspace(-1, 1, 4001), coefficients)
    bound = lower_bound(np.array(coefficients))
    assert bound <= grid.min() + 1e-9
    assert bound >= grid.min() - 2e-3 * (1 + np.abs(coefficients).sum())


def test_loads_outside_are_refused():
    top, force = BASE.box.max_angle, BASE.box.max_force
    with pytest.raises(FlexureError, match="theta = 31"):
        BASE.poses(np.radians([31.0]), [0.0, 0.0])
    with pytest.raises(FlexureError, match=r"the force \(.*\) N is outside the fitted"):
        BASE.poses([0.0], [1.01 * force, 0.0])
    assert len(BASE.poses([top, -top], [[force, -force]] * 2)) == 2


@pytest.mark.parametrize(("change", "words"), [
    ({"length": 0.0}, "length = 0"),
    ({"coefficients": np.zeros((7, 7))}, "8 finite rows"),
    ({"coefficients": np.ones((8, 7))}, "no constant term"),
])  # fmt: skip
def test_bad_potentials(change, words):
    with pytest.raises(FlexureError, match=words):
        replace(BASE, **change)


def test_batches_agree_with_single_calls():
    rng = np.random.default_rng(2)
    poses = rng.uniform(-1, 1, (20, 3)) * [1e-3, 5e-3, 0.5] + [0.04, 0, 0]
    assert BASE.wrenches(poses) == pytest.approx(np.array([BASE.wrench(*p) for p in poses]))
    assert BASE.stiffnesses(poses) == pytest.approx(np.array([BASE.stiffness(*p) for p in poses]))
    with pytest.raises(FlexureError, match="poses has shape"):
        BASE.wrenches(poses[:, :2])
