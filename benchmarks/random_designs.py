"""Random designs over the ranges that the field tables declare, under random commands: what is refused, what breaks.

    python benchmarks/random_designs.py --out runs/random_designs.jsonl --json benchmarks/results/random_designs.json

A quarter of the designs each has 1 to 3 fields anywhere in their ranges, one field at an end of its range, all fields
within sqrt(10) of the default either way, and all fields anywhere in their ranges; the others keep the preset's value.
Designs that the loader refuses are drawn again, and counted. Each one left is stepped through random commands at every
time step and audited once a command. Results are appended to --out, and a run that was stopped goes on from there.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tyro

from tensegym.design.design import PRESETS, Payload, RobotDesign
from tensegym.design.design_file import design_from_dict
from tensegym.errors import SimulationError, TensegymError
from tensegym.files import write_json
from tensegym.processes import process_map
from tensegym.report import table
from tensegym.robot.gait import AUDIT_TOLERANCE, GaitMeter
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.structure import PAPER_ROD_LENGTH, ROD_LENGTHS
from tensegym.tables import Range

KINDS = ("1 to 3 fields anywhere", "one field at an end", "all within a decade", "all anywhere")
ENDINGS = ("sound", "refused", "diverged, named", "audit broken, named", "audit broken, unnamed", "not finite, unnamed")
LEAST = 1e-3  # of the default, or of the high end where that is 0: the low end of a range that begins at 0


class Place(NamedTuple):
    """A number of a design: its group ("" for none) and field, range and the preset's value."""

    group: str
    field: str
    allowed: Range
    value: float


def places(design: RobotDesign) -> list[Place]:
    """Every number of a design with a range, and the rods' length."""
    found = [Place("structure", "rod_length", ROD_LENGTHS, PAPER_ROD_LENGTH)]
    for f in fields(design):
        held = getattr(design, f.name)
        if is_dataclass(held) and f.name != "structure":
            found += [Place(f.name, g.name, g.metadata["range"], getattr(held, g.name)) for g in fields(held)
                      if "range" in g.metadata and getattr(held, g.name) is not None]  # fmt: skip
        elif "range" in f.metadata:
            found.append(Place("", f.name, f.metadata["range"], held))
    return found


def draw(kind: str, rng: np.random.Generator) -> dict[str, Any]:
    """A design as its file would have it; it may be none that loads."""
    preset = str(rng.choice(list(PRESETS), p=[0.7, 0.2, 0.1]))
    data: dict[str, Any] = {"preset": preset}
    base = PRESETS[preset]()
    if rng.random() < 0.5:
        data["payload"], base = {}, design_from_dict({"preset": preset, "payload": {}}) if preset != "paper" else base
    every = places(base)
    if "payload" in data and base.payload is None:
        every += [Place("payload", g.name, g.metadata["range"], getattr(Payload(), g.name)) for g in fields(Payload)
                  if "range" in g.metadata and getattr(Payload(), g.name) is not None]  # fmt: skip
    few = {KINDS[0]: int(rng.integers(1, 4)), KINDS[1]: 1}.get(kind, len(every))
    for row in rng.choice(len(every), few, replace=False):
        place = every[row]
        value = _value(place, kind, rng)
        (data.setdefault(place.group, {}) if place.group else data)[place.field] = value
    return data


def _value(place: Place, kind: str, rng: np.random.Generator) -> float:
    low, high = place.allowed.low, place.allowed.high
    least = low if low > 0 else LEAST * (place.value or high)
    if kind == KINDS[1]:
        return float(rng.choice([least if place.allowed.open_low else low, high]))
    if kind == KINDS[2]:
        return float(np.clip(place.value * 10 ** rng.uniform(-0.5, 0.5), low, high))
    if high > 10 * least:
        return float(np.exp(rng.uniform(np.log(least), np.log(high))))
    return float(rng.uniform(low, high))


