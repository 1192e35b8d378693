"""[structure] builder = "prism": a design's table with what a builder makes written out.

    [structure]
    builder = "prism"                 # of tensegym.structures, with its parameters: `tensegym build --list`
    rods = 4
    height = 0.9
    [cables.upright]                  # a group that the builder names: its pairs and its share of the pretension are
    stiffness = 500.0                 # the builder's where they are not given
"""

from __future__ import annotations

from typing import Any

from tensegym.errors import DesignError
from tensegym.structures import Blueprint, blueprint
from tensegym.tables import as_number, mapping

from .parameters import ElasticCable


def written_out(data: dict[str, Any], cable: ElasticCable) -> dict[str, Any]:
    """The table of a design file with nodes, members and groups in place of a builder; itself where it names none.

    Args:
        data: as a design file gives it.
        cable: what its elastic cables are where it does not say.

    Raises:
        StructureError: the builder, or what it is to build, cannot be.
    """
    structure = data.get("structure")
    if not isinstance(structure, dict) or "builder" not in structure:
        return data
    plan = blueprint(structure)
    members = {"rods": plan.rods, "cables": plan.all_cables, "stiff_cables": plan.stiff_cables}
    tables = {name: (pairs + 1).tolist() for name, pairs in members.items()}
    groups = _groups(plan, data, cable)
    return {"name": plan.name, **data, "structure": {"nodes": plan.nodes.tolist(), **tables},
            **({"cables": groups} if groups else {})}  # fmt: skip


def _groups(plan: Blueprint, data: dict[str, Any], cable: ElasticCable) -> dict[str, Any]:
    """[cables] of the table, with the builder's groups; one alone needs none."""
    common = mapping(data.get("elastic_cable", {}), "elastic_cable", DesignError)
    given = {name: mapping(own, f"cables.{name}", DesignError)
             for name, own in mapping(data.get("cables", {}), "cables", DesignError).items()}  # fmt: skip
    pretension = as_number(common.get("pretension", cable.pretension), "elastic_cable.pretension", DesignError)
    prestressed = common.get("natural_length", cable.natural_length) is None
    for name, pairs in plan.cables.items():
        own = given.get(name)
        if own is None and len(plan.cables) == 1:
            continue
        found: dict[str, Any] = {"pairs": (pairs + 1).tolist()}
        if plan.tensions and prestressed and "natural_length" not in (own or {}):
            found["pretension"] = pretension * plan.tensions[name]
        given[name] = found | (own or {})
    return given
