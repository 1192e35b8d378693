"""The face that each tabulated pull ends on, and whether a pull on which engines differ is on an edge anyway."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from tensegym.control.tipping import Pull, Tip, subsets, tip_from
from tensegym.design.design import RobotDesign
from tensegym.processes import process_map
from tensegym.robot.robot import TensegrityRobot

from .part import ENGINES, Part

WANTED = 0.95  # of the pulls are to end on the same face, or to be on an edge
DEPTHS = (0.98, 1.02)  # of a pull's depth; where one of them, or half the time step, ends on another face, it is on one


class Trial(NamedTuple):
    """A pull from a face, in an engine at a time step [s]."""

    engine: str
    dt: float
    face: int
    pull: Pull


def steps(
    design: RobotDesign, dt: float, depths: Sequence[float], jobs: int = 0, faces: Sequence[int] | None = None
) -> Part:
    """The whole table of `tensegym step --all-faces` in both engines.

    Args:
        depths: parts of the stiff cables' rest lengths that are wound in.
        jobs: processes; 0 for one a core.
        faces: to start from; default: all.
    """
    with TensegrityRobot(design, dt=dt) as robot:
        names, count = robot.faces.names(), len(robot.drives)
    pulls = [Pull(drives, depth) for depth in depths for drives in subsets(count)]
    table = [(face, pull) for face in (range(len(names)) if faces is None else faces) for pull in pulls]
    ends = {engine: _ends(design, [Trial(engine, dt, *row) for row in table], jobs) for engine in ENGINES}
    first, second = (ends[engine] for engine in ENGINES)
    differ = [row for row in range(len(table)) if first[row] != second[row]]
    edges = _on_edges(design, dt, [(*table[row], first[row]) for row in differ], jobs)
    equal, explained = 1 - len(differ) / len(table), sum(edges) / len(table)
    tips = [[sum(end != face for end, (face, _) in zip(e, table, strict=True)) for e in (first, second)]]
    verdict = (
        f"{equal:.1%} of {len(table)} pulls end on the same face; {sum(edges)} of the other {len(differ)} are on an "
        "edge, ending elsewhere in PyBullet too when they are 2 % deeper or less deep or the time step is halved."
    )
    rows = [[len(table), *tips[0], equal, explained, 1 - equal - explained]]
    header = ["pulls", *(f"tip in {engine}" for engine in ENGINES), "equal", "on an edge", "not explained"]
    curves = {"equal": equal, "on an edge": explained, "not explained": 1 - equal - explained,
              "differ": [[names[table[row][0]], [d + 1 for d in table[row][1].drives], table[row][1].depth,
                          names[first[row]], names[second[row]], edge]
                         for row, edge in zip(differ, edges, strict=True)]}  # fmt: skip
    return Part("steps", header, rows, equal + explained >= WANTED, verdict, curves)


def _on_edges(design: RobotDesign, dt: float, rows: list[tuple[int, Pull, int]], jobs: int) -> list[bool]:
    """Of pulls and the faces that they end on: whether they end elsewhere in the same engine, a little off."""
    deepest = design.deepest_pull
    trials = [trial for face, pull, _ in rows for trial in (
        *(Trial(ENGINES[0], dt, face, replace(pull, depth=min(factor * pull.depth, deepest))) for factor in DEPTHS),
        Trial(ENGINES[0], dt / 2, face, pull))]  # fmt: skip
    ends, each = _ends(design, trials, jobs), len(DEPTHS) + 1
    return [set(ends[each * row : each * row + each]) != {end} for row, (_, _, end) in enumerate(rows)]


def _ends(design: RobotDesign, trials: list[Trial], jobs: int) -> list[int]:
    """Faces that pulls end on."""
    size = 41  # one face's pulls at a depth
    chunks = [tuple(enumerate(trials))[i : i + size] for i in range(0, len(trials), size)]
    ends: dict[int, int] = {}
    for done in process_map(partial(_play, design), chunks, jobs, bar="pulls", unit=f"{size} pulls"):
        ends |= done
    return [ends[row] for row in range(len(trials))]


def _play(design: RobotDesign, trials: Sequence[tuple[int, Trial]]) -> dict[int, int]:
    done: dict[int, int] = {}
    robots: dict[tuple[str, float], TensegrityRobot] = {}
    try:
        for row, trial in trials:
            kind = (trial.engine, trial.dt)
            if kind not in robots:
                robots[kind] = TensegrityRobot(design, dt=trial.dt, engine=trial.engine)
            tip: Tip = tip_from(robots[kind], trial.face, trial.pull)
            done[row] = tip.to_face
    finally:
        for robot in robots.values():
            robot.close()
    return done
