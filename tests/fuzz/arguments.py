"""Odd arguments of gymnasium.make and of the first reset; copies and pickles of what is public, in any state."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from tests.fuzz.environment import OPTIONS, SEEDS
from tests.fuzz.mutants import VALUES

SOUND = {
    "design": ["six_rod", "paper", {"payload": {"mass": 0.5}}, "none.toml", {"elastic_cable": {"stiffness": -1}}],
    "observation": ["full", "onboard", "half"],
    "control_period": [0.02, 0.04, 0.0201, 0],
    "dt": [2e-3, 1e-3, 0.0, 1.0],
    "settle": [0.0, 0.1, -1],
    "reward": [{"slip": 0.2}, {"slide": 1}, {"slip": float("nan")}],
    "render_mode": ["rgb_array", "depth"],
    "vary": [{"elastic_cable.stiffness": {"low": 200.0, "high": 800.0}}, {"drive": 3}, "payload_body"],
    "episodes_per_design": [0, 2, -1, True],
    "slope": [5.0, 90.0],
    "task": ["roll", "climb", "fly", {"motion": "roll", "seconds": 1}, "os:system", {"motion": "none.py:Task"}],
    "max_episode_steps": [3, 1],
}
MADE = st.tuples(
    st.lists(st.sampled_from(sorted(SOUND)), max_size=3, unique=True).flatmap(lambda names: st.fixed_dictionaries(
        {name: st.one_of(st.sampled_from(SOUND[name]), st.sampled_from(SOUND[name]), VALUES) for name in names})),
    SEEDS,
    OPTIONS,
)  # fmt: skip
# arguments that gymnasium looks at itself, and what it takes; others it raises of before anything here is asked
ITS_OWN = {
    "max_episode_steps": lambda value: isinstance(value, int) and value > 0,
    "render_mode": lambda value: value is None or isinstance(value, str),
}


def make(given: tuple[dict[str, Any], Any, Any]) -> None:
    """Make an environment, begin an episode, step once."""
    import gymnasium as gym

    arguments, seed, options = given
    arguments = {name: value for name, value in arguments.items() if ITS_OWN.get(name, lambda _: True)(value)}
    arguments = {"settle": 0.0, "control_period": 0.02} | arguments
    env = gym.make("tensegym:tensegym/SixRodRolling-v0", disable_env_checker=True, **arguments)
    try:
        env.reset(seed=seed, options=options)
        env.step(np.zeros(env.action_space.shape, np.float32))
    finally:
        env.close()


# -- copies ------------------------------------------------------------------------------------------------------------

COPIERS: dict[str, Callable[[Any], Any]] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda value: pickle.loads(pickle.dumps(value)),
}
STATES = ("new", "begun", "stepped", "closed")
SEEN = np.linspace(-1, 1, 54, dtype=np.float32)


def _env(state: str) -> Any:
    from tensegym.envs.rolling import RollingEnv

    env = RollingEnv(observation="onboard", settle=0.0, control_period=0.02)
    if state != "new":
        env.reset(seed=1)
    if state == "stepped":
        env.step(np.full(6, 0.3))
    if state == "closed":
        env.close()
    return env


def _robot(state: str) -> Any:
    from tensegym import TensegrityRobot

    robot = TensegrityRobot(dt=2e-3)
    if state == "stepped":
        robot.command(0.3 * robot.command_limit)
        robot.step(10)
    if state == "closed":
        robot.close()
    return robot


def _hinged(state: str) -> Any:
    from tensegym.flexible.flexure_file import load_robot

    robot = load_robot(sorted((Path(__file__).parents[2] / "urdf").glob("flexure_*.toml"))[0])
    if state == "stepped":
        robot.step(10)
    if state == "closed":
        robot.close()
    return robot


def _episode(state: str) -> Any:
    from tensegym.tasks import Task, as_task
    from tensegym.tasks.episode import Episode

    task: Task = as_task("roll")
    episode = Episode(_robot(state), task, np.random.default_rng(0), {})
    if state == "stepped":
        episode.advance(np.zeros(6), 10)
    return episode


def _policy(state: str) -> Any:
    from tensegym.control.policy import load_policy

    return load_policy("onboard")


def _design(state: str) -> Any:
    from tensegym import RobotDesign

    return RobotDesign().with_(spin_damping=1e-3)


def _moved(env: Any) -> Any:
    return [env.step(np.full(6, 0.5))[0] for _ in range(2)]


def _pulled(robot: Any) -> Any:
    robot.command(0.5 * robot.command_limit)
    robot.step(5)
    return [robot.node_positions_in_world(), robot.tensions]


LIVING: dict[str, tuple[Callable[[str], Any], Callable[[Any], Any]]] = {  # how one is made, and what it then does
    "RollingEnv": (_env, _moved),
    "TensegrityRobot": (_robot, _pulled),
    "FlexibleRobot": (_hinged, lambda robot: [robot.step(5), robot.time][1:]),
    "Episode": (_episode, lambda episode: list(episode.advance(np.zeros(6), 5).values())),
    "Policy": (_policy, lambda policy: [policy(SEEN)]),
    "RobotDesign": (_design, lambda design: [str(design), design.standing.nodes]),
}
COPIED = st.tuples(st.sampled_from(sorted(LIVING)), st.sampled_from(STATES),
                   st.lists(st.sampled_from(sorted(COPIERS)), min_size=1, max_size=3))  # fmt: skip


def copied(given: tuple[str, str, list[str]]) -> None:
    """A copy of a copy does what the original does, which it leaves as it was; or it is refused."""
    name, state, how = given
    make_it, move = LIVING[name]
    own = found = make_it(state)
    try:
        for each in how:
            found = COPIERS[each](found)
        there = move(found)
        for one, other in zip(move(own), there, strict=True):
            np.testing.assert_array_equal(one, other)
    finally:
        for each in {id(own): own, id(found): found}.values():
            close(each)


def close(living: Any) -> None:
    """Free its engine, or that of its robot, where it has one."""
    getattr(living, "close", getattr(getattr(living, "robot", None), "close", int))()
