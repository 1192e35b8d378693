"""The paper's models: its Table 1, the planar spring's gradient, the guarded inversion, the choice of a model."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tensegym.cli.flexure.table import PAPER_TABLE_1
from tensegym.errors import FlexureError
from tensegym.flexure import fem
from tensegym.flexure.fem.arm_sweep import arm_sweep
from tensegym.flexure.fem.centre_shift import crossing_shift, least_shift_crossing
from tensegym.flexure.hinge import PAPER_HINGES, States, preset
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.model_choice import choose_model
from tensegym.flexure.models.planar_spring import PlanarSpring, fit_planar, spring_energy, spring_poses, spring_wrench
from tensegym.flexure.models.pseudo_rigid import planar_placement, torsion_lambda
from tensegym.flexure.models.stiffness_diagram import fit_diagram, invert
from tensegym.flexure.models.torsion_spring import TorsionSpring, fit_torsion

L = 0.04


@pytest.fixture(scope="module")
def sweeps():
    return {name: arm_sweep(preset(name), np.radians(24)) for name in PAPER_HINGES}


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_table_1_under_the_reading_that_made_it(name, sweeps):
    fraction, a, b, dx, _ = PAPER_TABLE_1[name]
    place = planar_placement(sweeps[name], L)
    assert torsion_lambda(sweeps[name], L) == pytest.approx(fraction, abs=0.02)
    assert (place.a, place.b) == pytest.approx((a, b), abs=0.02)
    assert 1e3 * place.dx < dx / 5  # not reproduced: ours is far smaller


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_f2_as_printed_has_its_minimum_elsewhere(name, sweeps):
    """Its own objective is smaller there than at the paper's a and b: they are not its optimum."""
    printed, table = planar_placement(sweeps[name], L, "F2"), planar_placement(sweeps[name], L)
    assert 0.49 < printed.b < 0.54
    assert table.dy / printed.dy > 70
    assert np.hypot(printed.dx, printed.dy) < np.hypot(table.dx, table.dy)


def test_dx_alone_is_a_minimum(sweeps):
    from tensegym.flexure.models.pseudo_rigid import spring_track

    place = planar_placement(sweeps["tfch"], L)
    around = [np.ptp(spring_track(sweeps["tfch"], L, place.b + d)[:, 0]) for d in np.linspace(-0.3, 0.6, 91)]
    assert place.dx <= min(around) + 1e-12


@settings(deadline=None)
@given(st.floats(0.2, 2.5), st.floats(0.01, 1))
def test_lambda_of_a_pin(fraction, stiffness):
    """The states of a torsion spring give back its lambda and its stiffness."""
    theta = np.linspace(-0.4, 0.4, 9)
    spring = TorsionSpring(L, fraction, stiffness)
    states = spring.poses(theta, np.column_stack([0.2 * theta, np.cos(theta)]))
    again = fit_torsion(states, L)
    assert (again.fraction, again.stiffness) == pytest.approx((fraction, stiffness), rel=1e-5)


def test_lambda_above_one_means_a_flat_tip_path(sweeps):
    """lambda = b1^2 / b with b1 the pole at rest; for a symmetric hinge b1 is a half and b half the tip's curvature."""
    theta, tip = sweeps["tfch"].theta, sweeps["tfch"].tip
    b1 = np.polyfit(theta, tip[:, 1], 5)[-2] / L
    b = -2 * np.polyfit(theta, tip[:, 0], 6)[-3] / L
    assert torsion_lambda(sweeps["tfch"], L) == pytest.approx(b1**2 / b, rel=0.02)


@settings(deadline=None)
@given(st.floats(-0.01, 0.01), st.floats(-0.01, 0.01), st.floats(-1, 1), st.floats(10, 1e4), st.floats(10, 1e4))
def test_planar_spring_is_the_gradient_of_its_potential(x, y, theta, kx, ky):
    """The wrench in moving axes, turned back: the factor 1/2 in the moment, lost in print, is what makes this pass."""
    kz, step = 0.1, 1e-6
    f_x, f_y, m = spring_wrench(x, y, theta, kx, ky, kz)
    c, s = np.cos(theta), np.sin(theta)

    def slope(dx, dy, dt):
        up = spring_energy(x + step * dx, y + step * dy, theta + step * dt, kx, ky, kz)
        return (up - spring_energy(x - step * dx, y - step * dy, theta - step * dt, kx, ky, kz)) / (2 * step)

    size = 1e-6 * (kx + ky) * 0.01 + 1e-8
    assert slope(1, 0, 0) == pytest.approx(c * f_x - s * f_y, rel=1e-5, abs=size)
    assert slope(0, 1, 0) == pytest.approx(s * f_x + c * f_y, rel=1e-5, abs=size)
    assert slope(0, 0, 1) == pytest.approx(m, rel=1e-5, abs=size)


