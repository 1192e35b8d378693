"""Verdicts on whether a robot stands: against what its own simulation does, and unchanged by what cannot matter."""

from dataclasses import replace
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import tensegym
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict, load_design
from tensegym.errors import DesignError
from tensegym.robot.fallen import has_fallen, hull_volume
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.settling import alike, displacement, resting_faces, robot_for
from tensegym.robot.standing import standing_verdict
from tensegym.tasks import as_task, rollout
from tests.design.prisms import prism

FALLS = Path(__file__).parents[1] / "design" / "cases" / "prism4_sags.toml"


def heavy_prism(pretension=1.0, scale=1.0):
    """Three heavy rods that fall at 1 N; every force and mass times ``scale``."""
    return design_from_dict(prism(
        3, 0.3, 0.3, 0.0, spin_damping=1e-4 * scale, passive_rod={"end_mass": 0.6 * scale, "tube_mass": 0.03 * scale},
        elastic_cable={"pretension": pretension * scale, "stiffness": 300.0 * scale, "damping": 5.0 * scale},
    ))  # fmt: skip


def falls_somewhere(design):
    """Let go on every face at 1 ms for 3 s."""
    with TensegrityRobot(design, dt=1e-3) as robot:
        fell = []
        for face in resting_faces(robot):
            robot.reset(face)
            robot.step(3000)
            fell.append(has_fallen(robot))
        return any(fell)


def test_a_robot_falls_below_its_least_pretension_and_stands_above():
    verdict = standing_verdict(heavy_prism())
    assert verdict.kind == "falls"
    least = verdict.holding.least
    assert least > 1.0
    assert f"stands from a pretension of {least:.3g} N on" in verdict.text
    assert falls_somewhere(heavy_prism(0.85 * least))
    assert not falls_somewhere(heavy_prism(1.05 * least))


def test_a_robot_that_would_stand_if_loaded_slowly_falls_as_it_is_let_go():
    """What statics do not see: below its least pretension the prism overshoots and does not come back."""
    design = heavy_prism(0.8 * standing_verdict(heavy_prism()).holding.least)
    with TensegrityRobot(design, dt=1e-3) as robot:
        face = robot.faces.names().index("1-2-3")
        for loads in (np.linspace(0.01, 1, 100), np.ones(100)):
            robot.reset(face)
            for load in loads:
                robot.world.set_gravity([0, 0, -load * design.gravity])
                robot.step(40)
            assert has_fallen(robot) == (loads[0] == 1)


def test_where_no_pretension_does_the_stiffness_that_would_is_told():
    design = load_design(FALLS)
    verdict = tensegym.standing_verdict(design)
    holding, cable = verdict.holding, design.elastic_cable
    assert verdict.falls_everywhere
    assert holding.least is None
    assert set(holding.never) == {name for face in verdict.faces for name in face.names}
    assert holding.highest < cable.stiffness * design.standing.lengths(design.standing.cables).min()
    assert f"{holding.highest:.3g} N" in verdict.text
    stiffer = design.with_(elastic_cable=replace(cable, pretension=holding.highest, stiffness=holding.stiffer))
    assert not falls_somewhere(stiffer)


@settings(max_examples=4, deadline=None)
@given(scale=st.floats(0.2, 5.0), pretension=st.sampled_from([1.0, 30.0]))
def test_masses_and_forces_scaled_alike_change_no_verdict(scale, pretension):
    one, other = (standing_verdict(heavy_prism(pretension, s), pretension=False) for s in (1.0, scale))
    assert one.kind == other.kind
    for here, there in zip(one.faces, other.faces, strict=True):
        assert here.volume == pytest.approx(there.volume, abs=0.02)


def test_how_the_nodes_are_turned_changes_no_verdict():
    design = heavy_prism(30.0)
    turn = Rotation.random(rng=3).as_matrix()
    turned = design.with_(structure=design.structure.with_nodes(design.structure.nodes @ turn.T))
    here, there = (standing_verdict(d, pretension=False) for d in (design, turned))
    assert here.kind == there.kind == "stands"
    assert max(f.sag for f in here.faces) == pytest.approx(max(f.sag for f in there.faces), abs=0.01 * design.length)


