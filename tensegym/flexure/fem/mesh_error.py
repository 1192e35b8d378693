"""How far a mesh is from the converged answer, by the mesh of half its elements' length, and which mesh would do.

Halving tells the error of the coarser mesh: where the error falls as h^p, the difference is 1 - 2^-p of it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from tensegym.flexure.hinge import Hinge

from .equilibrium import apply_wrench, rotate
from .mesh import ELEMENTS
from .path import CONVERGED
from .solution import Solution

TIP, TURN, MOMENT = 1e-4, 1e-4, 1e-3
"""Accepted: of the tip as a share of L, of the turn [rad], of the moment as a share of the largest."""
FINEST = 256


def turn_error(hinge: Hinge, angle: float, elements: int = ELEMENTS) -> float:
    """Error of a mesh at a pure moment and at a force across the tip, both to ``angle`` [rad], of what is accepted.

    NaN where the hinge cannot be turned that far by both.
    """
    reach = angle * np.array([0.5, 1.0])
    across = (0.0, 1.0, 0.5 * hinge.length)
    return max(_apart(rotate(hinge, reach, direction=way, elements=elements),
                      rotate(hinge, reach, direction=way, elements=2 * elements), hinge.length)
               for way in ((0.0, 0.0, 1.0), across))  # fmt: skip


def load_error(hinge: Hinge, wrench: ArrayLike, elements: int = ELEMENTS) -> float:
    """Error of a mesh under dead loads, as ``apply_wrench`` takes them, of what is accepted."""
    return _apart(apply_wrench(hinge, wrench, elements=elements), apply_wrench(hinge, wrench, elements=2 * elements),
                  hinge.length)  # fmt: skip


def too_coarse(hinge: Hinge, angle: float, elements: int = ELEMENTS) -> str:
    """One line that says how far off a mesh is up to ``angle`` [rad] and which to take; empty where it is fine."""
    return _advice(elements, lambda count: turn_error(hinge, angle, count))


def too_coarse_for(hinge: Hinge, wrench: ArrayLike, elements: int = ELEMENTS) -> str:
    """As ``too_coarse``, under dead loads."""
    return _advice(elements, lambda count: load_error(hinge, wrench, count))


def _advice(elements: int, error_of: Callable[[int], float]) -> str:
    error = error_of(elements)
    if not error > 1:
        return ""
    enough = 2 * elements
    while enough < FINEST and error_of(enough) > 1:
        enough *= 2
    return (f"the mesh is too coarse: elements = {elements} is off by {error:.2g} times the accepted {TIP:g} L, "
            f"{TURN:g} rad or {100 * MOMENT:g} % of the moment; take elements = {enough}")  # fmt: skip


def _apart(coarse: Solution, fine: Solution, length: float) -> float:
    both = (coarse.status == CONVERGED) & (fine.status == CONVERGED)
    if not both.any():
        return float("nan")
    tip = np.linalg.norm(coarse.tip - fine.tip, axis=1)[both].max() / length
    turn = np.abs(coarse.theta - fine.theta)[both].max()
    size = np.abs(fine.moment[both]).max()
    moment = np.abs(coarse.moment - fine.moment)[both].max() / size if size else 0.0
    return float(max(tip / TIP, turn / TURN, moment / MOMENT))