def test_planar_spring_pose_and_fit_return_what_made_them():
    spring = PlanarSpring(L, 0.45, 5000.0, 800.0, 0.12)
    rng = np.random.default_rng(0)
    theta, force = rng.uniform(-0.5, 0.5, 60), rng.uniform(-1, 1, (60, 2))
    states = spring.poses(theta, force)
    again = fit_planar(states, L)
    assert (again.b, again.kx, again.ky, again.kz) == pytest.approx((0.45, 5000, 800, 0.12), rel=1e-5)


def test_inversion_returns_constant_stiffnesses():
    theta = np.linspace(0.05, 0.6, 20)
    states = spring_poses(theta, np.column_stack([0.3 + theta, 1 - theta]), L, 0.4, 5000.0, 800.0, 0.12)
    k, share = invert(states, L, 0.4)
    assert k == pytest.approx(np.tile([5000.0, 800.0, 0.12], (20, 1)), rel=1e-8)
    assert (share > 0).all()


def test_inversion_is_guarded_at_rest_and_under_a_pure_moment():
    """A symmetric hinge under a pure moment, a = b: the displacement lies on the half-angle axis; no kx, no ky."""
    states = fem.rotate(preset("leaf-spring"), np.radians(np.linspace(1, 30, 30))).states()
    k, share = invert(states, L, 0.5)
    assert np.isnan(k).all() and share.max() < 1e-6
    with pytest.raises(FlexureError, match="singular along the whole path"):
        from tensegym.flexure.models.pseudo_rigid import Placement

        fit_diagram(states, L, Placement(0.5, 0.5, 0, 0, "dx"))
    sweep = arm_sweep(preset("leaf-spring"), 0.5)
    diagram = fit_diagram(sweep, L)
    assert 0.0 in diagram.singular and np.isfinite(diagram.stiffness).all()


def test_the_x_hinges_diagrams_are_negative(sweeps):
    assert (fit_diagram(sweeps["x-hinge"], L).stiffness[:, :2] < 0).all()


def test_diagrams_reproduce_their_own_path(sweeps):
    sweep = sweeps["leaf-spring"]
    diagram = fit_diagram(sweep, L)
    part = sweep.pick(np.isin(sweep.theta, diagram.theta))
    again = diagram.poses(part.theta, part.force)
    assert again.tip == pytest.approx(part.tip, abs=1e-10)
    assert again.moment == pytest.approx(part.moment, rel=1e-8)
    poses = np.column_stack([part.tip, part.theta])
    assert diagram.wrenches(poses) == pytest.approx(np.column_stack([part.force, part.moment]), rel=1e-6, abs=1e-9)


def test_a_sweep_that_does_not_turn_is_refused():
    still = States(np.zeros(5), np.tile([L, 0.0], (5, 1)), np.zeros((5, 2)), np.zeros(5))
    with pytest.raises(FlexureError, match="turn the hinge"):
        planar_placement(still, L)
    with pytest.raises(FlexureError, match="a sweep needs 3"):
        torsion_lambda(still.pick(slice(0, 2)), L)
    with pytest.raises(FlexureError, match="reading = 'dy'"):
        planar_placement(arm_sweep(preset("tfch"), 0.2), L, "dy")


def test_centre_shift_of_the_cross_spring():
    """|9 c^2 - 9 c + 1| theta^2 l / (15 cos alpha) at small angles, leaves at 45 deg; least near c = 0.1273."""
    angle, leaf = np.radians(2), 0.04 * np.sqrt(2)
    for crossing in (0.05, 0.3, 0.5):
        expected = abs(9 * crossing**2 - 9 * crossing + 1) * angle**2 * leaf / (15 * np.cos(np.pi / 4))
        assert crossing_shift(crossing, angle, thickness=0.0002) == pytest.approx(expected, rel=0.01)
    crossing, shift = least_shift_crossing(np.radians(5), thickness=0.0002)
    assert crossing == pytest.approx((3 - np.sqrt(5)) / 6, abs=2e-4)
    assert least_shift_crossing(np.radians(20))[0] == pytest.approx(0.13, abs=0.005)
    assert shift < 0.02 * crossing_shift(0.5, np.radians(5), thickness=0.0002)


def test_the_simplest_model_that_is_enough():
    hinge = preset("x-hinge")
    joint = fit_joint(hinge, held_out=0)
    chosen = [choose_model(hinge, error, joint=joint).model for error in (2e-3, 5e-4, 1e-5, 1e-9)]
    assert chosen == ["torsion", "planar", "potential", "fem"]
    choice = choose_model(hinge, 5e-4, joint=joint)
    assert choice.tip_errors["torsion"] > 5e-4 >= choice.tip_errors["planar"]
    assert "torsion" in choice.reason and choice.drift.reading == "dx"
    with pytest.raises(FlexureError, match="accepted = 0 m"):
        choose_model(hinge, 0, joint=joint)
    with pytest.raises(FlexureError, match="loads = 'all'"):
        choose_model(hinge, 1e-3, joint=joint, loads="all")
