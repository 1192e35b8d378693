"""What a command says of a robot that does not stand, before it goes to work with it."""

from __future__ import annotations

import sys

from tensegym.design.design import RobotDesign
from tensegym.robot.standing import Verdict, standing_verdict


def tell_unless_standing(design: RobotDesign, engine: str) -> Verdict:
    """The verdict on a design; one that sags or falls goes to standard error, in one line, with what would hold it."""
    verdict = standing_verdict(design, engine, pretension=False)
    if verdict.kind != "stands":
        verdict = standing_verdict(design, engine)
        print(f"tensegym: robot {design.name!r} {verdict.text}".replace("\n", "; "), file=sys.stderr, flush=True)
    return verdict
