import multiprocessing

import numpy as np
import pybullet
import pytest
from scipy.spatial.transform import Rotation

from tensegym.bullet import packaged_urdf
from tensegym.design.design import Payload, RobotDesign, paper_design
from tensegym.design.design_file import design_from_dict
from tensegym.design.urdf_writer import urdf_files
from tensegym.errors import DesignError, SimulationError
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.start_poses import start_at
from tensegym.structure.faces import resting_height

PRISM = {
    "name": "prism",
    "structure": {
        "nodes": [[0.3, 0, 0], [-0.15, 0.26, 0], [-0.15, -0.26, 0],
                  [-0.26, 0.15, 0.5], [0, -0.3, 0.5], [0.26, 0.15, 0.5]],
        "rods": [[1, 4], [2, 5], [3, 6]],
        "cables": [[1, 2], [2, 3], [3, 1], [4, 5], [5, 6], [6, 4], [1, 6], [2, 4], [3, 5]],
        "stiff_cables": [[1, 5], [2, 6]],
    },
}  # fmt: skip


def test_committed_urdfs_are_what_the_default_design_writes():
    for name, text in urdf_files(RobotDesign(payload=Payload())).items():
        path = packaged_urdf(name)
        assert path is not None, name
        assert path.read_text() == text


def test_bodies_have_the_designs_mass_and_inertia():
    with TensegrityRobot(RobotDesign(payload=Payload())) as robot:
        for row, body in enumerate(robot.world.body_ids):
            info = pybullet.getDynamicsInfo(body, -1, physicsClientId=robot.world.client)
            assert info[0] == pytest.approx(robot.model.masses[row])
            np.testing.assert_allclose(info[2], robot.model.inertias[row], rtol=1e-12)
        assert sum(robot.model.masses) == pytest.approx(1.698 + 0.5)


@pytest.mark.parametrize("face", range(0, 20, 4))
def test_stands_on_a_face_at_a_heading(face):
    with TensegrityRobot() as robot:
        robot.reset(face, 1.0)
        robot.step(1500)
        down = robot.foot_contacts().nonzero()[0]
        assert sorted(down) == sorted(robot.faces.triangles[face])
        structure, masses = robot.design.standing, robot.model.masses
        centre = masses @ structure.nodes[structure.rods].mean(axis=1) / masses.sum()
        rigid = resting_height(structure.nodes, robot.faces.triangles[face], centre) + 0.004
        assert rigid - 0.05 < robot.centre_of_mass_in_world()[2] < rigid  # the cables give a little under the weight
        assert robot.tensions[:24].min() > 3


def test_papers_two_poses():
    with TensegrityRobot(paper_design(), dt=5e-4) as robot:
        start_at(robot, "paper-1")
        nodes = robot.node_positions_in_world()
        assert nodes[:, 2].min() == pytest.approx(0.004)
        start_at(robot, "paper-2")
        assert sorted(np.argsort(robot.node_positions_in_world()[:, 2])[:3] + 1) == [3, 5, 12]


def test_weight_is_carried_at_rest():
    """The rest height gives the elastic energy back: nothing pushes but the ground."""
    with TensegrityRobot(RobotDesign(spin_damping=1e-3)) as robot:
        robot.reset(0)
        robot.step(4000)
        normal = sum(contact.push for contact in robot.world.contacts())
        assert normal == pytest.approx(robot.design.mass * 9.81, rel=0.05)


def test_a_prism_from_plain_data_stands_and_is_driven():
    with TensegrityRobot(design_from_dict(PRISM)) as robot:
        robot.reset(0)
        robot.step(1500)
        assert robot.foot_contacts().sum() == 3
        assert robot.tensions[:9].min() > 5
        before = robot.node_positions_in_world()
        robot.command(0.5 * robot.command_limit)
        robot.step(1000)
        assert robot.tensions[9:].max() > 1
        assert np.abs(robot.node_positions_in_world() - before).max() > 0.01


def test_payload_hangs_on_pulling_cables():
    with TensegrityRobot(RobotDesign(payload=Payload())) as robot:
        assert len(robot.tensions) == 36
        robot.reset(0)
        robot.step(2000)
        assert robot.tensions[30:].max() > 1
        offset = robot.poses_in_world[6, :3] - robot.centre_of_mass_in_world()
        assert np.linalg.norm(offset) < 0.1


