"""The open-loop walker as a task's controller; the pattern generator's own tests are in test_evaluate.py."""

import numpy as np
import pytest

from tensegym.control.bearing import Bearing
from tensegym.control.table import make_controller, with_defaults
from tensegym.control.tipping import Pull, Tip
from tensegym.control.walker import Walker, WalkerSettings
from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError, InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.search.evaluate import run_trial, try_all
from tensegym.search.loop import _trial

PLAYED = 'kind = "walker"\ndepth = 0.9'
AHEAD = Bearing(np.array([1.0, 0.0]))


@pytest.fixture
def walking(tiny):
    """Changes of the tiny search that make the walker its controller."""

    def make(*changes: tuple[str, str]):
        return tiny(("amplitudes = [0.5, 0.5]", PLAYED),
                    ('"controller.lags" = {low = -1.0, high = 1.0}', '"controller.depth" = {low = 0.5, high = 1.0}'),
                    *changes)  # fmt: skip

    return make


def test_depths_are_parts_of_this_designs_deepest_pull():
    design = RobotDesign().with_(stiff_cable=RobotDesign().stiff_cable.__class__(max_pull=0.6))
    settings = WalkerSettings(depth=0.5, pull_time=0.4, release_time=0.3)
    table = [Tip(Pull((0, 5), depth), 19, 0, (1.0, 0.0), 1.0) for depth in (0.2, 0.4)]
    with TensegrityRobot(design, dt=4e-3) as robot:
        robot.reset(19)
        walker = Walker(table[1:], settings)
        walker.begin(robot)
        commands = []
        for _ in range(7):
            commands.append(walker.angles(robot, AHEAD) / robot.command_limit)
            robot.step(round(walker.period / robot.dt))
        shallow = Walker([table[0], Tip(Pull((1,), 0.4), 19, 19, (0.0, 0.0), 1.0)], settings)
        robot.reset(19)
        shallow.begin(robot)
        partly = shallow.angles(robot, AHEAD) / robot.command_limit
    np.testing.assert_allclose(commands, [[0.5, 0, 0, 0, 0, 0.5]] * 4 + [[0] * 6] * 3, atol=1e-12)
    np.testing.assert_allclose(partly, [0.25, 0, 0, 0, 0, 0.25], atol=1e-12)


def test_the_walker_rolls_along_the_wanted_direction(walking):
    problem = walking(("seconds = 0.8", "seconds = 10.0"))
    trial = _trial(problem, 0, 0, problem.space.start, np.inf)
    speeds = [e["speed_lps"] for e in try_all(trial).episodes]
    assert min(speeds) > 0 and np.mean(speeds) > 0.04
    outcome = run_trial(trial)
    assert outcome.refused is None and outcome.metrics["sound"] == 1.0


def test_a_searched_depth_reaches_the_walker(walking):
    space = walking().space
    assert space.start["controller.depth"] == 0.9
    assert space.apply(space.start | {"controller.depth": 0.6})["controller"] == {"kind": "walker", "depth": 0.6}


def test_every_field_has_its_default():
    assert with_defaults({"kind": "walker"}) == {
        "kind": "walker", "depth": 1.0, "pull_time": 2.0, "release_time": 1.6
    }  # fmt: skip
    assert with_defaults({})["kind"] == with_defaults({"kind": "cpg"})["kind"] == "cpg"


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"kind": "runner"}, "kind = 'runner' is not one of cpg, walker, planner, stepper, policy, random"),
        ({"kind": "walker", "gain": 1.0}, "unknown field 'gain' in controller; one of depth, pull_time, release_time"),
        ({"depth": 1.0}, "unknown field 'depth' in controller"),
        ({"kind": "walker", "depth": 1.2}, r"controller.depth = 1.2 is outside \(0, 1\]"),
        ({"kind": "walker", "pull_time": 0}, r"controller.pull_time = 0 is outside \[0.1, 60\] s"),
    ],
)
def test_bad_controllers_are_refused(table, words):
    with pytest.raises(DesignError, match=words):
        with_defaults(table)


def test_a_bad_walker_is_refused_with_the_task_file(walking):
    with pytest.raises(InputError, match=r"tiny: .*controller\.release_time = -1 is outside"):
        walking((PLAYED, 'kind = "walker"\nrelease_time = -1'))


def test_a_robot_that_the_table_is_not_of_is_refused():
    design = RobotDesign()
    fewer = design.structure.__class__(
        design.structure.nodes, design.structure.rods, design.structure.cables, design.structure.stiff_cables[:5]
    )
    with (
        TensegrityRobot(design.with_(structure=fewer), dt=4e-3) as robot,
        pytest.raises(DesignError, match="6 drives, this one has 5; make its own"),
    ):
        make_controller({"kind": "walker"}).begin(robot, 0)
