"""FlexureJoint in PyBullet against the fitted model's own solution, an independent integration and closed forms."""

import warnings
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tensegym.bullet import packaged_urdf
from tensegym.compiled import kernel
from tensegym.errors import FlexureError, SimulationError
from tensegym.flexible import FlexibleRobot, FlexureJoint, Load, load_robot, spring_kernel
from tensegym.flexible.springs import spring_table
from tensegym.flexure import fem
from tensegym.flexure.hinge import PAPER_HINGES, Box, preset
from tensegym.flexure.models.joint_file import save_joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.flexure.models.planar_spring import PlanarSpring
from tensegym.flexure.models.potential_kernel import wrench
from tensegym.flexure.models.torsion_spring import TorsionSpring

STAND = packaged_urdf("flexure_stand.urdf")
ARM = 0.12  # m beyond the tip
MASS, CENTRE, INERTIA = 0.03, 0.06, 3.7e-5  # the stand's arm: kg, m beyond the tip, kg m^2 about its centre
END = (0.14, 0.0, 0.0)  # the arm's end in its own frame, which is half a hinge before the tip
RELEASE = np.radians(20)


@cache
def joint_of(name):
    return fit_joint(preset(name), held_out=0)


def stand(joint, dt=1e-3, pose=(0, 0, 0, 0, 0, 0, 1), **options):
    scheme = options.pop("scheme", "trapezoid")
    gravity = options.pop("gravity", (0.0, 0.0, 0.0))
    robot = FlexibleRobot(STAND, dt=dt, gravity=gravity, pose=pose, fixed_base=True, scheme=scheme)
    return robot, FlexureJoint(robot, "hinge", joint, **options)


def arm_state(spring, theta, limit):
    """Force across the undeformed arm at its end that holds theta, and the tip there: the model's own solution."""

    def miss(force):
        return spring.poses(np.array([theta]), np.array([[0.0, force]])).moment[0] - ARM * force * np.cos(theta)

    force = brentq(miss, -limit, limit, xtol=1e-15)
    return force, spring.poses(np.array([theta]), np.array([[0.0, force]])).tip[0]


def released(joint, dt, seconds, every=1, **options):
    """Times, theta and total energy of the arm let go at 20 deg."""
    robot, flexure = stand(joint, dt, **options)
    with robot:
        _, tip = arm_state(flexure.spring, RELEASE, joint.box.max_force)
        robot.place(robot.place_tip("hinge", [*tip, RELEASE]))
        theta, energy = [RELEASE], [robot.energies().total]
        for k in range(1, round(seconds / dt) + 1):
            robot.step()
            theta.append(flexure.pose[2])
            if k % every == 0:
                energy.append(robot.energies().total)
    return dt * np.arange(len(theta)), np.array(theta), np.array(energy)


def frequency(times, theta):
    """From the interpolated falling zeros."""
    i = np.flatnonzero((theta[:-1] > 0) & (theta[1:] <= 0))
    zeros = times[i] + theta[i] / (theta[i] - theta[i + 1]) * (times[i + 1] - times[i])
    return (len(zeros) - 1) / (zeros[-1] - zeros[0])


@kernel
def slope(coefficients, scales, state):
    """Newton-Euler of the arm about its centre, written out for the tip: d/dt (x, y, theta, and their rates)."""
    fx, fy, moment, _ = wrench(coefficients, scales, state[0], state[1], state[2])
    c, s, rate = CENTRE * np.cos(state[2]), CENTRE * np.sin(state[2]), state[5]
    turn = -(moment + s * fx - c * fy) / INERTIA
    out = np.empty(6)
    out[:3] = state[3:]
    out[3] = -fx / MASS + c * rate**2 + s * turn
    out[4] = -fy / MASS + s * rate**2 - c * turn
    out[5] = turn
    return out


def integrated(joint, seconds, every=1e-4):
    """The same equations, hinge and arm in (x, y, theta), by DOP853 at 1e-10."""
    spring = joint.models["potential"]
    _, tip = arm_state(spring, RELEASE, joint.box.max_force)

    times = np.arange(0, seconds, every)
    run = solve_ivp(lambda _, s: slope(spring.coefficients, spring.scales, s), (0, seconds), [*tip, RELEASE, 0, 0, 0],
                    "DOP853", times, rtol=1e-10, atol=1e-12)  # fmt: skip
    return run.t, run.y[2]


