"""Symmetry of a hinge: it halves the coefficients that a potential needs."""

from __future__ import annotations

from .hinge import Hinge


def symmetry_of(hinge: Hinge) -> str:
    """both, axis or none: which mirror images leave the hinge as it is (within 1 nm; widths in one place add up).

    "axis" is the mirror image across the hinge's x axis, "both" that and the one end to end.
    """
    own = _shapes(hinge, False, False)
    if _shapes(hinge, False, True) != own:
        return "none"
    return "both" if _shapes(hinge, True, False) == own else "axis"


def _shapes(hinge: Hinge, flip_x: bool, flip_y: bool) -> dict[tuple[int, ...], int]:
    """Width by place and thickness of the leaves of a mirror image, all in nm."""
    out: dict[tuple[int, ...], int] = {}
    for leaf in hinge.leaves:
        ends = sorted((round(1e9 * (hinge.length - x if flip_x else x)), round(1e9 * (-y if flip_y else y)))
                      for x, y in (leaf.start, leaf.end))  # fmt: skip
        place = (*ends[0], *ends[1], round(1e9 * leaf.thickness))
        out[place] = out.get(place, 0) + round(1e9 * leaf.width)
    return out
