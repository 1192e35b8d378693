"""Prestress: the shape in which a design's cables are in balance, and their tensions there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import DesignError
from tensegym.structure.equilibrium import check_balance, holding_tensions
from tensegym.structure.form_finding import Found, find_form
from tensegym.structure.rod_balance import Kept, Law
from tensegym.structure.structure import Structure

from .groups import Group, column, group_names
from .parameters import ElasticCable, Keep

LEVEL = 1e-6  # of the longest rod: nodes no farther than this from the lowest or highest one are at its height


def prestressed(
    given: Structure, cables: Sequence[ElasticCable], groups: Sequence[Group], keep: Keep | None, moves: bool,
    payload_tension: float,
) -> Found:  # fmt: skip
    """The structure at rest under its cables (c,), and their tensions; NaN of those that have a natural length and are
    not in balance: as given, or where all have one.

    Args:
        given: the nodes as given.
        cables: what each elastic cable is.
        groups: whose tensions change where something is kept.
        keep: what does not move.
        moves: whether form finding may move nodes; else they must balance as given.
        payload_tension: of the payload's springs [N].

    Raises:
        StructureError, ShapeError: nodes that do not balance, or where no shape does.
        DesignError: what is kept names nodes that there are not.
    """
    natural = np.array([np.nan if cable.natural_length is None else cable.natural_length for cable in cables])
    if len(cables) and not np.isnan(natural).any():
        return Found(given, np.full(len(cables), np.nan))
    law = _law(cables, natural)
    tensions = law.base + law.slope * given.lengths(given.cables)
    if keep is not None and keep.shape:
        return Found(given, holding_tensions(given, tensions, payload_tension))
    if not moves:
        if np.isnan(natural).all():
            check_balance(given, tensions)
        return Found(given, np.where(np.isnan(natural), tensions, np.nan))
    return find_form(given, law, payload_tension, _kept(given, groups, keep) if keep else None)


def _law(cables: Sequence[ElasticCable], natural: FloatArray) -> Law:
    base, slope = column(cables, "pretension"), np.zeros(len(cables))
    for row, cable in enumerate(cables):
        if cable.natural_length is not None:
            base[row], slope[row] = -cable.stiffness * natural[row], cable.stiffness
        elif cable.force_density is not None:
            base[row], slope[row] = 0.0, cable.force_density
    return Law(base, slope)


def _kept(given: Structure, groups: Sequence[Group], keep: Keep) -> Kept | None:
    pairs = np.array(keep.lengths, dtype=np.int64).reshape(-1, 2) - 1
    nodes = np.array(keep.nodes, dtype=np.int64) - 1
    for node in (*nodes.tolist(), *pairs.ravel().tolist()):
        if not 0 <= node < len(given.nodes):
            raise DesignError(f"keep: there is no node {node + 1}; give numbers from 1 to {len(given.nodes)}")
    places = [np.column_stack([np.repeat(nodes, 3), np.tile(np.arange(3), len(nodes))])]
    if keep.height:
        heights, near = given.nodes[:, 2], LEVEL * given.rod_lengths.max()
        ends = np.flatnonzero((heights < heights.min() + near) | (heights > heights.max() - near))
        ends = np.setdiff1d(ends, nodes)
        places.append(np.column_stack([ends, np.full(len(ends), 2)]))
    if not len(pairs) and not sum(map(len, places)):
        return None
    return Kept(np.concatenate(places), pairs, *_factors(given.cables, groups))


def _factors(cables: IntArray, groups: Sequence[Group]) -> tuple[IntArray, bool]:
    """Which factor each cable has, and whether these are level: a group has one where there are others to compare it
    with, else every cable has one."""
    names = group_names(groups, cables)
    kinds = sorted({name for name in names if name})
    if not kinds:
        return np.arange(len(cables)), True
    return np.array([kinds.index(name) if name else -1 for name in names], dtype=np.int64), "" not in names


def check_stretch(cables: Sequence[ElasticCable], tensions: FloatArray, rest: FloatArray, natural: FloatArray) -> None:
    """Raise DesignError, naming the worst, where cables of lengths at rest (c,) [m] have no natural length (c,) [m]."""
    broken = np.flatnonzero(natural <= 0)
    if len(broken):
        worst = broken[np.argmin(rest[broken])]
        limit = cables[worst].stiffness * rest[worst]
        raise DesignError(
            f"ElasticCable.pretension = {float(tensions[worst])!r} stretches a cable of {rest[worst]:.4g} m "
            f"from nothing; at stiffness {cables[worst].stiffness:g} N/m it must be below {limit:.4g} N"
        )