def run(item: tuple[int, int], *, commands: int, period: float, steps: tuple[float, ...]) -> dict[str, Any]:
    """Draw design ``item`` (its number, how many there are) until it loads, and run it at every time step."""
    number, count = item
    kind, rng = KINDS[number * len(KINDS) // count], np.random.default_rng([12, number])
    unloadable: list[str] = []
    while True:
        data = draw(kind, rng)
        try:
            design = design_from_dict(data)
            break
        except TensegymError as error:
            unloadable.append(str(error))
    ran = {f"{dt:g}": _ending(design, dt, commands, period, number) for dt in steps}
    return {"design": number, "kind": kind, "data": data, "unloadable": unloadable, "steps": ran}


def _ending(design: RobotDesign, dt: float, commands: int, period: float, seed: int) -> dict[str, Any]:
    try:
        robot = TensegrityRobot(design, dt=dt)
    except TensegymError as error:
        return {"ending": "refused", "told": str(error)}
    rng = np.random.default_rng(seed)
    with robot:
        meter = GaitMeter(robot, np.array([1.0, 0.0]))
        try:
            for _ in range(commands):
                robot.command(robot.angles_of(rng.uniform(-1, 1, len(robot.drives))))
                robot.step(round(period / dt))
                meter.update()
                if not np.isfinite(robot.poses_in_world).all() or not np.isfinite(robot.tensions).all():
                    return {"ending": "not finite, unnamed", "time": robot.time}
        except SimulationError as error:
            return {"ending": "diverged, named", "told": str(error), "time": robot.time}
        excess = meter.metrics().audit_excess
        if excess <= AUDIT_TOLERANCE:
            return {"ending": "sound", "excess": excess}
        return {"ending": "audit broken, " + ("named" if meter.fault else "unnamed"), "excess": excess,
                "told": meter.fault}  # fmt: skip


@dataclass(frozen=True)
class RandomDesigns:
    """What becomes of random designs."""

    out: Path
    """JSON lines, a design each; those in it are not run again."""
    designs: int = 300
    """How many that load."""
    commands: int = 300
    """Random commands a design and time step."""
    period: float = 0.4
    """Seconds a command."""
    steps: tuple[float, ...] = (1e-3, 2e-3)
    """Time steps [s]."""
    jobs: int = 2
    """Processes."""
    json: Path | None = None
    """Where the counts go."""

    def run(self) -> str:
        done = [json.loads(line) for line in self.out.read_text().splitlines()] if self.out.exists() else []
        left = [(n, self.designs) for n in range(self.designs) if n not in {row["design"] for row in done}]
        one = partial(run, commands=self.commands, period=self.period, steps=self.steps)
        with self.out.open("a") as file:
            for row in process_map(one, left, self.jobs, bar="designs", unit="design"):
                done.append(row)
                file.write(json.dumps(row) + "\n")
                file.flush()
        rows = list(_counted(done, self.steps))
        if self.json:
            settings = {"designs": len(done), "commands": self.commands, "period": self.period}
            write_json(self.json, settings | {"counts": [dict(zip(_header(), row, strict=True)) for row in rows]})
        return table(_header(), rows)


def _header() -> list[str]:
    return ["designs", "dt ms", "not loadable", *ENDINGS, "broke, of accepted", "unnamed, of accepted"]


def _counted(done: list[dict[str, Any]], steps: tuple[float, ...]) -> Iterator[list[object]]:
    for dt in steps:
        for kind in (*KINDS, "all"):
            own = [row for row in done if kind in (row["kind"], "all")]
            seen = Counter(row["steps"][f"{dt:g}"]["ending"] for row in own)
            accepted = len(own) - seen["refused"]
            parts = [sum(seen[e] for e in ENDINGS[first:]) / max(1, accepted) for first in (2, 4)]
            lost = sum(len(row["unloadable"]) for row in own)
            yield [kind, 1e3 * dt, lost, *(seen[e] for e in ENDINGS), *(f"{100 * part:.1f} %" for part in parts)]


if __name__ == "__main__":
    print(tyro.cli(RandomDesigns).run())
