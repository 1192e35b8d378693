"""Buckling load of a straight rod of two rigid parts with a hinge between.

The rod's outer ends are pinned, the load P pushes along the line of the ends, both parts are clamped to the hinge.
Seen from the base axes, which turn by phi with the first part, the far end carries the dead force (-P, P phi), and
stays on the line: phi = -v / l with v its deflection across the rod, l the rod's length. So the rod is the hinge with a
dead load -P at the end of an arm, and a spring P / l across the arm's end. It buckles where the whole tangent, inner
nodes included, loses its positive definiteness: the hinge's own softening is in it. In closed form, a leaf of length s
between equal parts a, and its limit of a pin with a spring as s -> 0:

    tan(k s / 2) = 1 / (k a),  k^2 = P / EI;    P = 4 K / l,  K = EI / s
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Hinge
from tensegym.flexure.hinge.ranges import check_not_negative

from . import newton
from .assembly import assemble
from .ldl import factor
from .memory import Memory, copy_state, memory
from .mesh import ELEMENTS, Mesh, mesh_of

ACCURACY = 1e-9  # of the load, relative
DOUBLINGS = 60
STRAIGHT = 1e-6  # rad and hinge lengths that a straight rod may deflect by rounding


def check_parts(before: float, after: float) -> None:
    """Refuse lengths of a rod's rigid parts [m] that are not finite or negative."""
    for name, value in (("before", before), ("after", after)):
        check_not_negative(name, value, "m", "give the length of the rod's rigid part, 0 or more")


@lru_cache(maxsize=256)
def buckling_load(hinge: Hinge, before: float, after: float, elements: int = ELEMENTS) -> float:
    """Smallest compression [N] under which a straight rod with a hinge in it buckles in the hinge's plane.

    Args:
        hinge: symmetric about its axis.
        before, after: the rod's rigid parts on the hinge's base and tip, along its x axis [m], 0 or more.
        elements: of a leaf as long as the hinge.

    Raises:
        FlexureError: for a length out of range, and for a hinge that is not symmetric about its axis: a rod with it
            bends from the first load on.
    """
    check_parts(before, after)
    mesh = mesh_of(hinge, elements)
    stable, trial = memory(mesh), memory(mesh)
    # an Euler column of the softest leaf, far longer than the rod, stands under this
    rod, modulus = before + hinge.length + after, hinge.material.effective_modulus
    high = min(modulus * leaf.width * leaf.thinnest**3 for leaf in hinge.leaves) / (100 * rod * rod)
    low = 0.0
    for _ in range(DOUBLINGS):
        copy_state(stable, trial)
        if not _stands(mesh, trial, high, before, after, hinge.name):
            break
        copy_state(trial, stable)
        low, high = high, 2 * high
    else:
        raise FlexureError(f"{hinge.name}: a rod with it stands under {low:.4g} N; nothing in it can buckle")
    while high - low > ACCURACY * high:
        load = 0.5 * (low + high)
        copy_state(stable, trial)
        if _stands(mesh, trial, load, before, after, hinge.name):
            low = load
            copy_state(trial, stable)
        else:
            high = load
    return low


def _stands(mesh: Mesh, mem: Memory, load: float, before: float, after: float, name: str) -> bool:
    """Whether the straight rod is stable under ``load`` [N]; takes ``mem`` from a neighbouring state to that one."""
    case = np.zeros(8)
    case[newton.FX], case[newton.ARM] = -load, after
    found, _, _, _, _ = newton.newton(mesh, mem, newton.LOAD, case)
    if not found:  # a limit point of the straight rod
        return False
    x, y, turn = mem.poses[-1]
    if abs(turn) > STRAIGHT or abs(y) > STRAIGHT * mesh.rest[-1, 0]:
        raise FlexureError(f"{name} is not symmetric about its axis: a rod with it bends from the first load on and "
                           "has no buckling load; take a symmetric hinge")  # fmt: skip
    inner = assemble(mesh, mem)
    matrix, across = mem.matrix, load / (before + x + after)
    matrix[-1, -1] -= load * after
    matrix[-2, -2] += across
    matrix[-2, -1] += across * after
    matrix[-1, -2] += across * after
    matrix[-1, -1] += across * after * after
    negative, last = factor(matrix)
    return bool(inner + negative == 0 and not last)
