"""The robot that a table or a policy was made for, by its members: what another has to share to be driven by it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from tensegym.arrays import IntArray
from tensegym.errors import DesignError, InputError
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import Faces
from tensegym.structure.structure import Structure
from tensegym.tables import Checked, fill, noted, read_json

KEY = "made_for"  # in a table's file


@dataclass(frozen=True)
class MadeFor(Checked, error=InputError):
    """Members by their nodes, counted from 1, as in 3-7, in the robot's order. A number stands for the member there.

    faces: none for what does not number faces, as a policy.
    """

    rods: tuple[str, ...] = noted(what="by their nodes")
    drives: tuple[str, ...] = noted(what="by the nodes of their cables, the drive's first")
    faces: tuple[str, ...] = noted((), "by their nodes, ascending")

    @classmethod
    def of(cls, structure: Structure, faces: Faces | None = None) -> MadeFor:
        """A structure's members."""
        return cls(_names(structure.rods), _names(structure.stiff_cables), tuple(faces.names()) if faces else ())

    @classmethod
    def like(cls, robot: TensegrityRobot) -> MadeFor:
        """A robot's members."""
        return cls.of(robot.design.standing, robot.faces)

    def differs(self, here: MadeFor) -> str:
        """In what another robot differs, as in "8 faces, this one has 20"; empty where it does not."""
        for kind in ("faces", "rods", "drives") if self.faces else ("rods", "drives"):
            own, other = getattr(self, kind), getattr(here, kind)
            if len(own) != len(other):
                return f"{len(own)} {kind}, this one has {len(other)}"
            for number, (one, another) in enumerate(zip(own, other, strict=True), 1):
                if one != another:
                    return f"{one} as number {number} of its {kind}, this one has {another}"
        return ""

    def check(self, robot: TensegrityRobot, what: str, remedy: str) -> None:
        """Raise DesignError where a robot differs, saying in what, and what to do."""
        if found := self.differs(MadeFor.like(robot)):
            raise DesignError(f"{what} was made for a robot with {found}; {remedy}")


def check_table(
    made_for: MadeFor | None, faces: Iterable[int], drives: int, robot: TensegrityRobot, what: str, remedy: str
) -> None:
    """Look whether a table is of such a robot; by what its rows say, where it does not say of which it is.

    Args:
        made_for: as its file says.
        faces: those that its rows name; where they name several, the last one is the robot's last.
        drives: how many it has.
        what, remedy: of the message.

    Raises:
        DesignError: it is of another robot.
    """
    if made_for:
        made_for.check(robot, what, remedy)
        return
    named, here = set(faces), (len(robot.faces.triangles), len(robot.drives))
    count = max(named) + 1
    if count > here[0] or (len(named) > 1 and count != here[0]) or drives != here[1]:
        raise DesignError(f"{what} is of a robot with {count} faces and {drives} drives, this one has {here[0]} and "
                          f"{here[1]}; {remedy}")  # fmt: skip


def read_made_for(path: Path) -> MadeFor | None:
    """What a table's file says; None where it is of an earlier version and does not. Raises InputError."""
    data = read_json(path, "table", InputError)
    if not isinstance(data, dict) or KEY not in data:
        return None
    return fill(MadeFor, data[KEY], f"{path}: {KEY}", InputError)


def _names(pairs: IntArray) -> tuple[str, ...]:
    return tuple("-".join(str(node + 1) for node in pair) for pair in pairs.tolist())
