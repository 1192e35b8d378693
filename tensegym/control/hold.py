"""One step in closed loop: drives pull and hold until the robot has tipped and landed, then let go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.symmetry import symmetries
from tensegym.errors import InputError
from tensegym.files import write_json
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import Faces
from tensegym.tables import Checked, bounded, noted, read_records

from .made_for import KEY, MadeFor
from .tipping import current_face

PERIOD = 0.1  # s between two looks at the robot
PATIENCE, LANDING, REST = 2.4, 0.6, 1.5  # s: until it has tipped, from then until it has landed, and let go for


@dataclass(frozen=True)
class Hold(Checked, error=InputError):
    """Depths that all drives wind in to, and the faces that this led to in trials.

    parts (w,): of the deepest pull of each drive. ends: index of a face and the share of the trials that ended there.
    """

    from_face: int = bounded(0, 10**6)
    parts: tuple[float, ...] = bounded(0, 1)
    ends: tuple[tuple[int, float], ...] = noted(())

    def leads_to(self, face: int) -> float:
        """Share of the trials that ended on a face."""
        return dict(self.ends).get(face, 0.0)


class Attempt:
    """A hold on a robot that stands. `over` is to be asked once a PERIOD; it says when to let go."""

    def __init__(self, robot: TensegrityRobot, parts: Sequence[float]) -> None:
        self.face = current_face(robot)
        self.angles: FloatArray = np.asarray(parts) * robot.command_limit
        """Spool angles (w,) [rad]."""
        self._began, self._tipped = robot.time, np.inf

    def over(self, robot: TensegrityRobot) -> bool:
        """Whether it has tipped and stands on all feet of the face it came onto, or is not going to."""
        face = current_face(robot)
        if face != self.face:
            self._tipped = min(self._tipped, robot.time)
        if np.isinf(self._tipped):
            return robot.time - self._began >= PATIENCE - 1e-9
        landed = bool(robot.foot_contacts()[robot.faces.triangles[face]].all())
        return landed or robot.time - self._tipped >= LANDING - 1e-9


def attempt(robot: TensegrityRobot, face: int, parts: Sequence[float], heading: float = 0.0) -> int:
    """Stand on a face, settle, hold, let go: the face it then rests on."""
    steps = round(PERIOD / robot.dt)
    robot.reset(face, heading)
    robot.step(3 * steps)
    held = Attempt(robot, parts)
    robot.command(held.angles)
    while not held.over(robot):
        robot.step(steps)
    robot.command(np.zeros(len(robot.drives)))
    robot.step(round(REST / robot.dt))
    return current_face(robot)


def turned(holds: Sequence[Hold], design: RobotDesign, faces: Faces) -> list[Hold]:
    """Those of some faces, and what the robot's symmetry makes of them on the others."""
    index = {frozenset(triangle): face for face, triangle in enumerate(faces.triangles.tolist())}
    found: dict[tuple[int, tuple[float, ...]], Hold] = {}
    for symmetry in symmetries(design):
        to = [index[frozenset(symmetry.nodes[triangle].tolist())] for triangle in faces.triangles]
        for hold in holds:
            parts = np.empty(len(hold.parts))
            parts[symmetry.drives] = hold.parts
            ends = tuple((to[face], share) for face, share in hold.ends)
            new = replace(hold, from_face=to[hold.from_face], parts=tuple(parts.tolist()), ends=ends)
            found.setdefault((new.from_face, new.parts), new)
    return sorted(found.values(), key=lambda hold: hold.from_face)


def save_holds(holds: Sequence[Hold], path: Path, made_for: MadeFor) -> None:
    """Write a table of holds, and of which robot they are, as JSON."""
    write_json(path, {KEY: asdict(made_for), "holds": [asdict(hold) for hold in holds]})


def load_holds(path: Path) -> list[Hold]:
    """Read what `save_holds` wrote. Raises InputError naming the row and the field, or FileNotFoundError."""
    return read_records(path, "holds", Hold, "python benchmarks/holds.py", InputError)