def test_drives_work_is_the_energy_gained_in_free_flight_without_damping():
    """Elastic and kinetic energy rise by what the drives put in, to the order of the step."""
    from tensegym.design.design import ElasticCable, StiffCable

    design = RobotDesign(elastic_cable=ElasticCable(damping=0), stiff_cable=StiffCable(damping=0), spin_damping=0)
    errors = []
    for dt in (1e-3, 5e-4):
        with TensegrityRobot(design, dt=dt, ground=False) as robot:
            start = robot.energies().total
            robot.command(0.3 * robot.command_limit)
            robot.step(round(0.5 / dt))
            work = robot.totals().drive_work
            errors.append(abs(robot.energies().total - start - work) / work)
    assert errors[0] < 0.01
    assert errors[1] < 0.7 * errors[0]


def test_reset_repeats_bitwise_after_any_history():
    def rollout(robot):
        robot.reset(3, 0.3)
        for k in range(10):
            robot.command((k % 3) / 3 * robot.command_limit)
            robot.step(50)
        return robot.poses_in_world.copy()

    with TensegrityRobot() as robot, TensegrityRobot() as other:
        first = rollout(robot)
        robot.reset(9, 2.0)
        robot.command(robot.command_limit)
        robot.step(300)
        np.testing.assert_array_equal(rollout(robot), first)
        np.testing.assert_array_equal(rollout(other), first)


def test_rotating_the_start_rotates_the_flight():
    with TensegrityRobot(ground=False) as robot:
        turn = Rotation.from_euler("xyz", [0.4, -1.0, 2.0])
        paths = []
        for start in (Rotation.identity(), turn):
            robot.reset_rotated(start)
            centre = robot.centre_of_mass_in_world()
            robot.command(np.array([0.4, 0, 0.2, 0, 0.1, 0]) * robot.command_limit)
            robot.step(800)
            paths.append(robot.node_positions_in_world() - centre)
        np.testing.assert_allclose(paths[1], turn.apply(paths[0]), atol=1e-6)


def test_divergence_is_an_error_not_a_nan():
    with TensegrityRobot(dt=1.4e-3) as robot:
        robot.drives[:, 1] = 1e7  # a rotor angle no drive reaches
        robot.natural_lengths[24:] = -1e4
        with pytest.raises(SimulationError, match="diverged at t = "):
            robot.step(200)


def test_bad_arguments_are_refused():
    with pytest.raises(DesignError, match=r"dt = 0.1 is outside"):
        TensegrityRobot(dt=0.1)
    with TensegrityRobot() as robot, pytest.raises(DesignError, match=r"face = 20 is outside 0\.\.19"):
        robot.reset(20)


def test_a_window_without_a_display_is_refused(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(SimulationError, match="no display"):
        TensegrityRobot(gui=True)


def _open_and_close(count):
    import resource

    with TensegrityRobot() as robot:
        robot.step(10)
    start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(count):
        with TensegrityRobot() as robot:
            robot.step(1)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - start
    open_clients = sum(pybullet.isConnected(physicsClientId=c) for c in range(200))
    return grown, open_clients


def test_two_hundred_robots_leave_no_client_and_no_memory():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        grown, open_clients = pool.apply(_open_and_close, (200,))
    assert open_clients == 0
    assert grown < 20_000  # kB in all, a hundredth of what 200 open ones hold


def test_from_a_height_it_falls_as_a_stone_does():
    with TensegrityRobot(dt=1e-3) as robot:
        robot.reset(face=2, height=1.0)
        lowest = (robot.node_positions_in_world()[:, 2] - robot.model.foot_radii).min()
        assert lowest == pytest.approx(1.0, abs=1e-12)
        before = robot.centre_of_mass_in_world()
        robot.step(400)
        fallen = robot.centre_of_mass_in_world() - before
        steps = robot.design.gravity * 1e-6 * 400 * 401 / 2  # the sum that the leapfrog makes of g t^2 / 2
        np.testing.assert_allclose(fallen, [0, 0, -steps], atol=1e-9)
