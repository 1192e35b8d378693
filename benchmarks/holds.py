"""The table of holds that the stepper chooses from, found by statics and trials; and what the statics forbid.

    python benchmarks/holds.py --out tensegym/train/policies/walker/holds.json      # minutes
    python benchmarks/holds.py --statics --levels 7      # no trials: which steps there can be

Of each face that the robot's symmetry makes the others of, depths are tried that leave the centre of mass farthest
beyond an edge, and all that pull some drives alike. Of those that lead onto a neighbour some are tried again from other
headings, at half the time step and in MuJoCo; the best few are kept, with the shares of where they end.
"""

from __future__ import annotations

import itertools
from collections import Counter, defaultdict
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro

from tensegym.arrays import FloatArray
from tensegym.control.hold import Hold, attempt, save_holds, turned
from tensegym.control.made_for import MadeFor
from tensegym.control.poise import Shapes, beyond, shapes
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import as_design
from tensegym.design.symmetry import symmetries
from tensegym.report import table
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.faces import Faces, hull_faces

ROBOTS = ((2e-3, "pybullet"), (2e-3, "mujoco"), (1e-3, "pybullet"))  # which a hold is tried on: time step [s], engine


@dataclass(frozen=True)
class Holds:
    """Which depths step from which face onto which."""

    design: str = "six_rod"
    """A preset or a TOML file."""
    statics: bool = False
    """Only tabulate how far any depths bring the centre of mass beyond each edge."""
    levels: int = 5
    """Depths a drive, from none to its deepest pull: all combinations are looked at."""
    edge: int = 60
    """Depths tried for each edge."""
    again: int = 5
    """Of those that lead onto a neighbour, so many are tried again..."""
    trials: int = 6
    """...so often,"""
    kept: int = 3
    """and so many kept."""
    out: Path = Path("holds.json")
    """File to write."""

    def run(self) -> str:
        design = as_design(self.design)
        faces, drives = hull_faces(design.standing), len(design.structure.stiff_cables)
        grid = itertools.product(np.linspace(0, 1, self.levels), repeat=drives)
        at = shapes(design, map(np.array, grid))
        first = representatives(design, faces)
        if self.statics:
            return statics(at, faces, first)
        with ExitStack() as stack:
            robots = [stack.enter_context(TensegrityRobot(design, dt=dt, engine=engine)) for dt, engine in ROBOTS]
            holds = [hold for face in first for hold in self._from(robots, at, faces, face)]
        every = turned(holds, design, faces)
        save_holds(every, self.out, MadeFor.of(design.standing, faces))
        return summary(every, faces)

    def _from(self, robots: Sequence[TensegrityRobot], at: Shapes, faces: Faces, face: int) -> list[Hold]:
        alike = [row for row, parts in enumerate(at.parts) if parts.max() >= 0.5 and len({*parts[parts > 0]}) == 1]
        best = np.argsort(-beyond(at, faces, face), axis=1)[:, : self.edge]
        led: dict[int, list[int]] = defaultdict(list)
        for row in sorted({*alike, *best.ravel().tolist()}):
            led[attempt(robots[0], face, at.parts[row])].append(row)
        found = []
        for to, rows in led.items():
            if to not in faces.neighbours[face]:
                continue
            some = np.random.default_rng(0).permutation(rows)[: self.again]
            holds = [Hold(face, tuple(at.parts[row].tolist()), self._ends(robots, face, at.parts[row])) for row in some]
            found += sorted(holds, key=lambda hold: -hold.leads_to(to))[: self.kept]
        print(faces.names()[face], {faces.names()[to]: len(rows) for to, rows in led.items()}, flush=True)
        return found

    def _ends(self, robots: Sequence[TensegrityRobot], face: int, parts: FloatArray) -> tuple[tuple[int, float], ...]:
        ends = Counter(attempt(robots[n % len(robots)], face, parts, 0.3 + 2.4 * n % 6) for n in range(self.trials))
        return tuple((face, count / self.trials) for face, count in ends.most_common())


def representatives(design: RobotDesign, faces: Faces) -> list[int]:
    """The first of the faces that the robot's symmetry takes for one another."""
    sets = [{frozenset(s.nodes[triangle].tolist()) for s in symmetries(design)} for triangle in faces.triangles]
    return [face for face, images in enumerate(sets) if images not in sets[:face]]


def kind(faces: Faces, face: int, to: int) -> str:
    """As in "open onto closed"."""
    return " onto ".join("closed" if faces.closed[each] else "open" for each in (face, to))


def statics(at: Shapes, faces: Faces, first: Sequence[int]) -> str:
    """How far beyond each edge, and no other, any depths bring the centre of mass."""
    rows = []
    for face in first:
        past = beyond(at, faces, face)
        for edge in range(3):
            to, best = faces.neighbours[face, edge], int(past[edge].argmax())
            depths = " ".join(f"{part:.2f}" for part in at.parts[best])
            rows.append([faces.names()[face], faces.names()[to], kind(faces, face, to), 1e3 * past[edge, best],
                         int((past[edge] > 0).sum()), depths])  # fmt: skip
    rows.sort(key=lambda row: (row[2], -row[3]))
    return table(["from", "onto", "kind", "at most beyond, mm", f"of {len(at.parts)}", "depths"], rows)


def summary(holds: Sequence[Hold], faces: Faces) -> str:
    """The best share of each kind of step onto a neighbour."""
    best: dict[str, list[float]] = defaultdict(list)
    for face, neighbours in enumerate(faces.neighbours):
        for to in neighbours:
            shares = [hold.leads_to(int(to)) for hold in holds if hold.from_face == face]
            best[kind(faces, face, to)].append(max(shares, default=0.0))
    rows = [[name, len(shares), sum(share > 0.5 for share in shares), float(np.mean(shares))]
            for name, shares in sorted(best.items())]  # fmt: skip
    return table(["step", "there are", "with a hold for it", "mean share of its best"], rows)


if __name__ == "__main__":
    print(tyro.cli(Holds).run())
