"""A spine of tetrahedra whose rods share nodes: it stands, and vibrates as statics say; that it sags and bends as they
say is among the problems of the validation page."""

import numpy as np
import pytest
from scipy.linalg import eigh

from tensegym.design.design_file import design_from_dict
from tensegym.design.shape import least_stiffness, node_stiffness
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import DesignError, ShapeError
from tensegym.robot.modes import design_modes
from tensegym.robot.standing import standing_verdict
from tensegym.structure.equilibrium import equilibrium_matrix, members
from tensegym.structure.structure import six_rod

SPINE = {"structure": {"builder": "spine", "vertebrae": 2}, "attachment_radius": 0.0}


@pytest.fixture(scope="module")
def spine():
    return design_from_dict(SPINE)


def test_a_spine_stands_on_every_face_it_can(spine):
    verdict = standing_verdict(spine, pretension=False)
    assert verdict.kind == "stands"


def test_its_modes_are_those_of_two_rigid_bodies(spine):
    """Rods' spins about themselves, which nothing holds, take no part."""
    structure = spine.standing
    pairs, nodes, count = members(structure), structure.nodes, len(structure.cables)
    lengths = structure.lengths(pairs)
    density = np.concatenate([spine.rest_tensions, -spine.rod_compressions]) / lengths
    ends = np.zeros((len(pairs), len(nodes)))
    ends[np.arange(len(pairs)), pairs[:, 0]], ends[np.arange(len(pairs)), pairs[:, 1]] = -1.0, 1.0
    unit = equilibrium_matrix(structure)[:, :count] / lengths[:count]
    stiffness = np.kron(ends.T @ (density[:, None] * ends), np.eye(3)) + (unit * (300.0 - density[:count])) @ unit.T
    motion = np.zeros((len(nodes), 3, 12))  # of two rigid bodies about the origin
    for node, (x, y, z) in enumerate(nodes):
        motion[node, :, 6 * (node // 4) : 6 * (node // 4) + 6] = [
            [1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, x], [0, 0, 1, y, -x, 0]]
    mass = np.zeros((12, 12))
    for rod, (a, b) in enumerate(structure.rods):
        kind, length = spine.rod(rod), structure.rod_lengths[rod]
        along = (nodes[b] - nodes[a]) / length
        centre, swing = (motion[a] + motion[b]) / 2, np.cross(along, (motion[b] - motion[a]).T / length)
        mass += kind.mass * centre.T @ centre + kind.transverse_inertia(length) * swing @ swing.T
    flat = motion.reshape(-1, 12)
    wanted = np.sqrt(eigh(flat.T @ stiffness @ flat, mass, eigvals_only=True)[6:]) / (2 * np.pi)
    np.testing.assert_allclose(design_modes(spine).frequencies[-6:], wanted, rtol=1e-5)


def test_stiffness_of_nodes_is_that_of_rods_where_they_share_none():
    for tension in (5.0, 20.0):
        by_nodes, by_rods = (of(six_rod(), tension, 300.0, *more)[0] for of, more in (
            (node_stiffness, ()), (least_stiffness, (0.0,))))  # fmt: skip
        assert by_nodes == pytest.approx(by_rods, rel=1e-9)


def test_an_environment_steps_a_robot_of_shared_nodes():
    """A spine of three, wound by three cables from its first vertebra to its third."""
    design = design_from_dict(SPINE | {"structure": {"builder": "spine", "vertebrae": 2}})
    structure = design.structure
    wound = [(0, 7), (1, 7), (2, 7)]
    design = design.with_(structure=type(structure)(structure.nodes, structure.rods, structure.cables, wound))
    env = RollingEnv(design=design)
    before, _ = env.reset(seed=0)
    after, reward, *_ = env.step(np.ones(3))
    assert env.observation_space.contains(after) and np.isfinite(reward)
    assert not np.array_equal(before, after)
    env.close()


def test_nodes_out_of_balance_are_kept_or_refused():
    """Equal tensions do not hold a spine as it is built; kept, it has those of the closed form."""
    even = SPINE | {"cables": {"tie": {"pretension": 10.0}}}
    with pytest.raises(ShapeError, match=r"node 1 is on more than one rod.*\[keep\] shape = true"):
        design_from_dict(even)
    kept = design_from_dict(even | {"keep": {"shape": True}})
    built = design_from_dict(SPINE)
    ratio = kept.rest_tensions / built.rest_tensions
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)


def test_rods_that_share_nodes_are_not_split():
    with pytest.raises(DesignError, match=r"node 1 is on more than one rod.*cannot be split"):
        design_from_dict(SPINE | {"flexure": {}})
