"""S1 to S7: the six-rod robot's self-stress, its cables and rods at rest, its mechanisms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tensegym.errors import StructureError
from tensegym.structure.equilibrium import check_balance, count_states, feasible_self_stress
from tensegym.structure.form_finding import form_find
from tensegym.structure.structure import Structure, paper, six_rod

from .check import Check, furthest


def rows(engine: str = "pybullet") -> Iterator[Check]:
    """S1 to S7: the six-rod self-stress; no engine takes part."""
    unit = paper().nodes / 0.7016
    found = form_find(paper().with_nodes(unit), 10.0)
    spacing = np.linalg.norm(found.nodes[found.rods].mean(axis=1)[1] - found.nodes[found.rods].mean(axis=1)[0])
    yield Check("S1", "pair spacing / L, form-found from the paper's nodes", 0.5, float(spacing), 1e-9)
    cables = found.lengths(found.cables)
    yield Check("S2", "cable / L, the one furthest off", np.sqrt(6) / 4, furthest(cables, np.sqrt(6) / 4), 1e-6)
    exact = six_rod(1.0)
    elastic = count_states(exact)
    density = elastic.basis[:, 0]
    yield Check("S3", "force density rod / cable, furthest off", -1.5,
                furthest(np.divide.outer(density[24:], density[:24]).ravel(), -1.5), 1e-9)  # fmt: skip
    ratio = density[24:, None] * 1.0 / (density[:24] * np.sqrt(6) / 4)
    yield Check("S4", "force rod / cable, furthest off", -np.sqrt(6), furthest(ratio.ravel(), -np.sqrt(6)), 1e-9)
    yield Check("S5", "rank, 24 cables and 6 rods", 29, elastic.rank, 0)
    yield Check("S5", "self-stress states", 1, elastic.self_stress_states, 0)
    yield Check("S5", "mechanisms", 1, elastic.mechanisms, 0)
    all_members = count_states(exact, stiff=True)
    yield Check("S6", "self-stress states with the 6 stiff cables", 6, all_members.self_stress_states, 0)
    yield Check("S6", "mechanisms with them", 0, all_members.mechanisms, 0)
    yield Check("S6", "all 30 cables can pull at once (1 yes, 0 no)", 0,
                float(feasible_self_stress(exact, stiff=True) is not None), 0)  # fmt: skip
    off = count_states(paper())
    yield Check("S7", "self-stress states at the paper's spacing", 0, off.self_stress_states, 0)
    yield Check("S7", "mechanisms at the paper's spacing", 0, off.mechanisms, 0)
    yield Check("S7", "the paper's nodes hold a prestress (1 yes, 0 no)", 0, float(_balances(paper())), 0)


def _balances(structure: Structure) -> bool:
    try:
        check_balance(structure, 10.0)
    except StructureError:
        return False
    return True
