"""A user's URDF: what it means is kept, or one line names what cannot be; the engine writes nothing past Python."""

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from tensegym.bullet import Articulated, Client
from tensegym.errors import FlexureError, SimulationError
from tensegym.flexible import FlexibleRobot, FlexureJoint
from tensegym.flexure import Box
from tensegym.flexure.models import TorsionSpring

CASES = Path(__file__).parent / "cases"
PLAIN = (CASES / "plain.urdf").read_text()
STIFFNESS, LENGTH, FRACTION = 0.135979, 0.04, 0.78  # N m/rad; the pin stands on the URDF's axis
MASS, REACH, ALONG, ACROSS = 0.05, 0.1, 1e-5, 2e-5  # of the arm: kg, m, kg m^2 about its centre


def period(urdf):
    """Of the arm on its hinge [s], a pin with a spring on the URDF's axis, without weight."""
    with FlexibleRobot(urdf, dt=5e-4, gravity=(0, 0, 0), fixed_base=True) as robot:
        spring = TorsionSpring(LENGTH, FRACTION, STIFFNESS)
        FlexureJoint(robot, "knee", spring, box=Box(0.5, 5.0), centre=1 - FRACTION)
        robot.place({"knee": 0.02})
        theta = []
        for _ in range(1800):
            robot.step()
            theta.append(robot.positions[robot.joints["knee"]])
    theta = np.array(theta)
    i = np.flatnonzero((theta[:-1] > 0) & (theta[1:] <= 0))
    zeros = i + theta[i] / (theta[i] - theta[i + 1])
    return 5e-4 * float(np.diff(zeros).mean())


def changed(tmp_path, old, new):
    assert old in PLAIN
    path = tmp_path / "changed.urdf"
    path.write_text(PLAIN.replace(old, new))
    return path


@pytest.mark.parametrize("name", ["plain", "tool0", "world"])
def test_links_without_inertial_weigh_nothing(name):
    exact = 2 * math.pi * math.sqrt((ACROSS + MASS * REACH**2) / STIFFNESS)
    assert exact == pytest.approx(0.38855, abs=1e-5)
    assert period(CASES / f"{name}.urdf") == pytest.approx(exact, rel=1e-4)


def test_along_is_chosen_across_an_oblique_axis():
    lever = REACH**2 * (1 - 1 / 3)
    exact = 2 * math.pi * math.sqrt(((ALONG + 2 * ACROSS) / 3 + MASS * lever) / STIFFNESS)
    assert period(CASES / "axisob.urdf") == pytest.approx(exact, rel=1e-4)


def test_the_length_of_an_axis_means_nothing(tmp_path):
    slide = changed(tmp_path, 'type="revolute"', 'type="prismatic"').read_text()
    for length in (1, 2):
        path = tmp_path / "slide.urdf"
        path.write_text(slide.replace('xyz="0 0 1"', f'xyz="0 0 {length}"'))
        with FlexibleRobot(path, fixed_base=True) as robot:
            robot.torques[:] = MASS * 9.81 + 0.02
            robot.place()
            robot.step(500)
            assert robot.positions[0] == pytest.approx(0.5 * (0.02 / MASS) * 0.5**2, rel=1e-3)


def shapes(body):
    from tensegym.bullet.engine import pybullet

    return [len(pybullet.getCollisionShapeData(body.body, i, physicsClientId=body.client)) for i in (-1, 0)]


@pytest.mark.parametrize("name", ["rel", "package", "model"])
def test_meshes_are_found_wherever_they_are_named(name):
    with FlexibleRobot(CASES / "pkg" / "arm_description" / "urdf" / f"{name}.urdf") as robot:
        assert shapes(robot.body) == [0, 1]


def test_meshes_by_address_by_full_path_and_in_a_ros_package(tmp_path, monkeypatch):
    text = (CASES / "pkg" / "arm_description" / "urdf" / "rel.urdf").read_text()
    mesh = CASES / "pkg" / "arm_description" / "meshes" / "box.obj"
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(CASES / "pkg"))
    for name in (mesh.as_uri(), str(mesh), "package://arm_description/meshes/box.obj"):
        path = tmp_path / "a.urdf"
        path.write_text(text.replace("../meshes/box.obj", name))
        with FlexibleRobot(path) as robot:
            assert shapes(robot.body) == [0, 1]


def test_a_missing_mesh_is_named():
    path = CASES / "pkg" / "arm_description" / "urdf" / "missing.urdf"
    with pytest.raises(FlexureError, match=r"missing.urdf: link 'arm': no mesh file '../meshes/nope.obj'"):
        FlexibleRobot(path)


def test_a_massless_root_needs_a_fixed_base():
    with pytest.raises(FlexureError, match=r"base link 'world' has no mass, .* take fixed_base=True"):
        FlexibleRobot(CASES / "world.urdf")


def test_xacro_left_overs_name_joint_and_attribute():
    with pytest.raises(FlexureError, match=r"joint 'knee': <origin> xyz = '0 0 \$\{h\}' holds a xacro expression"):
        FlexibleRobot(CASES / "xacro.urdf")


INERTIA = '<inertia ixx="1e-5" iyy="2e-5" izz="2e-5" ixy="0" ixz="0" iyz="0"/>'


