"""Nodes against time under the same commands: in free flight, where engines must agree, and on the ground, where paths
are chaotic, so that the same engine a little off is the measure."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.control.playback import Playback
from tensegym.design.design import RobotDesign
from tensegym.robot.robot import TensegrityRobot

from .part import ENGINES, Part

PERIOD = 0.02  # s between two looks, for which a command is held
FLIGHT_SECONDS, TURNING, MOVING = 2.0, (1.0, 2.0, -1.5), (0.3, -0.2, 0.1)  # s, rad/s, m/s
FLIGHT_TOLERANCE = 1e-6  # m; the engines take the same forces there, and differ in rounding
NUDGE = 1e-9  # m/s; a start that is off by as little as that
Begin = Callable[[TensegrityRobot], None]


def free_flight(design: RobotDesign, dt: float, seed: int = 0) -> Part:
    """Tumbling without gravity, the drives commanded at random."""
    rng = np.random.default_rng(seed)
    count = len(design.structure.stiff_cables)
    times = np.arange(0, FLIGHT_SECONDS + 0.1, 0.2)
    shares = rng.uniform(0, 1, (len(times), count))
    paths = {}
    for engine in ENGINES:
        with TensegrityRobot(design, dt=dt, ground=False, engine=engine) as robot:
            paths[engine] = _path(robot, times, shares * robot.command_limit, _tumble)
    apart = _apart(*paths.values())
    moved = float(np.linalg.norm(paths[ENGINES[0]] - paths[ENGINES[0]][0], axis=2).max())
    verdict = (f"In free flight all nodes stay within {apart.max():.2g} m over {FLIGHT_SECONDS:g} s, in which they go "
               f"up to {moved:.2g} m: without contact forces are the same, and only rounding differs.")  # fmt: skip
    return Part(
        "free flight", ["seconds", "nodes move m", "engines apart m"], [[FLIGHT_SECONDS, moved, float(apart.max())]],
        bool(apart.max() <= FLIGHT_TOLERANCE), verdict, {"period_s": PERIOD, "engines_m": apart.tolist()},
    )  # fmt: skip


def on_ground(
    design: RobotDesign, dt: float, times: FloatArray, angles: FloatArray, face: int = 0, heading: float = 0.0
) -> Part:
    """Commands (t, w) [rad] against times (t,) [s] from rest on a face.

    Raises DesignError where they are not the robot's.
    """
    begin = partial(_stand, face=face, heading=heading)
    runs = {"engines apart": (ENGINES[1], dt, 0.0), "pybullet, nudged by 1e-9 m/s": (ENGINES[0], dt, NUDGE),
            "pybullet, half the time step": (ENGINES[0], dt / 2, 0.0)}  # fmt: skip
    paths = {}
    for name, (engine, step, nudge) in {"": (ENGINES[0], dt, 0.0), **runs}.items():
        with TensegrityRobot(design, dt=step, engine=engine) as robot:
            paths[name] = _path(robot, times, angles, begin, nudge)
    apart = {name: _apart(paths[""], paths[name]) for name in runs}
    ends = {name: float(path[-1].mean()) for name, path in apart.items()}
    own = max(ends[name] for name in list(runs)[1:])
    agrees = ends["engines apart"] <= 3 * own + 2e-3
    verdict = (
        f"At the end nodes of the two engines are {ends['engines apart']:.2g} m apart, and those of PyBullet and of "
        f"PyBullet a little off {own:.2g} m: " + (
            "a path depends on its start that much, so paths are no measure of an engine; statistics are."
            if own > 0.02 else "contacts of MuJoCo give way, those of PyBullet do not."))  # fmt: skip
    moments = np.linspace(0, len(paths[""]) - 1, 6).round().astype(int)[1:]
    rows = [[moment * PERIOD, *(float(path[moment].mean()) for path in apart.values())] for moment in moments]
    curves = {"period_s": PERIOD, **{f"{name}_m": path.mean(axis=1).tolist() for name, path in apart.items()}}
    return Part("commands", ["s", *(f"{name} m" for name in runs)], rows, agrees, verdict, curves)


def _path(
    robot: TensegrityRobot, times: FloatArray, angles: FloatArray, begin: Begin, nudge: float = 0.0
) -> FloatArray:
    """(t, n, 3) of the nodes, one look a PERIOD."""
    begin(robot)
    robot.push([nudge, 0.0, 0.0])
    commands = Playback(times, angles, PERIOD)
    commands.begin(robot)
    nodes = [robot.node_positions_in_world()]
    for _ in range(round((times[-1] - times[0]) / PERIOD)):
        robot.command(commands.angles(robot))
        robot.step(round(PERIOD / robot.dt))
        nodes.append(robot.node_positions_in_world())
    return np.array(nodes)


def _tumble(robot: TensegrityRobot) -> None:
    rest, masses = robot.model.rest_poses[:, :3], robot.model.masses
    from_centre = rest - masses @ rest / masses.sum()
    velocities = np.hstack([MOVING + np.cross(TURNING, from_centre), np.tile(TURNING, (len(rest), 1))])
    robot.reset_rotated(Rotation.identity(), velocities)


def _stand(robot: TensegrityRobot, face: int, heading: float) -> None:
    robot.reset(face, heading)


def _apart(one: FloatArray, other: FloatArray) -> FloatArray:
    """(t, n) distances of the nodes."""
    return np.linalg.norm(one - other, axis=2)
