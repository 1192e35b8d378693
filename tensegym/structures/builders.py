"""The builders by name, and a blueprint from a table."""

from __future__ import annotations

from typing import Any, Protocol

from tensegym.errors import StructureError
from tensegym.tables import as_text, fill, mapping, one_line, show

from .blueprint import Blueprint
from .octahedron import Octahedron
from .prism import Prism, ThreeRodRobot
from .spine import Spine
from .tower import Stack, Tower
from .truncated import Truncated


class Builder(Protocol):
    """A dataclass of parameters."""

    def build(self) -> Blueprint:
        """Nodes, rods and groups of cables. Raises StructureError where the parameters make none."""


BUILDERS: dict[str, type[Builder]] = {
    "prism": Prism, "octahedron": Octahedron, "truncated": Truncated, "tower": Tower, "stack": Stack, "spine": Spine,
    "three_rod_robot": ThreeRodRobot,
}  # fmt: skip


def blueprint(table: dict[str, Any], where: str = "structure") -> Blueprint:
    """From a table: ``builder`` and that builder's parameters, as in {"builder": "prism", "rods": 4}.

    Raises StructureError for an unknown builder, and for parameters that it does not have or that leave their range.
    """
    return _builder(table, where).build()


def parameters(table: dict[str, Any], where: str = "structure") -> dict[str, Any]:
    """The table with every default of its builder. Raises as `blueprint`."""
    return {"builder": table["builder"], **vars(_builder(table, where))}


def _builder(table: dict[str, Any], where: str) -> Builder:
    rest = dict(mapping(table, where, StructureError))
    name = as_text(rest.pop("builder", None), f"{where}.builder", StructureError)
    if name not in BUILDERS:
        raise StructureError(one_line(f"{where}.builder = {show(name)} is not one of {', '.join(BUILDERS)}"))
    return fill(BUILDERS[name], rest, where, StructureError)
