"""Both engines on one robot, as `tensegym compare` looks at them."""

from __future__ import annotations

from tensegym.compare.motion import free_flight
from tensegym.compare.settling import settling
from tensegym.compare.steps import steps
from tensegym.design.design import RobotDesign
from tensegym.validation.row import Findings, Row

STEP = 2e-3  # s
DEPTHS = (0.3, 0.45)  # of the table of tips that ships with the walker


def at_rest_and_in_flight(engine: str) -> Findings:
    """The robot tumbles for 2 s under random commands without gravity, where only rounding differs, and settles on
    every face that it can rest on."""
    flight, rest = free_flight(RobotDesign(), STEP), settling(RobotDesign(), STEP)
    lower = 1e3 * max(abs(difference) for difference in rest.curves["difference_m"])
    return Findings([
        Row("sides", "nodes of the engines apart in flight, m", 0.0, max(map(max, flight.curves["engines_m"])), 1e-6,
            STEP),
        Row("sides", "largest difference of the heights at rest, mm", 0.0, lower, 1.0, STEP, rest.verdict),
    ])  # fmt: skip


def end_faces(engine: str) -> Findings:
    """Every pull of one to three drives from every face, at two depths, to the face that it ends on. A pull on which
    the engines differ is explained where PyBullet too ends elsewhere with 2 % more or less depth, or half the step.
    Policies side by side: `tensegym compare --policy NAME`, see [engines.md](engines.md)."""
    found = steps(RobotDesign(), STEP, DEPTHS, jobs=1)
    equal, edge = found.curves["equal"], found.curves["on an edge"]
    return Findings([Row("faces", "pulls that end on the same face, or are explained: share", 1.0, equal + edge, 0.05,
                         STEP, found.verdict)])  # fmt: skip
