"""What a command says of a robot that does not stand, or is not the given one, before it goes to work with it."""

from __future__ import annotations

import sys

from tensegym.design.design import RobotDesign
from tensegym.robot.standing import Verdict, standing_verdict

MOVED = 0.01  # of the longest rod: nodes that form finding moved farther are told of


def tell_unless_standing(design: RobotDesign, engine: str) -> Verdict:
    """The verdict on a design; one that sags or falls goes to standard error, in one line, with what would hold it. So
    does how far form finding moved the nodes."""
    verdict = standing_verdict(design, engine, pretension=False)
    if verdict.kind != "stands":
        verdict = standing_verdict(design, engine)
        _tell(design, verdict.text.replace("\n", "; "))
    elif design.shape.moved > MOVED * design.length:
        _tell(design, f"stands; {verdict.moved}")
    return verdict


def _tell(design: RobotDesign, text: str) -> None:
    print(f"tensegym: robot {design.name!r} {text}", file=sys.stderr, flush=True)
