"""A design for other tools: NTRT's YAML, and matrices. What drives and payloads it has they do not hold."""

from __future__ import annotations

from itertools import groupby

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.design import RobotDesign
from tensegym.design.groups import group_names
from tensegym.design.parameters import ElasticCable, Rod

from .ntrt import UP
from .table import length_of


def ntrt_text(design: RobotDesign, units: str = "m") -> str:
    """An NTRT model of the standing design; rods as solid cylinders of their mass and radius.

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
    tags = [f"cable_{name}" if name else "cables" for name in names]
    for tag, rows in _alike(_by_tension(tags, design.rest_tensions)):
        cable: ElasticCable = design.each_cable[rows[0]]
        pull = float(design.rest_tensions[rows[0]])
        pairs += _rows(tag, structure.cables[rows])
        builders += _builder(tag, "tgBasicActuatorInfo", {
            "stiffness": cable.stiffness, "damping": cable.damping,
            "pretension": 0.0 if np.isnan(pull) else pull / unit})  # fmt: skip
    kinds = [f"rod_{kind}" for kind in _numbers([(design.rod(i), round(length, 9))
             for i, length in enumerate(structure.rod_lengths.tolist())])]  # fmt: skip
    for tag, rows in _alike(kinds):
        rod, length = design.rod(rows[0]), float(structure.rod_lengths[rows[0]]) / unit
        radius = rod.tube_outer_radius / unit
        pairs += _rows(tag, structure.rods[rows])
        builders += _builder(tag, "tgRodInfo", {"radius": radius, "density": rod.mass / (np.pi * radius**2 * length),
                                                "friction": design.friction})  # fmt: skip
    return "\n".join([*lines, *pairs, *builders, ""])


def _by_tension(tags: list[str], tensions: FloatArray) -> list[str]:
    """A tag of its own for each tension of a group, as cables have whose nodes are kept."""
    unlike: dict[str, list[str]] = {}
    made = []
    for tag, tension in zip(tags, tensions.tolist(), strict=True):
        seen, pull = unlike.setdefault(tag, []), f"{tension:.9g}"
        if pull not in seen:
            seen.append(pull)
        made.append(f"{tag}-{seen.index(pull) + 1}" if seen.index(pull) else tag)
    return made


def _numbers(values: list[tuple[Rod, float]]) -> list[int]:
    """From 1, the same for equal ones."""
    unlike = list(dict.fromkeys(values))
    return [unlike.index(value) + 1 for value in values]


def _alike(tags: list[str]) -> list[tuple[str, list[int]]]:
    """Rows of each tag."""
    order = sorted(range(len(tags)), key=lambda row: (tags.index(tags[row]), row))
    return [(tag, list(rows)) for tag, rows in groupby(order, key=lambda row: tags[row])]


def _rows(tag: str, pairs: IntArray) -> list[str]:
    return [f"  {tag}:", *(f"    - [n{a}, n{b}]" for a, b in (pairs + 1).tolist())]


def _builder(tag: str, kind: str, parameters: dict[str, float]) -> list[str]:
    given = ", ".join(f"{name}: {_number(value)}" for name, value in parameters.items())
    return [f"  {tag}:", f"    class: {kind}", f"    parameters: {{{given}}}"]


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
