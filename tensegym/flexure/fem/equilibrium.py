"""Equilibrium states of a hinge under rotation, load or wrench control."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.hinge.ranges import check_not_negative, number_array

from . import newton
from .mesh import ELEMENTS, mesh_of
from .path import sweep
from .solution import Solution


def rotate(
    hinge: Hinge, theta: ArrayLike, *, force: ArrayLike = (0.0, 0.0), direction: ArrayLike = (0.0, 0.0, 1.0),
    elements: int = ELEMENTS, from_rest: bool = False, keep_nodes: bool = False,
) -> Solution:  # fmt: skip
    """Rotation control: the tip body turned to theta, and the multiple of a wrench that holds it there.

    Args:
        hinge: what is turned.
        theta: (n,) [rad], in [-2 pi, 2 pi].
        force: (2,) or (n, 2) dead force at the tip besides, base axes [N].
        direction: (3,) or (n, 3) force x, y and moment about the tip, scaled as needed; the default is a pure moment.
            See ``arm_direction`` for a force at a lever's end.
        elements: of a leaf as long as the hinge.
        from_rest: each state by its own path from rest, else from the state before.
        keep_nodes: fill ``Solution.nodes``.

    Raises:
        FlexureError: for shapes that do not fit, values that are not finite, an angle out of range, a direction
            without a moment.
    """
    theta = _rows(theta, (), "theta")
    cases = np.zeros((len(theta), 8))
    cases[:, newton.THETA] = theta
    cases[:, newton.FX : newton.FY + 1] = _rows(force, (2,), "force", len(theta))
    cases[:, newton.WX : newton.WM + 1] = _rows(direction, (3,), "direction", len(theta))
    if (np.abs(theta) > 2 * math.pi).any():
        raise FlexureError(f"theta = {np.abs(theta).max():g} rad is outside [-2 pi, 2 pi]")
    if (cases[:, newton.WM] == 0).all():
        raise FlexureError("direction has no moment in any row: it cannot hold a rotation; give a moment or an arm")
    return _solve(hinge, newton.ROTATION, cases, elements, from_rest, keep_nodes)


def arm_direction(theta: ArrayLike, arm: float, follows: bool = False) -> FloatArray:
    """Unit force across a lever beyond the tip, as a direction for ``rotate``.

    Args:
        theta: (n,) [rad].
        arm: the lever's length beyond the tip [m].
        follows: the force stays perpendicular to the lever; else it keeps the base's y direction (a guide).

    Returns:
        (n, 3) force x, y and moment about the tip.
    """
    angle = _rows(theta, (), "theta")
    if follows:
        return np.column_stack([-np.sin(angle), np.cos(angle), np.full(len(angle), arm)])
    return np.column_stack([np.zeros(len(angle)), np.ones(len(angle)), arm * np.cos(angle)])


def apply_wrench(
    hinge: Hinge, wrench: ArrayLike, *, arm: float = 0.0, elements: int = ELEMENTS, from_rest: bool = True,
    keep_nodes: bool = False,
) -> Solution:  # fmt: skip
    """Wrench control: dead loads, applied from rest in proportion. Load control is a zero moment.

    Args:
        hinge: what is loaded.
        wrench: (3,) or (n, 3) dead force x, y [N] in base axes and moment [N m].
        arm: the force acts this far beyond the tip along the tip body's x [m]; 0: at the tip.
        elements, from_rest, keep_nodes: as ``rotate``.

    Raises:
        FlexureError: for a shape that does not fit or values that are not finite.
    """
    check_not_negative("arm", arm, "m")
    wrench = _rows(np.atleast_2d(number_array(wrench, "wrench")), (3,), "wrench")
    cases = np.zeros((len(wrench), 8))
    cases[:, newton.FX : newton.MZ + 1] = wrench
    cases[:, newton.ARM] = arm
    return _solve(hinge, newton.LOAD, cases, elements, from_rest, keep_nodes)


def _rows(value: ArrayLike, tail: tuple[int, ...], name: str, count: int | None = None) -> FloatArray:
    """(n, *tail) array, or (count, *tail) by broadcasting. Raises FlexureError that names ``name``."""
    array = number_array(value, name)
    if count is not None:
        try:
            array = np.broadcast_to(array, (count, *tail))
        except ValueError:
            raise FlexureError(f"{name} has shape {array.shape}; give {tail} or {(count, *tail)}") from None
    elif not tail:
        array = np.atleast_1d(array)
    if array.shape[1:] != tail or array.ndim != 1 + len(tail):
        raise FlexureError(f"{name} has shape {array.shape}; give (n{''.join(f', {t}' for t in tail)})")
    if not np.isfinite(array).all():
        row = int(np.argwhere(~np.isfinite(array))[0, 0])
        raise FlexureError(f"{name} has a value that is not finite, in row {row}")
    return array


def _solve(hinge: Hinge, mode: int, cases: FloatArray, elements: int, from_rest: bool, keep_nodes: bool) -> Solution:
    results, status, stable, nodes = sweep(mesh_of(hinge, elements), mode, cases, from_rest, keep_nodes)
    return Solution(results[:, 0], results[:, 1:3], results[:, 3:5], results[:, 5], results[:, 6], status, stable,
                    results[:, 7], nodes)  # fmt: skip
