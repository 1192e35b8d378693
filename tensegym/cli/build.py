"""`tensegym build`: a design from a builder of structures and its parameters."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Annotated, Any

import tyro

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict, save_design
from tensegym.design.groups import group_names
from tensegym.errors import InputError
from tensegym.files import check_file
from tensegym.report import Report, table
from tensegym.robot.standing import standing_verdict
from tensegym.structures import BUILDERS
from tensegym.tables import describe, show

from .fields import HEADER
from .options import Within


@dataclass(frozen=True)
class Build:
    """Build a tensegrity, say whether it stands, and write it as a design file. `--list` has the builders."""

    structure: Annotated[str, tyro.conf.Positional] = ""
    """Builder: prism, octahedron, truncated, tower, stack, spine, three_rod_robot."""
    out: Path | None = None
    """TOML file to write."""
    list: bool = False
    """Print the builders with their parameters, units and ranges."""
    rods: Annotated[int, Within(3, 60)] | None = None
    """Of a prism; of each stage of a tower or a stack."""
    length: Annotated[float, Within(0.02, 20.0, "m")] | None = None
    """Of the rods [m]: octahedron, truncated, tower, three_rod_robot."""
    radius: Annotated[float, Within(0.01, 10.0, "m")] | None = None
    """Of a prism's or a stack's polygons [m]."""
    height: Annotated[float, Within(0.01, 20.0, "m")] | None = None
    """Of a prism, or of each prism of a stack [m]."""
    twist: Annotated[float, Within(0.0, 180.0, "deg")] | None = None
    """Of a prism [deg]; default: the one in balance."""
    wound: str | None = None
    """A prism's cables that have drives: none, around, upright, across, all."""
    solid: str | None = None
    """That is truncated: tetrahedron, cube, octahedron, dodecahedron, icosahedron."""
    ratio: Annotated[float, Within(0.05, 20.0)] | None = None
    """Force density of a truncated solid's edges over that of its corners."""
    stages: Annotated[int, Within(1, 40)] | None = None
    """Prisms of a stack."""
    vertebrae: Annotated[int, Within(2, 40)] | None = None
    """Tetrahedra of a spine."""
    edge: Annotated[float, Within(0.02, 5.0, "m")] | None = None
    """Of a spine's tetrahedra [m]."""
    pitch: Annotated[float, Within(0.1, 0.95)] | None = None
    """Of a spine, as a part of a tetrahedron's height."""
    pretension: Annotated[float, Within(0.0, 1e4, "N")] = 10.0
    """Of the cables of the first group [N]."""

    def run(self) -> Report:
        if self.list or not self.structure:
            return _listed()
        if self.structure not in BUILDERS:
            raise InputError(f"structure = {show(self.structure)} is not one of {', '.join(BUILDERS)}")
        if self.out is not None:
            if self.out.suffix != ".toml":
                raise InputError(f"out = {str(self.out)!r} must end in .toml, as a design file does")
            check_file(self.out)
        own = {f.name for kind in BUILDERS.values() for f in fields(kind)}  # type: ignore[arg-type]
        given = {name: value for name, value in asdict(self).items() if name in own and value is not None}
        structure = {"builder": self.structure, **given}
        design = design_from_dict({"structure": structure, "elastic_cable": {"pretension": self.pretension}})
        report = described(design)
        if self.out is not None:
            save_design(design, self.out)
        return report


def described(design: RobotDesign) -> Report:
    """Size, groups of cables and verdict of a design."""
    structure, verdict = design.standing, standing_verdict(design)
    groups: dict[str, Any] = {}
    names = group_names(design.cables, structure.cables)
    for name in dict.fromkeys(names):
        rows = [row for row, other in enumerate(names) if other == name]
        lengths = structure.lengths(structure.cables[rows])
        groups[name or "elastic_cable"] = {"cables": len(rows), "shortest_m": lengths.min(), "longest_m": lengths.max(),
                        "tension_N": design.rest_tensions[rows].max()}  # fmt: skip
    size = {"nodes": len(structure.nodes), "rods": len(structure.rods), "drives": len(structure.stiff_cables),
            "rod_length_m": design.length, "mass_kg": design.mass}  # fmt: skip
    text = "\n\n".join([
        table(["design", *size], [[design.name, *size.values()]]),
        table(["cables", "number", "shortest m", "longest m", "tension N"],
              [[name, *group.values()] for name, group in groups.items()]),
        f"{design.name} {verdict.text}",
    ])  # fmt: skip
    return Report(text, {"design": design.name, **size, "cables": groups, "standing": verdict.as_dict()})


def _listed() -> Report:
    parts, data = list[str](), dict[str, Any]()
    for name, kind in BUILDERS.items():
        rows = [asdict(row) for row in describe(kind)]
        data[name] = rows
        first = " ".join((kind.__doc__ or "").split("\n\n")[0].split())
        parts.append(f"{name}: {first}\n" + table(HEADER, [[*row.values()] for row in rows]))
    return Report("\n\n".join(parts), data)
