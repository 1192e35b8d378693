"""A design for other tools: NTRT's YAML, and matrices. What drives and payloads it has they do not hold."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from itertools import count, groupby

import numpy as np

from tensegym.arrays import IntArray
from tensegym.design.design import RobotDesign
from tensegym.design.groups import group_names
from tensegym.design.parameters import ElasticCable

from .ntrt import PLAIN_RODS, UP
from .table import length_of


def ntrt_text(design: RobotDesign, units: str = "m") -> str:
    """An NTRT model of the standing design; rods as solid cylinders of their mass and radius. Groups are tags.

    Args:
        design: drives, payload and flexures are left out; NTRT's cables are actuators themselves.
        units: of lengths in the file, one of UNITS.
    """
    unit, structure = length_of(units), design.standing
    nodes = structure.nodes @ UP / unit
    lines = [f"# {design.name}: lengths in {units}, y up; masses in kg, forces in kg {units}/s^2", "nodes:"]
    lines += [f"  n{i}: [{', '.join(_number(x) for x in xyz + 0.0)}]" for i, xyz in enumerate(nodes, 1)]
    pairs, builders = ["pair_groups:"], ["builders:"]
    names = group_names(design.cables, structure.cables)
    cable_tags = _tags(names, [f"{pull:.9g}" for pull in design.rest_tensions.tolist()], "cables")
    for tag, rows in _alike(cable_tags):
        cable: ElasticCable = design.each_cable[rows[0]]
        pull = float(design.rest_tensions[rows[0]])
        pairs += _rows(tag, structure.cables[rows])
        builders += _builder(tag, "tgBasicActuatorInfo", {
            "stiffness": cable.stiffness, "damping": cable.damping,
            "pretension": 0.0 if np.isnan(pull) else pull / unit})  # fmt: skip
    kinds = [(design.rod(i), round(length, 9)) for i, length in enumerate(structure.rod_lengths.tolist())]
    names = group_names(design.rods, structure.rods)
    alike = _alike(_tags(names, kinds, PLAIN_RODS, cable_tags))
    for tag, rows in sorted(alike, key=lambda each: names[each[1][0]] != ""):  # those in no group are read first
        rod, length = design.rod(rows[0]), float(structure.rod_lengths[rows[0]]) / unit
        radius = rod.tube_outer_radius / unit
        pairs += _rows(tag, structure.rods[rows])
        builders += _builder(tag, "tgRodInfo", {"radius": radius, "density": rod.mass / (np.pi * radius**2 * length),
                                                "friction": design.friction})  # fmt: skip
    return "\n".join([*lines, *pairs, *builders, ""])


def _tags(names: Sequence[str], kinds: Sequence[Hashable], plain: str, taken: Sequence[str] = ()) -> list[str]:
    """One for each kind of member of each group: the group's name, or ``plain`` of those in none; with a number from
    the second kind on, as of the tensions of a group whose nodes are kept, or where the tag is taken."""
    used, made = {*names, *taken}, dict[tuple[str, Hashable], str]()
    for name, kind in zip(names, kinds, strict=True):
        if (name, kind) in made:
            continue
        own, first = name or plain, name not in {group for group, _ in made}
        free = first and own not in (taken if name else used)
        made[name, kind] = own if free else next(
            tag for number in count(2) if (tag := f"{own[:36]}-{number}") not in used
        )  # fmt: skip
        used.add(made[name, kind])
    return [made[member] for member in zip(names, kinds, strict=True)]


def _alike(tags: list[str]) -> list[tuple[str, list[int]]]:
    """Rows of each tag."""
    order = sorted(range(len(tags)), key=lambda row: (tags.index(tags[row]), row))
    return [(tag, list(rows)) for tag, rows in groupby(order, key=lambda row: tags[row])]


def _rows(tag: str, pairs: IntArray) -> list[str]:
    return [f"  {_key(tag)}:", *(f"    - [n{a}, n{b}]" for a, b in (pairs + 1).tolist())]


def _builder(tag: str, kind: str, parameters: dict[str, float]) -> list[str]:
    given = ", ".join(f"{name}: {_number(value)}" for name, value in parameters.items())
    return [f"  {_key(tag)}:", f"    class: {kind}", f"    parameters: {{{given}}}"]


def _key(tag: str) -> str:
    """In quotation marks what YAML 1.1 takes for a truth or for nothing."""
    return f'"{tag}"' if tag.lower() in ("y", "n", "yes", "no", "on", "off", "true", "false", "null") else tag


def _number(value: float) -> str:
    """As YAML 1.1 takes one: a mantissa with an exponent has a point."""
    text = f"{value:.12g}"
    return text if "." in text or "e" not in text else text.replace("e", ".0e")


def matrix_files(design: RobotDesign, units: str = "m") -> dict[str, str]:
    """Texts by name, as MOTES and TsgFEM have them: nodes.csv (3, n) in ``units``, rods.csv and cables.csv (m, n)."""
    structure = design.standing
    texts = {"nodes.csv": _csv(structure.nodes.T / length_of(units))}
    for name, pairs in (("rods", structure.rods), ("cables", structure.cables)):
        matrix = np.zeros((len(pairs), len(structure.nodes)))
        rows = np.arange(len(pairs))
        matrix[rows, pairs[:, 0]], matrix[rows, pairs[:, 1]] = -1, 1
        texts[f"{name}.csv"] = _csv(matrix)
    return texts


def _csv(matrix: np.ndarray) -> str:
    return "\n".join(",".join(f"{value:.12g}" for value in row) for row in matrix + 0.0) + "\n"
