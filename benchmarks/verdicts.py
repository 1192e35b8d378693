"""Verdicts on 60 robots drawn at random, against 3 s of simulation from every face, and against statics.

    python benchmarks/verdicts.py --out benchmarks/results/verdicts.json

A verdict is `tensegym.standing_verdict`'s kind: stands, sags or falls; or flat or unstable, where the design is refused
for its shape. It is checked by code of its own: the robot is let go on every face that the centre of mass is above, at
1 ms, as its user would, and with explicit forces at 0.5 ms or less. (A verdict steps at up to 4 ms, on one of the faces
that are alike.) What was refused is built all the same and flies for 3 s without gravity, from its shape at rest with
small random velocities: a flat one must stay flat, with less than half of the volume of its given nodes, an unstable
one must leave its shape by more than a tenth of a rod, and robots that were accepted must keep theirs.

The verdict is also made in MuJoCo, another engine (extra mujoco). Statics (lowest_energy.py) say what would become of
the robot if its weight were let on slowly, rods passed through one another, and feet slid freely or those it stands on
first not at all.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple
from unittest.mock import patch

import numpy as np
import tyro
from lowest_energy import lowest_energy
from random_structures import (
    Table,
    cables_and_masses,
    log_uniform,
    random_body,
    random_octahedron,
    random_prism,
    random_twelve_rods,
)
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from timing import machine
from tqdm import tqdm

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.design.shape import FLAT
from tensegym.errors import DesignError, SimulationError, TensegymError
from tensegym.files import write_json
from tensegym.report import table
from tensegym.robot.fallen import FALLEN
from tensegym.robot.robot import TensegrityRobot
from tensegym.robot.standing import SAGS, Verdict, standing_verdict
from tensegym.structure.faces import face_by_nodes, hull_faces

SECONDS, BREATH, LOOKS = 3.0, 1.0, 20  # s, s, times: displacements are means over the last second
WAYS: dict[str, tuple[float, Literal["auto", "explicit"]]] = {"1 ms": (1e-3, "auto"), "0.5 ms": (5e-4, "explicit")}
JOGGLE = 1e-3  # rod lengths, of the nodes of a flat figure
PUSH = 0.02  # m/s and, over half a rod, rad/s: of the random velocities in free flight
KINDS = ("stands", "sags", "falls", "flat", "unstable")
FAMILIES = {"prism": 30, "octahedron": 12, "random body": 8, "twelve rods": 4, "split rods": 3, "preset": 3}


class Drawn(NamedTuple):
    """One robot. verdict: None where it was refused for its shape, with ``kind`` saying why."""

    family: str
    table: Table
    kind: str
    verdict: Verdict | None
    seconds: float


def draw(seed: int, parts: dict[str, int]) -> tuple[list[Drawn], Counter[str]]:
    """Robots of every family, and how many draws of each were left out: no shape found, or a tension out of range."""
    rng, found, left_out = np.random.default_rng(seed), list[Drawn](), Counter[str]()
    presets = iter(("six_rod", "six_rod_flexible", "paper"))
    for family, count in parts.items():
        number = 0
        while number < count:
            made = _table(rng, family, number, presets)
            drawn = judged(family, made) if made else None
            if drawn is None:
                left_out[family] += 1
                continue
            found.append(drawn)
            number += 1
    return found, left_out


def _table(rng: np.random.Generator, family: str, number: int, presets: Iterator[str]) -> Table | None:
    if family == "preset":
        return {"preset": next(presets)}
    if family == "split rods":
        return {"preset": "six_rod_flexible",
                "elastic_cable": {"pretension": log_uniform(rng, 1, 30), "stiffness": log_uniform(rng, 150, 2000)},
                "passive_rod": {"end_mass": log_uniform(rng, 0.01, 0.4)}}  # fmt: skip
    makers = {"prism": lambda r: random_prism(r, 3 + number % 6), "octahedron": random_octahedron,
              "random body": random_body, "twelve rods": random_twelve_rods}  # fmt: skip
    made = makers[family](rng)
    return made and {**made, **cables_and_masses(rng)}


def judged(family: str, made: Table) -> Drawn | None:
    """The project's verdict on a table; None where it is refused for something other than its shape."""
    began = time.process_time()
    try:
        verdict = standing_verdict(design_from_dict(made))
        return Drawn(family, made, verdict.kind, verdict, time.process_time() - began)
    except TensegymError as error:
        words = {"flat": "flattens", "unstable": "does not hold"}
        kind = next((kind for kind, word in words.items() if word in str(error)), None)
        return Drawn(family, made, kind, None, time.process_time() - began) if kind else None


def volume(nodes: FloatArray) -> float:
    return float(ConvexHull(nodes, qhull_options="QJ").volume)


def displaced(rest: FloatArray, nodes: FloatArray) -> float:
    """Largest distance of a node from its place at rest after the best rigid motion, by Kabsch's algorithm [m]."""
    goal, now = rest - rest.mean(axis=0), nodes - nodes.mean(axis=0)
    left, _, right = np.linalg.svd(now.T @ goal)
    turn = left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right))]) @ right
    return float(np.linalg.norm(now @ turn - goal, axis=1).max())


