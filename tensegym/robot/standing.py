"""Whether a robot stands: what its weight makes of its shape, face by face, and the least pretension that holds it.

Each face is tried by letting the robot settle on it in its own simulation, drives at zero: rods, cables, payload,
hinges and friction are those of the robot, and no other statics are assumed.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.shape import Shape
from tensegym.errors import DesignError, SimulationError, StructureError

from .robot import TensegrityRobot

FALLEN = 0.5  # of the volume of the nodes' hull at rest: a robot with less has fallen flat
SAGS = 0.1  # of the longest rod: a robot that a node moves farther in has sagged
SETTLING, LOOK = 2.0, 0.25  # s: at most, and between two looks at whether it has come to rest
AT_REST = 2e-3  # m/s; the fastest node's speed over a look
TIME_STEPS = (2e-3, 1e-3, 5e-4, 1e-4)  # s, the first one that the design allows
CLOSE = 1.1  # ratio of a tension that stands over one that does not, where the search ends
WIDEST = 2.0**-2  # of the design's pretension: the search goes no lower


class FaceVerdict(NamedTuple):
    """What became of a robot set down on one face."""

    name: str
    """Nodes of the face, counted from 1, as in 3-5-12."""
    sag: float
    """Largest displacement of a node by the weight, after the best rigid motion [m]; nan where the simulation broke."""
    volume: float
    """Volume of the nodes' hull over that at rest."""

    @property
    def fell(self) -> bool:
        return not self.volume >= FALLEN


class Verdict(NamedTuple):
    """Whether a robot stands."""

    shape: Shape
    faces: list[FaceVerdict]
    """Those that the centre of mass is above, which a rigid robot would rest on."""
    least_pretension: float | None
    """That the robot stands at on all of them [N], within 10 %, or the lowest tried, a quarter of the present one; None
    where none of those tried does, or none is looked for."""
    pretension: float
    """The design's own [N]."""
    length: float
    """Longest rod [m]."""

    @property
    def worst(self) -> FaceVerdict:
        return min(self.faces, key=lambda face: face.volume if face.volume >= 0 else -1.0)

    @property
    def kind(self) -> str:
        """stands, sags or falls."""
        if self.worst.fell:
            return "falls"
        return "sags" if max(face.sag for face in self.faces) > SAGS * self.length else "stands"

    @property
    def text(self) -> str:
        """Verdict in one line or two."""
        fell = [face for face in self.faces if face.fell]
        sag = 1e3 * max((face.sag for face in self.faces if not face.fell), default=0.0)
        if fell:
            line = f"falls flat under its weight on {len(fell)} of {len(self.faces)} faces ({fell[0].name} first)"
        else:
            line = f"{self.kind} on every face, its nodes displaced by at most {sag:.3g} mm under its weight"
        least = self.least_pretension
        if least is not None and least > 1.001 * WIDEST * self.pretension:
            line += f"; it stands from a pretension of {least:.3g} N on"
        elif least is not None:
            line += f"; so it does at a pretension of {least:.3g} N, the lowest tried"
        elif fell:
            line += "; with none of the pretensions tried does it stand on all: other force densities or heights may"
        if self.shape.moved > 1e-3 * self.length:
            line += f"\nform finding moved the given nodes by up to {self.shape.moved:.3g} m"
        return line

    def as_dict(self) -> dict[str, object]:
        """Plain JSON types."""
        shape, stiffness = self.shape, self.shape.least_stiffness
        return {
            "verdict": self.kind, "moved_m": shape.moved, "thickness_m": shape.thickness,
            "least_stiffness_N_per_m": stiffness if np.isfinite(stiffness) else None,
            "least_pretension_N": self.least_pretension,
            "faces": [{"face": f.name, "sag_m": f.sag if np.isfinite(f.sag) else None,
                       "volume": f.volume if np.isfinite(f.volume) else None, "fell": f.fell} for f in self.faces],
        }  # fmt: skip


def hull_volume(nodes: FloatArray) -> float:
    """Volume of the convex hull of nodes (n, 3) [m^3]; 0 where they span none, nan where one is not finite."""
    if not np.isfinite(nodes).all():
        return float("nan")
    try:
        return float(ConvexHull(nodes).volume)
    except QhullError:
        return 0.0


