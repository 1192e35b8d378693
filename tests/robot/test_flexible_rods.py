"""Six-rod robots whose rods are split by flexures: from the design to the motion in PyBullet."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tensegym.bullet import packaged_urdf
from tensegym.design.design import RobotDesign, flexible_design
from tensegym.design.design_file import as_design, load_design, save_design
from tensegym.design.parameters import ElasticCable, Payload, Rod, RodFlexure
from tensegym.design.urdf_writer import urdf_files
from tensegym.errors import DesignError, FlexureError
from tensegym.physics.robot_arrays import mobility_at_rest, robot_model
from tensegym.robot.modes import design_modes
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.modes import free_modes
from tensegym.validation.breathing import equal_rods
from tensegym.validation.flight import free_flight

LOOSE = RodFlexure(rods="all", loss_time=0.0)


def free(**changes):
    """A robot of equal, undamped, flexible rods in free flight."""
    return equal_rods(0.0).with_(**{"flexure": LOOSE, **changes})


@given(length=st.floats(0.05, 3), tube=st.floats(1e-3, 5), end=st.floats(0, 5))
def test_two_halves_make_the_rod(length, tube, end):
    rod = Rod(tube_mass=tube, end_mass=end)
    half = rod.half(length / 2)
    assert 2 * half.mass == pytest.approx(rod.mass)
    about_middle = half.transverse_inertia + half.mass * (length / 2 - half.centre) ** 2
    assert 2 * about_middle == pytest.approx(rod.transverse_inertia(length))
    assert 2 * half.axial_inertia == pytest.approx(rod.axial_inertia)


def test_prestress_compression_is_that_of_the_closed_form():
    design = RobotDesign()
    np.testing.assert_allclose(design.rod_compressions, np.sqrt(6) * design.elastic_cable.pretension, rtol=1e-9)


def test_a_prestress_over_buckling_is_refused_with_both_numbers():
    with pytest.raises(DesignError, match=r"compresses rod 1-2 by 24\.49 N, over the 8\.1\d+ N .*thicken"):
        RobotDesign(flexure=RodFlexure(thickness=5e-4))
    limit = flexible_design().buckling_load(0)
    tension = limit / np.sqrt(6)
    RobotDesign(flexure=RodFlexure(), elastic_cable=ElasticCable(pretension=0.99 * tension))
    with pytest.raises(DesignError, match="buckles"):
        RobotDesign(flexure=RodFlexure(), elastic_cable=ElasticCable(pretension=1.01 * tension))


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [("rods", "some", "passive, active, all"), ("plane", "up", "radial, tangential"), ("length", 0.8, "outside"),
     ("thickness", 0.02, "length / 4"), ("hinge", "leaf", "unknown hinge 'leaf'"), ("height", -1.0, "outside"),
     ("loss_time", -1.0, "outside")],
)  # fmt: skip
def test_bad_flexures_are_refused(field, value, words):
    with pytest.raises((DesignError, FlexureError), match=words):
        RobotDesign(flexure=RodFlexure(**{field: value}))


def test_a_hinge_longer_than_the_rod_is_refused():
    with pytest.raises(DesignError, match="longer than the rod"):
        as_design({"structure": {"rod_length": 0.3}, "flexure": {"length": 0.31, "thickness": 2e-3}})


@pytest.mark.parametrize(
    "flexure", [{"hinge": "parallel-guide", "max_angle": 0.01}, {"length": 0.5, "thickness": 3e-3}]
)
def test_a_hinge_that_no_pin_stands_for_is_refused(flexure):
    with pytest.raises(DesignError, match=r"no pin stands for.*outside \[0\.8, 1\.25\]; take a shorter"):
        RobotDesign(flexure=RodFlexure(**flexure))


def test_design_file_round_trip(tmp_path):
    design = RobotDesign(flexure=RodFlexure(hinge="cross-spring", rods="all", height=0.03))
    save_design(design, tmp_path / "d.toml")
    assert load_design(tmp_path / "d.toml").flexure == design.flexure
    assert as_design({"flexure": {}}).flexure == RodFlexure()


def test_the_committed_urdf_is_what_the_preset_writes():
    for name, text in urdf_files(flexible_design()).items():
        path = packaged_urdf(name)
        assert path is not None and path.read_text() == text, name


def test_modes_of_plain_rods_are_the_closed_form():
    design = equal_rods(0.0)
    rod = design.passive_rod
    closed = free_modes(design.standing, 10.0, 300.0, rod.mass, rod.transverse_inertia(design.length))
    got = design_modes(design).frequencies
    np.testing.assert_allclose(got[:6], 0.0)  # spins: the cables of this robot end on the axes
    np.testing.assert_allclose(got[6:], closed.frequencies, rtol=1e-8)


@pytest.mark.parametrize("plane", ["radial", "tangential"])
def test_flexures_keep_the_multiplicities_of_the_symmetric_robot(plane):
    """Irreducible representations of its group have 1, 2 or 3 dimensions; rigid: 1 3 3 2 2 3 3 1 3 3."""
    stiff = design_modes(free(flexure=RodFlexure(rods="all", plane=plane, thickness=9e-3)))
    counts = sorted(n for f, n in stiff.multiplicities(1e-4) if 0 < f < 100)
    assert counts == sorted(n for f, n in design_modes(equal_rods(0.0)).multiplicities() if f > 0)
    soft = design_modes(free(flexure=RodFlexure(rods="all", plane=plane))).multiplicities(1e-4)
    assert sum(n for _, n in soft) == 6 + 24 + 6
    assert {n for f, n in soft if f > 0} <= {1, 2, 3}


def test_compression_softens_the_bending():
    """The pinned rod would lose it at its buckling load; the cables hold its ends besides."""
    limit = free().buckling_load(0) / np.sqrt(6)
    highest = [np.nanmax(design_modes(free(elastic_cable=ElasticCable(damping=0.0, pretension=t))).frequencies)
              for t in (0.1, 0.4 * limit, 0.9 * limit)]  # fmt: skip
    assert highest[0] > highest[1] > highest[2]


def test_mobility_of_pinned_rods_is_the_effect_of_tensions_on_length_rates():
    """A = J M^-1 J^T, M from the modes' coordinates, J by differences of the lengths in the engine's kinematics."""
    arrays = robot_model(flexible_design())
    mobility = mobility_at_rest(arrays)
    np.testing.assert_allclose(mobility, mobility.T)
    assert np.linalg.eigvalsh(mobility)[0] > -1e-9
    # a flexure's own row: two halves free to turn about their pin, rigid motion taken out
    row = arrays.first_flexure
    one = arrays.pin_bodies[0, 0]
    m, inertia = arrays.masses[one], arrays.inertias[one, 0]
    arm = np.linalg.norm(arrays.pin_params[0, :3])
    # each half turns by half the angle, its centre moves arm times that, less the common motion of the middle
    about_pin = inertia + m * arm**2
    reduced = 0.5 * (about_pin - m * arm**2)
    assert mobility[row, row] == pytest.approx(1 / reduced, rel=1e-9)


@pytest.mark.parametrize("dt", [1e-3, 2e-3])
def test_momentum_is_kept_in_free_flight_as_by_rigid_rods(dt):
    flexible = free_flight(dt, design=flexible_design().with_(spin_damping=0.0))
    assert flexible.linear_drift < 1e-10 and flexible.angular_drift < 1e-10
    assert flexible.least_tension >= 0


def bend(robot, rate):
    """Start with every rod bending at ``rate`` [rad/s], momentum zero."""
    arrays = robot.model
    v = np.zeros((len(arrays.masses), 6))
    for one, two in arrays.pin_bodies:
        axis = Rotation.from_quat(arrays.rest_poses[one, 3:]).apply([0, 1, 0])
        for body, sign in ((one, -0.5), (two, 0.5)):
            pin = arrays.rest_poses[arrays.pin_bodies[arrays.pin_bodies[:, 0] == one][0], :3].mean(axis=0)
            v[body, 3:] = sign * rate * axis
            v[body, :3] = np.cross(v[body, 3:], arrays.rest_poses[body, :3] - pin)
    robot.reset_rotated(Rotation.identity(), v)


def test_bending_frequency_in_pybullet_is_that_of_the_modes():
    """All rods bending alike, the singlet of the flexures: frequency from crossings of the mean angle."""
    design = free()
    expected = max(f for f, n in design_modes(design).multiplicities(1e-4) if n == 1)
    with TensegrityRobot(design, dt=2.5e-4, ground=False) as robot:
        bend(robot, 0.05)
        angles = []
        for _ in range(4000):
            robot.step()
            angles.append(robot.flexure_angles)
    s = np.mean(angles, axis=1)
    assert np.ptp(angles[-1]) < 1e-9  # the motion is the symmetric one
    spectrum = np.abs(np.fft.rfft(s * np.hanning(len(s)), 16 * len(s)))
    measured = np.fft.rfftfreq(16 * len(s), 2.5e-4)[spectrum.argmax()]
    assert measured == pytest.approx(expected, rel=2e-3)


def test_energy_of_undamped_flexures_swings_with_the_square_of_the_step_and_does_not_drift():
    worst = []
    for dt in (1e-3, 5e-4):
        with TensegrityRobot(free(), dt=dt, ground=False, integrator="explicit") as robot:
            bend(robot, 1.0)
            energies = []
            for _ in range(round(1.0 / dt)):
                robot.step()
                energies.append(robot.energies().total)
        e = np.array(energies)
        assert abs(e[len(e) // 2 :].mean() / e[: len(e) // 2].mean() - 1) < 1e-4
        worst.append(np.ptp(e) / e.mean())
    assert worst[0] < 0.01 and worst[1] < 0.6 * worst[0]


def test_structural_damping_makes_the_decrement_of_the_mode():
    """Damping ratio loss_time / (2 w) dw^2 / d ln K of the singlet: the flexure's part in the mode's stiffness."""
    loss, dt = 3e-4, 2.5e-4

    def bending(thickness):
        modes = design_modes(free(flexure=RodFlexure(rods="all", thickness=thickness))).multiplicities(1e-4)
        return (2 * np.pi * max(f for f, n in modes if n == 1)) ** 2

    t, part = LOOSE.thickness, 1e-3
    slope = (bending(t * (1 + part)) - bending(t * (1 - part))) / (6 * part)  # K grows with the cube of the thickness
    expected = loss / 2 * slope / np.sqrt(bending(t))
    with TensegrityRobot(free(flexure=RodFlexure(rods="all", loss_time=loss)), dt=dt, ground=False) as robot:
        bend(robot, 0.05)
        angles = []
        for _ in range(1200):
            robot.step()
            angles.append(robot.flexure_angles.mean())
    fast = np.diff(angles, 2)  # takes the slow breathing that comes with it down to a thirtieth
    rises = np.flatnonzero((fast[:-1] < 0) & (fast[1:] >= 0))
    peaks = np.array([fast[a:b].max() for a, b in pairwise(rises)])
    ratio = np.log(peaks[0] / peaks[6]) / 6 / (2 * np.pi)
    assert ratio == pytest.approx(expected, rel=0.03)


def test_turning_the_start_turns_the_motion():
    design, turn = flexible_design(), Rotation.from_rotvec([0.4, -1.1, 0.7])

    def centres(rotation):
        with TensegrityRobot(design, dt=2e-3, ground=False) as robot:
            robot.reset_rotated(rotation)
            robot.command(0.5 * robot.command_limit)
            robot.step(300)
            x = robot.poses_in_world[:, :3]
            return x - robot.centre_of_mass_in_world()

    np.testing.assert_allclose(centres(turn), turn.apply(centres(Rotation.identity())), atol=1e-9)


def test_stands_on_every_face_with_its_flexures_unloaded_by_their_stops():
    with TensegrityRobot(flexible_design(), dt=2e-3) as robot:
        for face, triangle in enumerate(robot.faces.triangles):
            robot.reset(face)
            robot.step(3000)
            assert np.abs(robot.rates).max() < 0.02
            assert robot.foot_contacts()[triangle].all()
            assert (robot.flexure_margins() > 0.8).all()
            energies = robot.energies()
            assert energies.kinetic < 1e-4 and energies.elastic > robot.flexure_energy() >= 0


def test_stops_hold_a_rod_that_a_blow_bends():
    with TensegrityRobot(free(), ground=False) as robot:
        bend(robot, 60.0)
        bent = 0.0
        for _ in range(300):
            robot.step()
            bent = max(bent, float(np.abs(robot.flexure_angles).max()))
    assert LOOSE.max_angle < bent < LOOSE.max_angle + 60 * robot.dt


def test_a_payload_hangs_in_flexible_rods():
    with TensegrityRobot(flexible_design().with_(payload=Payload()), dt=2e-3) as robot:
        robot.step(1500)
        assert robot.tensions.min() >= 0 and np.abs(robot.rates).max() < 0.02
        assert len(robot.tensions) == 24 + 6 + 6


@pytest.mark.parametrize("hinge", ["x-hinge", "trls2", "tfch", "cross-spring"])
def test_other_hinges_make_rods(hinge):
    design = RobotDesign(flexure=RodFlexure(hinge=hinge, thickness=1.5e-3, max_angle=0.15))
    with TensegrityRobot(design, dt=2e-3) as robot:
        robot.step(500)
        assert (robot.flexure_margins() > 0.5).all()