def become(rest: FloatArray, last: Sequence[FloatArray], length: float) -> str:
    """What a robot has become whose nodes were at rest, by where they are at its last moments."""
    if not np.isfinite(last).all() or volume(last[-1]) < FALLEN * volume(rest):
        return "falls"
    return "sags" if np.mean([displaced(rest, nodes) for nodes in last]) > SAGS * length else "stands"


def worst(kinds: Iterable[str]) -> str:
    return max(kinds, key=KINDS.index)


def let_go(design: RobotDesign, way: str, only: Sequence[str] = ()) -> dict[str, str]:
    """What becomes of a robot on every face that its centre of mass is above, or on some, by the face's name."""
    found = {}
    with simulated(design, way) as robot:
        for face, name in enumerate(robot.faces.names()):
            robot.reset(face)
            start = robot.node_positions_in_world()
            above = is_inside(robot.centre_of_mass_in_world()[:2], start[robot.faces.triangles[face], :2])
            if name in only or (above and not only):
                last = []
                try:
                    robot.step(round((SECONDS - BREATH) / robot.dt))
                    for _ in range(LOOKS):
                        robot.step(round(BREATH / LOOKS / robot.dt))
                        last.append(robot.node_positions_in_world())
                except SimulationError:
                    last.append(np.full_like(start, np.nan))
                found[name] = become(start, last, design.length)
    return found


def simulated(design: RobotDesign, way: str, ground: bool = True) -> TensegrityRobot:
    """A robot at the way's time step, or at half of it or a quarter ... where it is refused at that."""
    dt, integrator = WAYS[way]
    while dt > 1e-5:
        with suppress(DesignError):
            return TensegrityRobot(design, dt=dt, integrator=integrator, ground=ground)
        dt /= 2
    raise DesignError(f"{design.name} at no time step")


def is_inside(point: FloatArray, corners: FloatArray) -> bool:
    """Whether a point (2,) is in or on a triangle (3, 2), to a millimetre squared."""
    sides = np.roll(corners, -1, axis=0) - corners
    areas = sides[:, 0] * (point - corners)[:, 1] - sides[:, 1] * (point - corners)[:, 0]
    return bool(areas.min() > -1e-6 or areas.max() < 1e-6)


def fly(made: Table, way: str) -> str:
    """What becomes of a robot without gravity: flat, unstable, or holds."""
    with patch("tensegym.design.design.check_shape"):
        design = design_from_dict(made)
    rng, given, rest = np.random.default_rng(0), design.structure.nodes, design.standing.nodes
    centred = rest - rest.mean(axis=0)
    flat = np.ptp(centred @ np.linalg.svd(centred)[2][-1]) < FLAT * design.length
    if flat:  # a robot wants some volume, to have faces
        joggled = design.standing.with_nodes(rest + rng.normal(size=rest.shape) * JOGGLE * design.length)
        object.__setattr__(design, "_standing", joggled)
    with simulated(design, way, ground=False) as robot:
        push = rng.uniform(-PUSH, PUSH, (len(robot.model.masses), 6))
        push[:, 3:] /= design.length / 2
        robot.reset_rotated(Rotation.identity(), push)
        robot.step(round(SECONDS / robot.dt))
        nodes = robot.node_positions_in_world()
    if flat:
        return "flat" if volume(nodes) < FALLEN * volume(given) else "rises"
    return "unstable" if displaced(rest, nodes) > SAGS * design.length else "holds"


def pretension_holds(verdict: Verdict, way: str) -> bool | None:
    """Whether a robot stands with 5 % more than its least pretension on all faces it may, and not with 15 % less; None
    where it stands at the lowest one tried, or at none."""
    holding, design = verdict.holding, verdict.design
    if not holding or not holding.least or holding.least == holding.lowest:
        return None
    faces = [name for face in verdict.faces for name in face.names if name not in holding.never]
    falls = []
    for factor in (1.05, 0.85):
        cable = replace(design.elastic_cable, pretension=factor * holding.least)
        try:
            falls.append("falls" in let_go(design.with_(elastic_cable=cable), way, faces).values())
        except TensegymError:  # a robot that cannot be built does not stand
            falls.append(True)
    return falls == [False, True]


def statics(verdict: Verdict) -> dict[str, str]:
    """Worst kind over the faces, with feet that slide and with feet that grip."""
    design = verdict.design
    faces, rest = hull_faces(design.standing), design.standing.nodes
    triangles = [faces.triangles[face_by_nodes(faces, face.names[0])] for face in verdict.faces]
    return {name: worst(become(rest, [lowest_energy(design, t, grip)], design.length) for t in triangles)
            for name, grip in (("sliding", False), ("gripping", True))}  # fmt: skip


