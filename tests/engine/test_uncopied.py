"""What lives in an engine is not copied, and says so when it is closed."""

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

from tensegym import TensegrityRobot
from tensegym.envs.rolling import RollingEnv
from tensegym.errors import SimulationError
from tensegym.flexible.flexure_file import load_robot
from tensegym.tasks import as_task
from tensegym.tasks.episode import Episode

FLEXURES = sorted((Path(__file__).parents[2] / "urdf").glob("flexure_*.toml"))[0]


@pytest.fixture(params=["robot", "flexible robot", "episode", "closed"])
def living(request):
    robot = load_robot(FLEXURES) if request.param == "flexible robot" else TensegrityRobot(dt=2e-3)
    if request.param == "closed":
        robot.close()
    yield Episode(robot, as_task("roll"), np.random.default_rng(0), {}) if request.param == "episode" else robot
    robot.close()


@pytest.mark.parametrize("how", [copy.copy, copy.deepcopy, pickle.dumps])
def test_what_lives_in_an_engine_is_not_copied(living, how):
    with pytest.raises(SimulationError, match=rf"a {type(living).__name__} is not copied and not pickled"):
        how(living)


@pytest.mark.parametrize("how", [copy.copy, copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_of_an_environment_is_one_of_its_own(how):
    with RollingEnv(observation="onboard", settle=0.0, control_period=0.02) as env:
        first, _ = env.reset(seed=3)
        with how(env) as other:
            np.testing.assert_array_equal(other.reset(seed=3)[0], first)
            there = other.step(np.full(6, 0.5))[0]
        np.testing.assert_array_equal(env.step(np.full(6, 0.5))[0], there)


def test_a_closed_robot_says_so():
    robot, hinged = TensegrityRobot(dt=2e-3), load_robot(FLEXURES)
    for each in (robot, hinged):
        each.close()
        each.close()
    calls = [robot.step, robot.reset, robot.node_positions_in_world, robot.energies, lambda: robot.push((1, 0, 0)),
             hinged.step]  # fmt: skip
    for call in calls:
        with pytest.raises(SimulationError, match="the robot is closed"):
            call()
