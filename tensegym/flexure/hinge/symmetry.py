"""Symmetry of a hinge: it halves the coefficients that a potential needs."""

from __future__ import annotations

from .hinge import Hinge
from .profile import Notch


def symmetry_of(hinge: Hinge) -> str:
    """both, axis or none: which mirror images leave the hinge as it is (within 1 nm; widths in one place add up).

    "axis" is the mirror image across the hinge's x axis, "both" that and the one end to end.
    """
    own = _shapes(hinge, False, False)
    if _shapes(hinge, False, True) != own:
        return "none"
    return "both" if _shapes(hinge, True, False) == own else "axis"


def _shapes(hinge: Hinge, flip_x: bool, flip_y: bool) -> dict[tuple[int, ...], int]:
    """Width by place, thickness and profile of the leaves of a mirror image, all in nm."""
    out: dict[tuple[int, ...], int] = {}
    for leaf in hinge.leaves:
        points = zip((leaf.start, leaf.end), leaf.end_thicknesses, strict=True)
        ends = sorted((round(1e9 * (hinge.length - x if flip_x else x)), round(1e9 * (-y if flip_y else y)),
                       round(1e9 * thickness)) for (x, y), thickness in points)  # fmt: skip
        notch = leaf.profile if isinstance(leaf.profile, Notch) else None
        fillet = (round(1e9 * notch.along), round(1e9 * notch.across)) if notch else (0, 0)
        place = (*ends[0], *ends[1], *fillet)
        out[place] = out.get(place, 0) + round(1e9 * leaf.width)
    return out