def has_fallen(robot: TensegrityRobot) -> bool:
    """Whether a robot, as it is now, has lost the volume of a standing one."""
    return not hull_volume(robot.node_positions_in_world()) >= FALLEN * hull_volume(robot.design.standing.nodes)


def standing_verdict(design: RobotDesign, engine: str = "pybullet") -> Verdict:
    """Set a robot down on every face it could rest on, then look for the least pretension that holds it on all.

    Raises StructureError where the nodes span no volume.
    """
    with _robot(design, engine) as robot:
        faces = {face: _settle(robot, face) for face in resting_faces(robot)}
    verdict = Verdict(design.shape, list(faces.values()), None, design.elastic_cable.pretension, design.length)
    worst_first = sorted(faces, key=lambda face: faces[face] is not verdict.worst)
    if design.elastic_cable.natural_length is not None or design.gravity == 0:
        return verdict
    return verdict._replace(least_pretension=_least_pretension(design, engine, worst_first, not verdict.worst.fell))


def resting_faces(robot: TensegrityRobot) -> Iterable[int]:
    """Faces with the foot of the perpendicular from the centre of mass in or on them."""
    nodes, model = robot.design.standing.nodes, robot.model
    centre = model.masses @ model.rest_poses[:, :3] / model.masses.sum()
    for face, (triangle, normal) in enumerate(zip(robot.faces.triangles, robot.faces.normals, strict=True)):
        corners = nodes[triangle]
        sides = np.roll(corners, -1, axis=0) - corners
        inside = np.cross(sides, centre - corners) @ normal
        if (inside >= -1e-6 * np.linalg.norm(sides, axis=1) ** 2).all():
            yield face


def _robot(design: RobotDesign, engine: str) -> TensegrityRobot:
    for dt in TIME_STEPS[:-1]:
        try:
            return TensegrityRobot(design, dt=dt, engine=engine)
        except DesignError:
            continue
    return TensegrityRobot(design, dt=TIME_STEPS[-1], engine=engine)


def _settle(robot: TensegrityRobot, face: int) -> FaceVerdict:
    name, rest = robot.faces.names()[face], robot.design.standing.nodes
    robot.reset(face)
    before = robot.node_positions_in_world()
    try:
        for _ in range(round(SETTLING / LOOK)):
            robot.step(round(LOOK / robot.dt))
            nodes = robot.node_positions_in_world()
            if np.linalg.norm(nodes - before, axis=1).max() < AT_REST * LOOK:
                break
            before = nodes
    except SimulationError:
        return FaceVerdict(name, float("nan"), float("nan"))
    goal, now = rest - rest.mean(axis=0), nodes - nodes.mean(axis=0)
    turn, _ = Rotation.align_vectors(goal, now)
    sag = float(np.linalg.norm(turn.apply(now) - goal, axis=1).max())
    return FaceVerdict(name, sag, hull_volume(nodes) / hull_volume(rest))


def _least_pretension(design: RobotDesign, engine: str, faces: list[int], stands: bool) -> float | None:
    """Halve or double the pretension until the robot falls or stands, then close in on where it changes [N]."""
    low = high = present = design.elastic_cable.pretension
    while stands and low > WIDEST * present:
        low, high = low / 2, low
        stands = _stands(design, engine, low, faces)
        if stands:
            high = low
    if stands:
        return low
    shortest = design.standing.lengths(design.standing.cables).min() - 2 * design.attachment_radius
    most = 0.98 * design.elastic_cable.stiffness * shortest  # above it a cable would be stretched from nothing
    while low == high:
        if high >= most:
            return None
        low, high = high, min(2 * high, most)
        if not _stands(design, engine, high, faces):
            low = high
    while high > CLOSE * low:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if _stands(design, engine, middle, faces) else (middle, high)
    return high


def _stands(design: RobotDesign, engine: str, pretension: float, faces: list[int]) -> bool:
    """Whether the robot stands on these faces at a pretension [N]; not where no robot can be made with it."""
    try:
        other = design.with_(elastic_cable=replace(design.elastic_cable, pretension=pretension))
        with _robot(other, engine) as robot:
            return not any(_settle(robot, face).fell for face in faces)
    except (DesignError, StructureError):
        return False