@pytest.mark.parametrize(("old", "new", "words"), [
    ("<link ", '<xacro:include filename="x"/><link ', "xml"),
    ('type="revolute"', 'type="floating"', "joint 'knee': type = 'floating'; one of revolute"),
    ('xyz="0 0 1"', 'xyz="0 0 0"', "joint 'knee': <axis> xyz = '0 0 0' has no direction"),
    ('xyz="0 0 1"', 'xyz="0 1"', "<axis> xyz = '0 1'; give 3 finite numbers"),
    ('xyz="0 0 0.2"', 'xyz="0 0 nan"', "joint 'knee': <origin> xyz = '0 0 nan'"),
    (INERTIA, "", "link 'arm': <inertial> has no <inertia>"),
    (INERTIA, INERTIA.replace("1e-5", "abc"), "link 'arm': <inertia> ixx = 'abc'; give a finite number"),
    (INERTIA, INERTIA.replace("1e-5", "9e-5"), "no body has the principal moments 2e-05, 2e-05, 9e-05"),
    ('value="0.05"', 'value="-0.05"', "mass = -0.05 kg"),
    ('child link="arm"', 'child link="leg"', "joint 'knee': its child 'leg' is no link"),
    ('link name="arm"', 'link name="base"', "link 'base' is there twice"),
    ('<limit lower="-0.6" upper="0.6" effort="10" velocity="10"/>', "", "'knee' is revolute without a limit"),
    ("</robot>", '<link name="spare"/></robot>', "one link that is no joint's child; here are 2: base, spare"),
    ("</robot>", '<link name="end"/><joint name="wrist" type="continuous"><parent link="arm"/><child link="end"/>'
     "</joint></robot>", "joint 'wrist' moves nothing that has a mass"),
])  # fmt: skip
def test_what_cannot_be_is_refused_in_one_line(old, new, words, tmp_path):
    with pytest.raises(FlexureError) as caught:
        FlexibleRobot(changed(tmp_path, old, new), fixed_base=True)
    assert words in str(caught.value).lower() if words == "xml" else words in str(caught.value)
    assert "changed.urdf" in str(caught.value) and "\n" not in str(caught.value) and len(str(caught.value)) < 300


@pytest.mark.parametrize(("new", "words"), [
    ('<dynamics damping="0" friction="0.2"/></joint>', "joint 'knee': friction = 0.2 is not simulated"),
    ('<mimic joint="x"/></joint>', "joint 'knee': <mimic> is not kept"),
])  # fmt: skip
def test_what_is_not_simulated_is_said(new, words, tmp_path):
    with pytest.warns(UserWarning, match=words):
        FlexibleRobot(changed(tmp_path, "</joint>", new)).close()


def test_the_damping_of_a_joint_is_kept_until_a_flexure_takes_its_place(tmp_path):
    path = changed(tmp_path, "</joint>", '<dynamics damping="0.01"/></joint>')
    with warnings.catch_warnings(), FlexibleRobot(path, gravity=(0, 0, 0), fixed_base=True, dt=1e-3) as robot:
        warnings.simplefilter("error")
        robot.place(rates={"knee": 1.0})
        robot.step(100)
        rate = math.exp(-0.01 * 0.1 / (ACROSS + MASS * REACH**2))
        assert robot.velocities[0] == pytest.approx(rate, rel=0.02)
        with pytest.warns(UserWarning, match="its damping = 0.01 goes with it; a flexure's is loss_time"):
            FlexureJoint(robot, "knee", TorsionSpring(0.04, 0.8, 0.1), box=Box(0.5, 5.0))


@pytest.mark.parametrize("turned", ["0 0 0", "0.3 0.4 0.5"])
def test_the_inertia_of_a_flat_body_stays_what_it_is(turned, tmp_path):
    """The engine makes an inertia zero that rounding puts a hair over what a body can have."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_euler("xyz", [float(v) for v in turned.split()]).as_matrix()
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = turn @ np.diag([1e-5, 3e-5, 4e-5 * (1 + 1e-12)]) @ turn.T
    flat = f'<inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="{xy!r}" ixz="{xz!r}" iyz="{yz!r}"/>'.replace(
        "np.float64(", "").replace(")", "")  # fmt: skip
    with FlexibleRobot(changed(tmp_path, INERTIA, flat)) as robot:
        assert robot.body.said == ""
        assert sorted(robot.body.inertias()[1][1]) == pytest.approx([1e-5, 3e-5, 4e-5], rel=1e-8)


def test_the_engine_writes_nothing_past_python(capfd, tmp_path):
    world, pose = Client(1e-3, 0.0), (0, 0, 0, 0, 0, 0, 1)
    body = Articulated(world, CASES / "tool0.urdf", pose, 0.5, False)
    assert "No inertial data for link" in body.said and "tool0" in body.said and "\n" not in body.said
    with pytest.raises(SimulationError, match=r"PyBullet cannot load missing.urdf: .*nope.obj"):
        Articulated(world, CASES / "pkg" / "arm_description" / "urdf" / "missing.urdf", pose, 0.5, False)
    print("mine")
    world.close()
    FlexibleRobot(CASES / "tool0.urdf").close()
    assert capfd.readouterr() == ("mine\n", "")


@pytest.mark.parametrize("content", [b"", b"<robot", b"\xff\xfe\x00", b"<robot>" * 3000, b"<sdf/>"])
def test_what_is_no_urdf(content, tmp_path):
    path = tmp_path / "no.urdf"
    path.write_bytes(content)
    with pytest.raises(FlexureError, match=r"no.urdf( is no|: elements)"):
        FlexibleRobot(path)
