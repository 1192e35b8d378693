"""A robot set down on its faces as it is built, and let go: what its weight makes of it."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.groups import scaled
from tensegym.design.symmetry import symmetries
from tensegym.errors import DesignError, SimulationError
from tensegym.physics.model import DAMPING, Model
from tensegym.physics.robot_arrays import explicit_step_limit, robot_model
from tensegym.structure.faces import face_by_nodes

from .fallen import FALLEN, FLAT, hull_volume
from .robot import TensegrityRobot
from .step_check import LEAST_TIME_STEP

SECONDS, LOOK = 3.0, 0.25  # s: how long a face is tried, and between two looks at whether the robot is at rest
AT_REST = 1e-3  # m/s; the fastest node's mean speed over a look
BREATH = 1.0  # s: the sag is a mean over as much, since a robot breathes on for long
SHORTEST, SHORT, LONGEST = 2.5e-4, 1e-3, 4e-3  # s: time steps; dampers are eased that ask for less than a short one
WITHIN = 0.9  # of the limit of explicit forces
MOST_EASED = 2.0**13  # ratio of a damper over the eased one


class Settled(NamedTuple):
    """What became of a robot on one face, and on those that a rotation of the robot maps it onto."""

    names: tuple[str, ...]
    """Nodes of each of these faces, counted from 1, as in 3-5-12; the first one was tried."""
    sag: float
    """Largest displacement of a node by the weight, after the best rigid motion, a mean over the last second [m]; nan
    where the simulation broke."""
    volume: float
    """Volume of the nodes' hull over that at rest."""

    @property
    def fell(self) -> bool:
        return not self.volume >= FALLEN


def robot_for(design: RobotDesign, engine: str = "pybullet") -> TensegrityRobot:
    """The robot at the longest time step at which its cable forces are explicit.

    Implicit ones leave the ground's push out of the state that they foresee, and so give way to a load at rest, by
    dt c + dt^2 k over the mass that they hold. Dampers that ask for short steps are eased, which changes nothing about
    where a robot comes to rest; a robot that only its stiffness asks to step below SHORTEST steps implicitly.

    Raises DesignError where no time step will do.
    """
    model, ratio = robot_model(design), 1.0
    longest = step = WITHIN * explicit_step_limit(model)
    while step < SHORT and ratio < MOST_EASED:
        ratio *= 2
        step = WITHIN * explicit_step_limit(_with_damping(model, 1 / ratio))
    if step < SHORT:
        step, ratio = longest, 1.0
    dt = min(max(step, SHORTEST), LONGEST)
    while True:
        try:
            return TensegrityRobot(_eased(design, ratio), dt=dt, engine=engine)
        except DesignError:  # a rod's spin may ask for a shorter one
            dt /= 2
            if dt < LEAST_TIME_STEP:
                raise


def _with_damping(model: Model, part: float) -> Model:
    params = model.spring_params.copy()
    params[:, DAMPING] *= part
    return model._replace(spring_params=params)


def _eased(design: RobotDesign, ratio: float) -> RobotDesign:
    """With the damping of every cable divided by this."""
    if ratio == 1:
        return design
    names = ("elastic_cable", "stiff_cable", *(["payload"] if design.payload else []))
    cables = {name: getattr(design, name) for name in names}
    eased = {name: replace(cable, damping=cable.damping / ratio) for name, cable in cables.items()}
    groups = {name: scaled(getattr(design, name), {"damping": 1 / ratio}) for name in ("cables", "drives")}
    return design.with_(**eased, **groups)


def resting_faces(robot: TensegrityRobot) -> list[int]:
    """Faces with the foot of the perpendicular from the centre of mass in or on them."""
    nodes, model, faces = robot.design.standing.nodes, robot.model, robot.faces
    centre = model.masses @ model.rest_poses[:, :3] / model.masses.sum()
    corners = nodes[faces.triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    inside = np.einsum("fki,fi->fk", np.cross(sides, centre - corners), faces.normals)
    below: list[int] = np.flatnonzero((inside >= -1e-6 * (sides**2).sum(axis=2)).all(axis=1)).tolist()
    return below


def alike(robot: TensegrityRobot) -> list[tuple[str, ...]]:
    """Names of the faces it can rest on, those together that rotations of the robot map onto one another."""
    names, triangles = robot.faces.names(), robot.faces.triangles.tolist()
    left = {frozenset(triangles[face]): names[face] for face in resting_faces(robot)}
    turns = [turn.nodes for turn in symmetries(robot.design)]
    found = []
    while left:
        face = next(iter(left))
        images = dict.fromkeys(frozenset(turn[sorted(face)].tolist()) for turn in turns)
        found.append(tuple(left.pop(image) for image in (face, *images) if image in left))
    return found


def settle(robot: TensegrityRobot, names: tuple[str, ...]) -> Settled:
    """Set a robot down on the first of the faces and let go, until it lies still, or flat."""
    rest = robot.design.standing.nodes
    robot.reset(face_by_nodes(robot.faces, names[0]))
    nodes, whole, looks = robot.node_positions_in_world(), hull_volume(rest), list[FloatArray]()
    try:
        for _ in range(round(SECONDS / LOOK)):
            before = nodes
            robot.step(round(LOOK / robot.dt))
            nodes = robot.node_positions_in_world()
            looks.append(nodes)
            still = np.linalg.norm(nodes - before, axis=1).max() < AT_REST * LOOK
            if still or hull_volume(nodes) < FLAT * whole:
                looks = [nodes]
                break
    except SimulationError:
        return Settled(names, float("nan"), float("nan"))
    last = looks[-round(BREATH / LOOK) :]
    sag = float(np.mean([displacement(rest, nodes) for nodes in last]))
    return Settled(names, sag, hull_volume(nodes) / whole)


def displacement(rest: FloatArray, nodes: FloatArray) -> float:
    """Largest distance [m] of nodes (n, 3) from where they were at rest, after the best rigid motion."""
    goal, now = rest - rest.mean(axis=0), nodes - nodes.mean(axis=0)
    turn, _ = Rotation.align_vectors(goal, now)
    return float(np.linalg.norm(turn.apply(now) - goal, axis=1).max())