def test_the_shipped_robot_stands_and_faces_that_are_alike_are_tried_once():
    with robot_for(RobotDesign()) as robot:
        groups = alike(robot)
    assert sorted(map(len, groups)) == [1, 1, 3, 3, 3, 3, 3, 3]  # a threefold axis through the middles of two faces
    verdict = standing_verdict(RobotDesign(), pretension=False)
    assert verdict.kind == "stands"
    assert verdict.holding is None
    assert sorted(face.names for face in verdict.faces) == sorted(groups)


def test_no_face_without_the_centre_of_mass_above_it_is_tried():
    """A prism of five rods is too low to lie on a side, and lies on its ends in the middle of their three triangles."""
    with robot_for(design_from_dict(prism(5, 0.3, 0.3, np.radians(54)))) as robot:
        tried = [set(robot.faces.triangles[face].tolist()) for face in resting_faces(robot)]
    assert len(tried) == 2
    for corners in tried:
        assert corners < {0, 1, 2, 3, 4} or corners < {5, 6, 7, 8, 9}


def test_time_steps_at_which_forces_are_explicit_are_taken():
    design = RobotDesign()
    for damping in (5.0, 150.0, 1e4):
        with robot_for(design.with_(elastic_cable=replace(design.elastic_cable, damping=damping))) as robot:
            assert not robot.implicit
            assert robot.dt >= 1e-3


def test_volumes_and_displacements():
    cube = np.array([[x, y, z] for x in (0, 2) for y in (0, 2) for z in (0, 2)], dtype=float)
    assert hull_volume(cube) == pytest.approx(8)
    assert hull_volume(cube * [1, 1, 0]) == 0
    assert np.isnan(hull_volume(np.full((8, 3), np.nan)))
    moved = cube @ Rotation.from_rotvec([0.3, 1, 2]).as_matrix() + [5, 6, 7]
    assert displacement(cube, moved) == pytest.approx(0, abs=1e-9)
    assert displacement(cube - 1, (cube - 1) * 1.1) == pytest.approx(0.1 * np.sqrt(3))


class Idle:
    """Lets all cables out."""

    period = 0.4

    def begin(self, robot, seed):
        pass

    def angles(self, robot, direction):
        return np.zeros(len(robot.drives))


def test_an_episode_that_ends_flat_does_not_count():
    task = as_task({"motion": "roll", "seconds": 2.0})
    with TensegrityRobot(load_design(FALLS), dt=task.dt) as robot:
        result = rollout(robot, Idle(), task, 0)
    assert result.fallen
    assert not result.sound
    assert result.scores()["speed"] == result.scores()["tips"] == 0


def test_an_environment_warns_of_a_robot_that_fell_once():
    env = gym.make("tensegym/SixRodRolling-v0", design=str(FALLS), settle=2.0)
    with pytest.warns(UserWarning, match="'quad' has fallen flat") as told:
        for seed in range(3):
            env.reset(seed=seed)
    assert len([one for one in told if "fallen" in str(one.message)]) == 1
    env.close()


@pytest.mark.parametrize("dt", [1e-3, 2e-3])
def test_spin_damping_over_what_the_time_step_holds_is_refused(dt):
    """The spin obeys w' = -(c / I) w explicitly: stable for dt c / I below 2, less what the cables' pull adds."""
    edge = 2 * RobotDesign().passive_rod.axial_inertia / dt
    with pytest.raises(DesignError, match=r"spin_damping.*rod.*below"):
        TensegrityRobot(RobotDesign(spin_damping=edge), dt=dt)
    with TensegrityRobot(RobotDesign(spin_damping=0.9 * edge), dt=dt) as robot:
        robot.step(1000)
        assert np.abs(robot.velocities_in_world()[:, 3:]).max() < 1.0
