"""The robot's three rotations: in the simulation, in the observation, in the policy."""

import numpy as np
import pytest
import torch
from scipy.spatial.transform import Rotation

from tensegym.design.design import Payload, RobotDesign
from tensegym.design.symmetry import symmetries
from tensegym.envs.rolling import RollingEnv
from tensegym.robot.reading import read
from tensegym.robot.robot import TensegrityRobot
from tensegym.train.symmetric_policy import SymmetricPolicy, symmetry_arguments

GROUP = symmetries(RobotDesign())
START = Rotation.from_euler("xyz", [0.4, -1.0, 2.0])
DESIGNS = {"bare": RobotDesign(), "payload": RobotDesign(payload=Payload())}
ELEMENTS = pytest.mark.parametrize("element", range(3))
KINDS = pytest.mark.parametrize("kind", ["full", "onboard"])


def image(g, action):
    """What the relabelled robot's drives must do to do the same."""
    out = np.empty_like(action)
    out[g.drives] = action
    return out


def test_the_group_has_the_order_three_the_drives_leave():
    assert len(GROUP) == 3
    angles = sorted(np.degrees(Rotation.from_matrix(g.rotation).magnitude()) for g in GROUP)
    np.testing.assert_allclose(angles, [0, 120, 120], atol=1e-9)
    tables = [tuple(g.nodes) for g in GROUP]
    for g in GROUP:
        for h in GROUP:
            assert tuple(g.nodes[h.nodes]) in tables


@ELEMENTS
@pytest.mark.parametrize(("design", "ground"), [("bare", False), ("bare", True), ("payload", False)])
def test_the_relabelled_robot_moves_as_the_first(element, design, ground):
    """Turned by a symmetry and driven by the permuted commands, it is the same robot under other names."""
    commands = np.random.default_rng(0).uniform(0, 1, (4, 6))
    with TensegrityRobot(DESIGNS[design], ground=ground) as robot:
        group, runs = symmetries(robot.design), []
        for g in (group[0], group[element]):
            robot.reset_rotated(START * Rotation.from_matrix(g.rotation).inv())
            motion = []
            for command in commands:
                robot.command(image(g, command) * robot.command_limit)
                robot.step(150)
                nodes = robot.node_positions_in_world()[g.nodes] - [*robot.centre_of_mass_in_world()[:2], 0]
                motion.append(np.concatenate([nodes.ravel(), robot.tensions[g.cables], robot.drives[g.drives].ravel()]))
            runs.append(np.array(motion))
    np.testing.assert_allclose(runs[1], runs[0], atol=1e-7)
    assert np.ptp(runs[0], axis=0).max() > 1


@ELEMENTS
@KINDS
@pytest.mark.parametrize("design", DESIGNS)
def test_the_observation_of_the_relabelled_robot_is_the_permuted_one(element, kind, design):
    # Explicit forces, as the implicit solve's rounding depends on the cables' order; and short with a payload, whose
    # ball soon touches rods on the ground, and the engine's contacts know an order too.
    steps = 1 if design == "payload" else 8
    with RollingEnv(DESIGNS[design], observation=kind, dt=1e-3) as env:
        arguments = symmetry_arguments(env)
        index, sign = (np.array(arguments[f"observation_{part}"][element]) for part in ("index", "sign"))
        g = symmetries(env.robot.design)[element]
        env.reset(seed=0)
        seen = []
        for h in (GROUP[0], g):
            env.robot.reset_rotated(START * Rotation.from_matrix(h.rotation).inv())
            row = [env.observation.values(env.robot, read(env.robot), env.episode.bearing)]
            for action in np.random.default_rng(1).uniform(-1, 1, (steps, 6)):
                env.robot.command((image(h, action) + 1) / 2 * env.robot.command_limit)
                env.robot.step(150)
                row.append(env.observation.values(env.robot, read(env.robot), env.episode.bearing))
            seen.append(np.array(row))
        np.testing.assert_allclose(seen[1], sign * seen[0][:, index], atol=1e-7)
        if element:
            assert np.abs(seen[1] - seen[0]).max() > 0.1  # the permutation is not an idle one


@ELEMENTS
@KINDS
def test_the_policys_action_turns_with_the_robot_and_its_value_does_not(element, kind):
    with RollingEnv(observation=kind) as env:
        arguments = symmetry_arguments(env)
        torch.manual_seed(0)
        policy = SymmetricPolicy(env.observation_space, env.action_space, lambda _: 1e-3, hidden=[16, 16], **arguments)
        with torch.no_grad():
            for parameter in policy.mlp_extractor.parameters():
                parameter.copy_(0.5 * torch.randn_like(parameter))
        g = symmetries(env.robot.design)[element]
        seen = torch.randn(20, env.observation_space.shape[0])
        turned = torch.tensor(arguments["observation_sign"][element]) * seen[:, arguments["observation_index"][element]]
        with torch.no_grad():
            action, value, _ = policy(seen, deterministic=True)
            action_there, value_there, _ = policy(turned, deterministic=True)
        wanted = np.stack([image(g, row) for row in action.numpy()])
        np.testing.assert_allclose(action_there.numpy(), wanted, atol=2e-6)
        np.testing.assert_allclose(value_there.numpy(), value.numpy(), atol=2e-6)
        assert np.abs(action.numpy()).max() > 0.1
        if element:
            assert np.abs(action_there.numpy() - action.numpy()).max() > 0.1


def test_a_design_without_symmetry_has_the_identity_alone():
    structure = RobotDesign().structure
    lopsided = RobotDesign(structure=type(structure)(structure.nodes, structure.rods, structure.cables,
                                                     structure.stiff_cables[:5]))  # fmt: skip
    assert len(symmetries(lopsided)) == 1