@pytest.mark.parametrize("name", PAPER_HINGES)
@pytest.mark.filterwarnings("ignore:flexure .* left its fitted domain:UserWarning")  # at its end, 30 deg
def test_at_rest_under_the_arms_force_it_is_where_the_model_says(name):
    """30 angles over +-30 deg, each from rest 5 % off; and the FEM's tip and force, to the fit's error."""
    joint = joint_of(name)
    robot, flexure = stand(joint, dt=2e-3, loss_time=0.02 if name == "x-hinge" else 0.06)  # near critical
    worst = np.zeros(4)
    angles = np.radians(np.linspace(-30, 30, 30))
    arm = fem.rotate(preset(name), angles[15:], direction=fem.arm_direction(angles[15:], ARM)).states()
    with robot:
        for i, theta in enumerate(angles):
            force, tip = arm_state(flexure.spring, theta, joint.box.max_force)
            _, off = arm_state(flexure.spring, 0.95 * theta, joint.box.max_force)
            robot.loads = [Load("arm", (0.0, force, 0.0), END)]
            robot.place(robot.place_tip("hinge", [*off, 0.95 * theta]))
            for _ in range(30):
                robot.step(20)
                if np.abs(robot.velocities).max() < 1e-5:
                    break
            error = flexure.pose - [*tip, theta]
            worst[:2] = np.maximum(worst[:2], [np.abs(error[2]), np.hypot(*error[:2])])
            if i >= 15:
                worst[2] = max(worst[2], np.hypot(*(flexure.pose[:2] - arm.tip[i - 15])))
                worst[3] = max(worst[3], abs(force - arm.force[i - 15, 1]) / arm.force[-1, 1])
    assert worst[0] < 1e-4  # rad
    assert worst[1] < 1e-5  # m
    assert worst[2] < 5e-6  # m; of the FEM's tip, the fits' largest tip errors are 0.2 to 3.3 um
    assert worst[3] < 5e-4  # of the FEM's force at 30 deg; the fits' largest torque errors are 2e-5 to 4e-4


@pytest.mark.parametrize("name", PAPER_HINGES)
def test_frequency_is_that_of_an_independent_integration(name):
    seconds = 0.35 if name == "x-hinge" else 0.9
    exact = frequency(*integrated(joint_of(name), seconds))
    for dt in (1e-3, 5e-4):
        times, theta, _ = released(joint_of(name), dt, seconds, every=10**9)
        assert frequency(times, theta) == pytest.approx(exact, rel=3e-3)


def test_it_converges_with_the_square_of_the_time_step():
    seconds = 0.1
    times, exact = integrated(joint_of("leaf-spring"), seconds + 1e-3, 1e-5)
    errors = []
    for dt in (1e-3, 5e-4, 2.5e-4):
        t, theta, _ = released(joint_of("leaf-spring"), dt, seconds, every=10**9)
        errors.append(np.abs(theta - np.interp(t, times, exact)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.8).all() and (orders < 2.3).all(), (errors, orders)


@pytest.mark.parametrize("name", ["leaf-spring", "tfch"])
def test_without_damping_ten_seconds_neither_make_nor_lose_energy(name):
    _, _, energy = released(joint_of(name), 1e-3, 10.0, every=10)
    assert energy.max() < 1.001 * energy[0]
    assert energy[-100:].mean() == pytest.approx(energy[1:101].mean(), rel=2e-4)


def test_damping_takes_the_logarithmic_decrement_it_should():
    """Small motion: delta = 2 pi zeta / sqrt(1 - zeta^2), zeta = loss time w / 2."""
    joint, loss = joint_of("leaf-spring"), 2e-3
    robot, flexure = stand(joint, loss_time=loss)
    with robot:
        _, tip = arm_state(flexure.spring, np.radians(1), joint.box.max_force)
        robot.place(robot.place_tip("hinge", [*tip, np.radians(1)]))
        theta = []
        for _ in range(2000):
            robot.step()
            theta.append(flexure.pose[2])
    theta = np.array(theta)
    peaks = theta[1:-1][(theta[1:-1] > theta[:-2]) & (theta[1:-1] > theta[2:])]
    measured = np.log(peaks[0] / peaks[5]) / 5
    # the slow mode of the linearised joint
    c = CENTRE
    mass = np.array([[MASS, 0, 0], [0, MASS, MASS * c], [0, MASS * c, INERTIA + MASS * c**2]])
    stiffness = flexure.spring.stiffness(flexure.spring.length, 0, 0)
    w = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.min())
    zeta = loss * w / 2
    assert measured == pytest.approx(2 * np.pi * zeta / np.sqrt(1 - zeta**2), rel=0.03)


