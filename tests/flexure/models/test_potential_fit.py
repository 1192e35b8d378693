"""Fits: no luck involved, noise, asymmetric hinges, what cannot be fitted."""

from dataclasses import replace

import numpy as np
import pytest

from tensegym.errors import FlexureError
from tensegym.flexure.fem.sampling import default_box, fit_states, held_out_states, moment_at
from tensegym.flexure.hinge import GROUND, PAPER_HINGES, TIP, Box, Hinge, Leaf, preset, symmetry_of
from tensegym.flexure.models.certificate import certify
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.model_error import model_errors
from tensegym.flexure.models.potential_fit import fit_potential
from tensegym.flexure.models.potential_residual import predict, scaled
from tensegym.flexure.models.potential_terms import mask_of

L = 0.04


@pytest.fixture(scope="module")
def cases():
    out = {}
    for name in PAPER_HINGES:
        hinge = preset(name)
        box = default_box(hinge)
        out[name] = (hinge, box, held_out_states(hinge, box), moment_at(hinge, box.max_angle))
    return out


def test_jacobian_of_the_residual():
    rng = np.random.default_rng(0)
    hinge = preset("leaf-spring")
    states = fit_states(hinge, default_box(hinge), 16)
    data = scaled(states.theta, states.tip, states.force, states.moment, np.array([L, 0.06, 0.5]))
    rows = (0.3 * rng.normal(size=(8, 7)) + [[1.0], [3.0], [1.0], [0], [0], [0], [0], [0]] * np.eye(7)[0]) * mask_of(
        "none"
    )
    jacobian = predict(rows, data)[3]
    for i, j in np.argwhere(mask_of("none")):
        step = np.zeros((8, 7))
        step[i, j] = 1e-6
        up, down = np.array(predict(rows + step, data)[:3]), np.array(predict(rows - step, data)[:3])
        np.testing.assert_allclose((up - down) / 2e-6, jacobian[:, :, i, j], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_ten_starts_and_seeds_end_alike(name, cases):
    """Starts with every coefficient off by up to 50 % and other states each time: within 10 % of the same error."""
    hinge, box, test, reference = cases[name]
    tips, moments = [], []
    for seed in range(1, 11):
        states = fit_states(hinge, box, 600, seed)
        fit = fit_potential(states, L, box=box, start_noise=0.5, seed=seed)
        error = model_errors(fit.potential, test, reference)
        tips.append(error.tip_rms)
        moments.append(error.moment_rms)
    assert max(tips) < 1.1 * min(tips)
    assert max(moments) < 1.2 * min(moments)
    assert max(np.abs(np.array(tips) / np.median(tips) - 1)) < 0.1
    assert max(np.abs(np.array(moments) / np.median(moments) - 1)) < 0.1


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_the_linear_start_alone_is_near(name, cases):
    """The start is already a joint within 0.2 mm: nothing hangs on where the descent begins."""
    from tensegym.flexure.models.potential import Potential
    from tensegym.flexure.models.potential_start import linear_start

    hinge, box, test, reference = cases[name]
    states = fit_states(hinge, box)
    scales = np.array([L, np.abs(states.moment).max(), box.max_angle])
    rows = linear_start(scaled(states.theta, states.tip, states.force, states.moment, scales), mask_of("both"))
    error = model_errors(Potential(rows, L, scales[1], scales[2], box), test, reference)
    assert error.tip_rms < 2e-4


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_noise(name, cases):
    """0.05 mm on each coordinate, 0.5 % on the torque: the clean held-out error stays under 15 um and 0.2 %."""
    hinge, box, test, reference = cases[name]
    states = fit_states(hinge, box)
    for seed in range(3):
        rng = np.random.default_rng(seed)
        noisy = replace(states, tip=states.tip + 5e-5 * rng.normal(size=states.tip.shape),
                        moment=states.moment + 5e-3 * reference * rng.normal(size=len(states)))  # fmt: skip
        error = model_errors(fit_potential(noisy, L, box=box).potential, test, reference)
        assert error.tip_rms < 15e-6
        assert error.moment_rms < 2e-3


def test_hinges_without_symmetry():
    leaves = (
        Leaf(GROUND, (0, -0.01), TIP, (0.04, 0.012), 0.02, 0.0008),
        Leaf(GROUND, (0, 0.02), TIP, (0.04, -0.005), 0.02, 0.0006),
    )
    hinge = Hinge("asymmetric", leaves, L)
    assert symmetry_of(hinge) == "none"
    joint = fit_joint(hinge, max_force=1.0)
    assert joint.errors["potential"].tip_rms < 5e-6
    assert joint.errors["potential"].moment_rms < 5e-4
    certify(joint.models["potential"])
    pivot = fit_joint(preset("cross-spring", crossing=0.13))
    assert pivot.errors["potential"].tip_rms < 5e-6
    assert pivot.errors["potential"].moment_rms < 5e-4


def test_frame_does_not_matter_to_an_asymmetric_fit():
    """The mirror image's fit is the mirror image of the fit."""
    leaf = Leaf(GROUND, (0, 0), TIP, (0.04, 0.01), 0.04, 0.0008)
    image = Leaf(GROUND, (0, 0), TIP, (0.04, -0.01), 0.04, 0.0008)
    box = Box(0.4, 1.0)
    fits = [fit_potential(fit_states(Hinge("h", (shape,), L), box, 400), L, box=box, symmetry="none").potential
            for shape in (leaf, image)]  # fmt: skip
    theta, force = np.linspace(-0.4, 0.4, 9), np.column_stack([np.linspace(-1, 1, 9), np.full(9, 0.4)])
    one, other = fits[0].poses(theta, force), fits[1].poses(-theta, force * [1, -1])
    assert other.tip == pytest.approx(one.tip * [1, -1], abs=5e-6)
    assert other.moment == pytest.approx(-one.moment, abs=5e-4 * np.abs(one.moment).max())


def test_units_do_not_matter():
    """The same hinge at ten times the modulus: the same shape, ten times the wrench."""
    hinge = preset("tfch")
    box = default_box(hinge)
    states = fit_states(hinge, box, 200)
    soft = fit_potential(states, L, box=box).potential
    stiff = fit_potential(replace(states, force=10 * states.force, moment=10 * states.moment), L,
                          box=Box(box.max_angle, 10 * box.max_force)).potential  # fmt: skip
    pose = (0.0395, 0.006, 0.3)
    assert stiff.wrench(*pose) == pytest.approx(tuple(10 * w for w in soft.wrench(*pose)), rel=1e-5)


def test_too_few_states_and_states_without_load():
    hinge = preset("leaf-spring")
    states = fit_states(hinge, default_box(hinge), 64)
    with pytest.raises(FlexureError, match="5 states give 15 numbers for 17 coefficients; give 6 states or more"):
        fit_potential(states.pick(slice(0, 5)), L)
    with pytest.raises(FlexureError, match="load the hinge"):
        fit_potential(replace(states, force=0 * states.force), L)
    with pytest.raises(FlexureError, match="symmetry = 'point'"):
        fit_potential(states, L, symmetry="point")
    with pytest.raises(FlexureError, match="count = 4"):
        fit_states(hinge, default_box(hinge), 4)
    with pytest.raises(FlexureError, match="seed = 12345"):
        fit_joint(hinge, seed=12345)


def test_what_one_load_path_cannot_tell_is_said():
    """A force across the arm alone says nothing of how the axial compliance grows with rotation."""
    from tensegym.flexure.fem.arm_sweep import arm_sweep

    fit = fit_potential(arm_sweep(preset("leaf-spring"), 0.5, 60), L)
    assert fit.unidentified


def test_a_box_past_buckling_is_refused():
    with pytest.raises(FlexureError, match=r"leaf-spring: at theta = .* lower max_force = 8 N or max_angle"):
        fit_joint(preset("leaf-spring"), max_force=8.0)


def test_parallel_guide():
    """It translates: a different use of the same potential, with its own, larger error."""
    joint = fit_joint(preset("parallel-guide"))
    assert joint.errors["potential"].tip_rms < 2e-5
    assert any("sb" in note for note in joint.notes)