def checked(drawn: Drawn) -> dict[str, Any]:
    """One robot's row."""
    with patch("tensegym.design.design.check_shape"):
        design = design_from_dict(drawn.table)
    cable = design.elastic_cable
    row: dict[str, Any] = {
        "family": drawn.family, "rods": len(design.structure.rods), "mass_kg": design.mass, "length_m": design.length,
        "pretension_N": cable.pretension, "stiffness_N_per_m": cable.stiffness, "verdict": drawn.kind,
        "seconds": drawn.seconds,
    }  # fmt: skip
    if drawn.verdict is None:
        return row | {way: fly(drawn.table, way) for way in WAYS}
    faces = {name: "falls" if face.fell else "sags" if face.sag > SAGS * design.length else "stands"
             for face in drawn.verdict.faces for name in face.names}  # fmt: skip
    found = {way: let_go(design, way) for way in WAYS}
    row |= {way: worst(kinds.values()) for way, kinds in found.items()} | {"faces": faces, "simulated_faces": found}
    if np.isfinite(design.shape.least_stiffness):
        row["in_flight"] = fly(drawn.table, "1 ms")
    with suppress(SimulationError):  # where it is not installed
        row["in_mujoco"] = standing_verdict(design, "mujoco", pretension=False).kind
    row["least_pretension_N"] = drawn.verdict.holding and drawn.verdict.holding.least
    row["least_pretension_confirmed"] = pretension_holds(drawn.verdict, "1 ms")
    return row | {f"statics_{name}": kind for name, kind in statics(drawn.verdict).items()}


@dataclass(frozen=True)
class Verdicts:
    """Verdicts on random robots against simulation and statics."""

    seed: int = 0
    """Of the draws."""
    scale: float = 1.0
    """Part of the 60."""
    out: Path | None = None
    """JSON to write."""

    def run(self) -> str:
        parts = {family: max(1, round(self.scale * count)) for family, count in FAMILIES.items() if family != "preset"}
        found, left_out = draw(self.seed, {**parts, "preset": FAMILIES["preset"]})
        rows = [checked(drawn) for drawn in tqdm(found, unit="robot", file=sys.stderr)]
        if self.out:
            write_json(self.out, {"machine": machine(), "seed": self.seed, "left_out": left_out, "rows": rows})
        return report(rows, left_out)


def report(rows: list[dict[str, Any]], left_out: Counter[str]) -> str:
    """Verdicts against both simulations, and what else there is to say."""
    text = ""
    for way in WAYS:
        pairs = Counter((row["verdict"], row[way]) for row in rows)
        seen = sorted({row[way] for row in rows}, key=lambda kind: KINDS.index(kind) if kind in KINDS else len(KINDS))
        text += table([f"verdict, against {way}", *seen], [[kind, *(pairs[kind, other] for other in seen)]
                                                           for kind in KINDS])  # fmt: skip
        text += f"\n{sum(row['verdict'] == row[way] for row in rows)} of {len(rows)} agree\n\n"
    for row in rows:
        others = [row[way] for way in WAYS]
        if set(others) != {row["verdict"]}:
            text += f"  {row['family']} of {row['rods']} rods: {row['verdict']}, simulated {' and '.join(others)}\n"
    still = [row for row in rows if "faces" in row]
    for way in WAYS:
        pairs = Counter((kind, row["simulated_faces"][way].get(name)) for row in still
                        for name, kind in row["faces"].items())  # fmt: skip
        text += f"face by face {sum(n for (a, b), n in pairs.items() if a == b)} of {pairs.total()} agree with {way}\n"
    confirmed = [row.get("least_pretension_confirmed") for row in rows]
    held = [row["in_flight"] for row in rows if "in_flight" in row]
    certain = [row for row in still if row["statics_sliding"] == row["statics_gripping"]]
    text += f"least pretension: {confirmed.count(True)} of {confirmed.count(True) + confirmed.count(False)} confirmed\n"
    text += f"in flight {held.count('holds')} of {len(held)} accepted robots hold their shape\n"
    other = [row for row in still if "in_mujoco" in row]
    text += f"MuJoCo's verdict is the same for {sum(r['in_mujoco'] == r['verdict'] for r in other)} of {len(other)}\n"
    for row in other:
        if row["in_mujoco"] != row["verdict"]:
            text += f"  {row['family']} of {row['rods']} rods {row['verdict']}, in MuJoCo {row['in_mujoco']}\n"
    text += f"statics: {sum(row['statics_sliding'] == row['verdict'] for row in certain)} of the {len(certain)} whose "
    text += f"feet do not matter agree, of {len(still)}\n"
    for row in certain:
        if row["statics_sliding"] != row["verdict"]:
            text += f"  {row['family']} of {row['rods']} rods {row['verdict']}, in statics {row['statics_sliding']}\n"
    spent = [row["seconds"] for row in rows]
    text += f"a verdict took {np.median(spent):.2f} s of processor time, at most {max(spent):.2f} s\n"
    return text + f"draws that were no robot: {sum(left_out.values())} ({dict(left_out)})"


if __name__ == "__main__":
    print(tyro.cli(Verdicts).run())