def test_the_stand_turned_at_random_moves_the_same():
    rng = np.random.default_rng(3)
    joint = joint_of("leaf-spring")

    def run(turn, place):
        pose = [*place, *turn.as_quat()]
        robot, flexure = stand(joint, pose=pose, gravity=turn.apply([0.5, -2.0, -9.0]))
        with robot:
            _, tip = arm_state(flexure.spring, RELEASE, joint.box.max_force)
            robot.place(robot.place_tip("hinge", [*tip, RELEASE]))
            robot.step(300)
            return flexure.pose

    still = run(Rotation.identity(), np.zeros(3))
    for _ in range(20):
        np.testing.assert_allclose(run(Rotation.random(rng=rng), rng.uniform(-1, 1, 3)), still, rtol=0, atol=1e-9)


def test_in_free_flight_momentum_stays_to_the_square_of_the_time_step():
    """The whole stand thrown, spinning and swinging."""
    errors = []
    for dt in (2e-3, 1e-3):
        with FlexibleRobot(STAND, dt=dt, gravity=(0, 0, 0)) as robot:
            flexure = FlexureJoint(robot, "hinge", joint_of("leaf-spring"))
            _, tip = arm_state(flexure.spring, RELEASE, 1.0)
            robot.place(robot.place_tip("hinge", [*tip, RELEASE]), twist=(0.1, 0.2, -0.1, 0.5, -0.7, 0.9))
            start, energy = robot.momentum(), robot.energies().total
            robot.step(round(1 / dt))
            errors.append(np.abs(robot.momentum() - start).max() / np.linalg.norm(start))
            assert robot.energies().total == pytest.approx(energy, rel=1e-3)
    assert errors[1] < 1e-4
    assert 3.0 < errors[0] / errors[1] < 5.0


def test_gradient_and_hessian_of_every_spring_are_those_of_its_energy():
    planar = PlanarSpring(0.04, 0.6, 2e3, 9e2, 0.3)
    springs = [joint_of("leaf-spring").models["potential"], planar, TorsionSpring(0.04, 0.78, 0.2)]
    table = spring_table(springs, [[0, 1, 2, 3, 4, 5]] * 3, [(1e3, 5.0, 7.0)] * 3, [0.0] * 3, [Box(0.5, 2.0)] * 3)
    rng = np.random.default_rng(0)
    for f in range(3):
        pose = np.array([0.039, 0.002, 0.1, 1e-4, 0.01, 0.02]) + 1e-4 * rng.normal(size=6)
        gradient, hessian, spare = np.empty(6), np.empty((6, 6)), np.empty((6, 6))
        spring_kernel.spring(table, f, pose, gradient, hessian)
        for k, step in enumerate([1e-7, 1e-7, 1e-5, 1e-7, 1e-5, 1e-5]):
            up, down = pose.copy(), pose.copy()
            up[k], down[k] = pose[k] + step, pose[k] - step
            more, less = np.empty(6), np.empty(6)
            rise = spring_kernel.spring(table, f, up, more, spare) - spring_kernel.spring(table, f, down, less, spare)
            slope = rise / (2 * step)
            assert slope == pytest.approx(gradient[k], rel=1e-5, abs=1e-7)
            np.testing.assert_allclose((more - less) / (2 * step), hessian[:, k], rtol=1e-5, atol=1e-4)
    # the planar spring's energy is planar_spring's own, from its poses under a force
    states = planar.poses(np.array([0.3]), np.array([[0.7, -0.4]]))
    gradient, pose = np.empty(6), np.array([*states.tip[0], 0.3, 0, 0, 0])
    energy = spring_kernel.spring(table, 1, pose, gradient, np.empty((6, 6)))
    assert energy == pytest.approx(planar.energies(states)[0], rel=1e-12)
    np.testing.assert_allclose(gradient[:3], [0.7, -0.4, states.moment[0]], rtol=1e-10)


