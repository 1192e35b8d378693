"""One step: drives pull and release, and the robot tips from one face onto another. The table of all such steps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.groups import column
from tensegym.errors import InputError
from tensegym.robot.fallen import has_fallen
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import supporting_face
from tensegym.tables import Checked, bounded, noted


@dataclass(frozen=True)
class Pull(Checked, error=InputError):
    """One pull of some drives and its release; at most the design's max_pull is wound in."""

    drives: tuple[int, ...] = bounded(0, 10**4, what="indices of the drives")
    depth: float = bounded(0, 1, what="part of the cable's rest length wound in")
    pull_time: float = bounded(0, 60, 2.0, "s", "wound in for this long")
    release_time: float = bounded(0, 60, 1.6, "s", "let out for this long")

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.drives:
            raise InputError("Pull.drives = () must name one drive or more")

    @property
    def duration(self) -> float:
        return self.pull_time + self.release_time

    def angles(self, robot: TensegrityRobot, time: float) -> FloatArray:
        """Commanded spool angles (w,) [rad] at ``time`` [s] into the pull."""
        angles = np.zeros(len(robot.drives))
        if time < self.pull_time:
            full = robot.design.stiff_cable_lengths / column(robot.design.each_drive, "spool_radius")
            angles[list(self.drives)] = self.depth * full[list(self.drives)]
        return angles


@dataclass(frozen=True)
class Tip(Checked, error=InputError):
    """What a pull did. from_face, to_face: indices into the robot's faces, equal where it did not tip.

    travel: horizontal displacement of the centre of mass (2,) [m] in the frame of the face it started on (x from the
    face's middle to its first node). peak_tension: largest in a stiff cable [N]. turn: angle from that line to the one
    of the face it ended on [rad]; None in tables of earlier versions.
    """

    pull: Pull
    from_face: int = bounded(0, 10**6)
    to_face: int = bounded(0, 10**6)
    travel: tuple[float, float] = noted()
    peak_tension: float = noted()
    turn: float | None = noted(None)

    @property
    def tipped(self) -> bool:
        return self.to_face != self.from_face


def face_direction(robot: TensegrityRobot, face: int, nodes: FloatArray) -> float:
    """World angle [rad] of the horizontal line from the middle of a face to its first node."""
    triangle = nodes[robot.faces.triangles[face]]
    x, y = (triangle[0] - triangle.mean(axis=0))[:2]
    return float(np.arctan2(y, x))


def current_face(robot: TensegrityRobot) -> int:
    """The face under the centre of mass."""
    return supporting_face(robot.faces, robot.node_positions_in_world(), robot.centre_of_mass_in_world())


def run_pull(
    robot: TensegrityRobot, pull: Pull, watch: Callable[[TensegrityRobot], None] | None = None, period: float = 0.02
) -> Tip:
    """Run a pull and its release on a robot as it stands; ``watch`` is called every ``period`` [s]."""
    start_face, start = current_face(robot), robot.centre_of_mass_in_world()
    angle = face_direction(robot, start_face, robot.node_positions_in_world())
    peak = 0.0
    for tick in range(round(pull.duration / period)):
        robot.command(pull.angles(robot, tick * period))
        robot.step(round(period / robot.dt))
        peak = max(peak, float(robot.tensions[robot.model.driven].max(initial=0.0)))
        if watch:
            watch(robot)
    dx, dy = (robot.centre_of_mass_in_world() - start)[:2]
    c, s = np.cos(angle), np.sin(angle)
    end_face, planes = current_face(robot), robot.faces.planes
    if has_fallen(robot) or planes[end_face] == planes[start_face]:  # lying flat is no step
        end_face = start_face
    turn = face_direction(robot, end_face, robot.node_positions_in_world()) - angle
    return Tip(pull, start_face, end_face, (float(c * dx + s * dy), float(c * dy - s * dx)), peak,
               float(np.remainder(turn + np.pi, 2 * np.pi) - np.pi))  # fmt: skip


def subsets(count: int, largest: int = 3) -> Iterable[tuple[int, ...]]:
    """Every choice of one to ``largest`` of ``count`` drives, fewest first."""
    for size in range(1, largest + 1):
        yield from combinations(range(count), size)


def tip_from(robot: TensegrityRobot, face: int, pull: Pull, settle: float = 0.5) -> Tip:
    """Stand on ``face``, settle, pull: one trial of the table."""
    robot.reset(face)
    robot.step(round(settle / robot.dt))
    return run_pull(robot, pull)


def tip_table(
    robot: TensegrityRobot, depths: Sequence[float] = (0.3, 0.45), faces: Iterable[int] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Tip]:
    """Try every subset of one to three drives from every face, at every depth."""
    faces = list(range(len(robot.faces.triangles)) if faces is None else faces)
    trials = [Pull(drives, depth) for depth in depths for drives in subsets(len(robot.drives))]
    tips = []
    for face in faces:
        for pull in trials:
            tips.append(tip_from(robot, face, pull))
            if progress:
                progress(len(tips), len(faces) * len(trials))
    return tips