@pytest.mark.parametrize("kind", ["planar", "torsion"])
def test_the_simpler_models_swing_at_their_own_frequency(kind):
    """Small motion of the linearised joint; a pin's is sqrt(k / inertia about the pin)."""
    joint = joint_of("leaf-spring")
    robot, flexure = stand(joint, kind=kind)
    with robot:
        robot.place({"hinge": 1e-3} if kind == "torsion" else robot.place_tip("hinge", [*_static(flexure), 1e-3]))
        theta = []
        for _ in range(1500):
            robot.step()
            theta.append(flexure.pose[2])
    spring = flexure.spring
    if kind == "torsion":
        w = np.sqrt(spring.stiffness / (INERTIA + MASS * (CENTRE + spring.fraction * spring.length) ** 2))
    else:
        pose, gradient, hessian = np.array([spring.length, 0, 0, 0, 0, 0.0]), np.empty(6), np.empty((6, 6))
        spring_kernel.spring(robot.springs, 0, pose, gradient, hessian)
        mass = np.array([[MASS, 0, 0], [0, MASS, MASS * CENTRE], [0, MASS * CENTRE, INERTIA + MASS * CENTRE**2]])
        w = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, hessian[:3, :3])).real.min())
    assert frequency(1e-3 * np.arange(1, 1501), np.array(theta)) == pytest.approx(w / (2 * np.pi), rel=1e-3)


def _static(flexure):
    return arm_state(flexure.spring, 1e-3, 1.0)[1]


def test_out_of_plane_the_stated_stiffness_carries_the_weight():
    """Gravity along z: z sags by m g / k, the arm droops by m g c / k about y."""
    across = (2e3, 5.0, 5.0)
    robot, flexure = stand(joint_of("leaf-spring"), across=across, gravity=(0, 0, -9.81), loss_time=1e-2)
    with robot:
        robot.step(1500)
        z, droop = robot.positions[robot.joints["hinge/z"]], robot.positions[robot.joints["hinge/ry"]]
        assert z == pytest.approx(-MASS * 9.81 / across[0], rel=1e-3)
        assert across[1] * droop == pytest.approx(MASS * 9.81 * CENTRE * np.cos(droop), rel=1e-3)
        assert np.abs(flexure.pose - [0.04, 0, 0]).max() < 1e-9


def test_explicit_forces_blow_up_at_1_ms_where_the_trapezoid_holds():
    with pytest.raises(SimulationError, match="diverged"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        released(joint_of("leaf-spring"), 1e-3, 0.5, every=10**9, scheme="explicit")


def test_outside_the_fitted_domain_it_warns_once_and_reports():
    joint = joint_of("leaf-spring")
    robot, flexure = stand(joint)
    with robot:
        robot.place(rates={"hinge": 0.0})
        assert flexure.margin == pytest.approx(1.0)
        robot.step(10)
        assert flexure.outside.steps == 0
        robot.torques[robot.joints["hinge"]] = 0.05  # N m: swings to twice what it holds, over 30 deg
        with pytest.warns(UserWarning, match="left its fitted domain") as caught:
            robot.step(150)
        assert len(caught) == 1
        assert flexure.outside.steps > 10 and flexure.outside.margin < 0


def test_a_link_stays_where_the_urdf_has_it():
    robot, _ = stand(joint_of("tfch"))
    with robot:
        place, turn = robot.link_pose("arm")
        np.testing.assert_allclose(place, [0.02, 0, 0], atol=1e-8)  # the engine's URDF reader rounds
        np.testing.assert_allclose(turn, np.eye(3), atol=1e-8)


def test_bad_joints_are_refused(tmp_path):
    joint = joint_of("leaf-spring")
    with FlexibleRobot(STAND, fixed_base=True) as robot:
        with pytest.raises(FlexureError, match=r"no joint 'elbow'; its joints are guide, hinge"):
            FlexureJoint(robot, "elbow", joint)
        with pytest.raises(FlexureError, match=r"'guide' .* is prismatic"):
            FlexureJoint(robot, "guide", joint)
        with pytest.raises(FlexureError, match="no gradient of an energy"):
            FlexureJoint(robot, "hinge", joint, kind="paper")
        with pytest.raises(FlexureError, match="has no limit"):
            FlexureJoint(robot, "hinge", PlanarSpring(0.04, 0.6, 1.0, 1.0, 1.0))
        with pytest.raises(FlexureError, match="not across"):
            FlexureJoint(robot, "hinge", joint, along=(0, 1, 1))
        with pytest.raises(FlexureError, match="loss_time = -1"):
            FlexureJoint(robot, "hinge", joint, loss_time=-1)
        with pytest.raises(FlexureError, match="centre = nan"):
            FlexureJoint(robot, "hinge", joint, centre=np.nan)
        assert not robot.flexures and list(robot.joints) == ["hinge", "guide"]
        FlexureJoint(robot, "hinge", joint)
        with pytest.raises(FlexureError, match="a flexure already"):
            FlexureJoint(robot, "hinge", joint)
    for old, new, words in (('type="revolute"', 'type="fixed"', "'hinge' .* is fixed"),
                            ('<limit lower="-1.5" upper="1.5" effort="10" velocity="100"/>', "", "without a limit")):
        path = tmp_path / "stand.urdf"
        path.write_text(STAND.read_text().replace(old, new))
        with pytest.raises(FlexureError, match=words), FlexibleRobot(path, fixed_base=True) as robot:
            FlexureJoint(robot, "hinge", joint)
    with pytest.raises(FlexureError, match="gravity = "):
        FlexibleRobot(STAND, gravity=(0, 0))
    with pytest.raises(FlexureError, match=r"force on link 'arm' = "):
        Load("arm", (np.nan, 0, 0))
    with FlexibleRobot(STAND, fixed_base=True) as robot, pytest.raises(FlexureError, match="position of hinge"):
        robot.place({"hinge": np.inf})
    with pytest.raises(FileNotFoundError):
        FlexibleRobot(tmp_path / "none.urdf")
    (tmp_path / "bad.urdf").write_text("<robot")
    with pytest.raises(FlexureError, match="is no XML"):
        FlexibleRobot(tmp_path / "bad.urdf")


def test_a_file_beside_the_urdf_declares_the_flexures(tmp_path):
    save_joint(joint_of("leaf-spring"), tmp_path / "leaf.json")
    path = tmp_path / "stand.toml"
    text = ('urdf = "flexure_stand.urdf"\n[[flexure]]\njoint = "hinge"\nhinge = "leaf-spring"\nfit = "leaf.json"\n'
            "loss_time_s = 1e-4\n")  # fmt: skip
    path.write_text(text)
    with load_robot(path, fixed_base=True) as robot:
        assert list(robot.flexures) == ["hinge"] and robot.flexures["hinge"].loss_time == 1e-4
    for old, new, words in (
        ('hinge = "leaf-spring"', 'hinge = "tfch"', "leaf.json was fitted to another hinge"),
        ('joint = "hinge"', 'joint = "elbow"', "no joint 'elbow'"),
        ('joint = "hinge"', "", "has no 'joint'"),
        ('hinge = "leaf-spring"\nfit = "leaf.json"', "", "neither hinge nor fit"),
        ("loss_time_s = 1e-4", 'loss_time_s = "much"', "loss_time_s = 'much' is a text"),
        ("loss_time_s = 1e-4", "loss = 1", "unknown field 'loss' in flexure 1"),
        ("loss_time_s = 1e-4", "out_of_plane = [1, 2, -3]", r"stand.toml: joint 'hinge': across = \(1.0, 2.0, -3.0\)"),
        ("loss_time_s = 1e-4", 'model = "paper"', "model = 'paper' is not one of potential, planar, torsion"),
        ('[[flexure]]\njoint = "hinge"', "", "unknown field"),
    ):
        path.write_text(text.replace(old, new))
        with pytest.raises(FlexureError, match=words):
            load_robot(path, fixed_base=True)
    with pytest.raises(FileNotFoundError):
        load_robot(tmp_path / "none.toml")


def test_rest_is_on_the_limit_of_a_joint_that_is_only_pulled():
    spring = PlanarSpring(0.04, 0.4, 1e5, 1e5, 0.1)
    pulled = Box(0.5, 2.0, force_x=(0.0, 40.0))
    robot, flexure = stand(spring, box=pulled)
    with robot, warnings.catch_warnings():
        warnings.simplefilter("error")
        assert flexure.margin == pytest.approx(0.0, abs=1e-12)
        robot.step()  # gravity is off: nothing pulls, and rounding is no load outside
        assert flexure.outside.steps == 0
    table = spring_table([spring], [[0, 1, 2, -1, -1, -1]], [(0, 0, 0)], [0.0], [pulled])
    for force, margin in (((20, 0), 1.0), ((40, 1), 0.0), ((10, 0), 0.5), ((20, 1), 0.5), ((-20, 0), -1.0)):
        found = spring_kernel.margin(table, 0, np.zeros(6), np.array([*force, 0.0, 0, 0, 0], dtype=float))
        assert found == pytest.approx(margin)
