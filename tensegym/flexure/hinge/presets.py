"""The paper's four hinges and more topologies, each with free dimensions.

Geometry and material: Rakshin and Borisov 2023, Fig. 4 (L = H = W = 40 mm, t = 0.8 mm, arm 120 mm, E = 2.95 GPa,
nu = 0.38). Where the paper gives no dimension, the one taken here is said in the function.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable

from tensegym.errors import FlexureError
from tensegym.tables import hint, show

from .hinge import GROUND, TIP, Hinge, Leaf, Material
from .profile import Notch, Taper
from .ranges import check_positive, is_number, shown

MM = 1e-3


def x_hinge(*, length: float = 40 * MM, height: float = 40 * MM, width: float = 40 * MM, thickness: float = 0.8 * MM,
            material: Material | None = None, arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """Cartwheel: four leaves from the corners to a rigid joint at the centre. All lengths [m]."""
    middle = (length / 2, 0.0)
    leaves = [Leaf(GROUND, (0.0, s * height / 2), "centre", middle, width, thickness) for s in (-1, 1)]
    leaves += [Leaf("centre", middle, TIP, (length, s * height / 2), width, thickness) for s in (-1, 1)]
    return Hinge("x-hinge", tuple(leaves), length, (GROUND, "centre", TIP), material or Material(), arm)


def leaf_spring(*, length: float = 40 * MM, width: float = 40 * MM, thickness: float = 0.8 * MM,
                material: Material | None = None, arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """LS: one leaf. All lengths [m]."""
    leaf = Leaf(GROUND, (0.0, 0.0), TIP, (length, 0.0), width, thickness)
    return Hinge("leaf-spring", (leaf,), length, material=material or Material(), arm=arm)


def trls2(*, length: float = 40 * MM, width: float = 40 * MM, thickness: float = 0.8 * MM, rib: float = 0.8 * MM,
          material: Material | None = None, arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """TRLS(2x): a leaf with two rigid transverse ribs at L/3 and 2L/3 (assumed), ``rib`` long. Lengths [m]."""
    check_positive("rib", rib, "m")
    check_positive("length", length, "m")
    if not rib < length / 3:
        raise FlexureError(f"rib = {rib:g} m is outside (0, length / 3) at length = {length:g} m")
    stops = [
        0.0,
        length / 3 - rib / 2,
        length / 3 + rib / 2,
        2 * length / 3 - rib / 2,
        2 * length / 3 + rib / 2,
        length,
    ]
    bodies = (GROUND, "rib1", "rib2", TIP)
    leaves = [Leaf(bodies[i], (stops[2 * i], 0.0), bodies[i + 1], (stops[2 * i + 1], 0.0), width, thickness)
              for i in range(3)]  # fmt: skip
    return Hinge("trls2", tuple(leaves), length, bodies, material or Material(), arm)


def tfch(*, length: float = 40 * MM, height: float = 40 * MM, width: float = 40 * MM, thickness: float = 0.8 * MM,
         material: Material | None = None, arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """TFCH: three leaves along the diagonals, unconnected at the crossing, widths 1/4, 1/2, 1/4. All lengths [m]."""
    leaves = [Leaf(GROUND, (0.0, -s * height / 2), TIP, (length, s * height / 2), share * width, thickness)
              for s, share in ((1, 0.25), (-1, 0.5), (1, 0.25))]  # fmt: skip
    return Hinge("tfch", tuple(leaves), length, material=material or Material(), arm=arm)


def cross_spring(*, length: float = 40 * MM, height: float = 40 * MM, width: float = 40 * MM,
                 thickness: float = 0.8 * MM, crossing: float = 0.5, material: Material | None = None,
                 arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """Generalised cross-spring pivot: two leaves that cross, unconnected, at the fraction ``crossing`` of their length.

    ``height`` is that of each leaf: they run from (0, -+crossing height) to (L, +-(1 - crossing) height). Lengths [m].
    """
    if not (is_number(crossing) and 0 <= crossing <= 1):
        raise FlexureError(f"crossing = {shown(crossing)} is outside [0, 1]; 0.5 is the symmetric pivot")
    leaves = [Leaf(GROUND, (0.0, -s * crossing * height), TIP, (length, s * (1 - crossing) * height), width / 2,
                   thickness) for s in (-1, 1)]  # fmt: skip
    return Hinge("cross-spring", tuple(leaves), length, material=material or Material(), arm=arm)


def parallel_guide(*, length: float = 40 * MM, height: float = 40 * MM, width: float = 40 * MM,
                   thickness: float = 0.8 * MM, material: Material | None = None,
                   arm: float = 0.0) -> Hinge:  # fmt: skip
    """Parallel guide without notches: two leaves side by side; it translates and hardly turns. All lengths [m]."""
    leaves = [Leaf(GROUND, (0.0, s * height / 2), TIP, (length, s * height / 2), width, thickness) for s in (-1, 1)]
    return Hinge("parallel-guide", tuple(leaves), length, material=material or Material(), arm=arm,
                 max_angle=math.radians(0.01))  # fmt: skip


def tapered_leaf(*, length: float = 40 * MM, width: float = 40 * MM, thickness: float = 0.8 * MM,
                 end_thickness: float = 0.4 * MM, material: Material | None = None,
                 arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """One leaf, ``thickness`` at the ground and ``end_thickness`` at the tip. All lengths [m]."""
    leaf = Leaf(GROUND, (0.0, 0.0), TIP, (length, 0.0), width, thickness, Taper(end_thickness))
    return Hinge("tapered-leaf", (leaf,), length, material=material or Material(), arm=arm)


def notch_hinge(*, length: float = 10 * MM, width: float = 40 * MM, thickness: float = 0.5 * MM,
                radius: float | None = None, depth: float | None = None, material: Material | None = None,
                arm: float = 120 * MM) -> Hinge:  # fmt: skip
    """A web of ``thickness`` between fillets, ``radius`` along and ``depth`` across it; without both: a circular notch.

    radius = L/2 (the default): no straight web. depth = radius (the default): circles. All lengths [m].
    """
    along = length / 2 if radius is None else radius
    notch = Notch(along, along if depth is None else depth)
    leaf = Leaf(GROUND, (0.0, 0.0), TIP, (length, 0.0), width, thickness, notch)
    return Hinge("notch-hinge", (leaf,), length, material=material or Material(), arm=arm, max_angle=math.radians(10))


PRESETS: dict[str, Callable[..., Hinge]] = {
    "x-hinge": x_hinge,
    "leaf-spring": leaf_spring,
    "trls2": trls2,
    "tfch": tfch,
    "cross-spring": cross_spring,
    "parallel-guide": parallel_guide,
    "tapered-leaf": tapered_leaf,
    "notch-hinge": notch_hinge,
}
PAPER_HINGES = ("x-hinge", "leaf-spring", "trls2", "tfch")


def preset(name: str, **dimensions: float) -> Hinge:
    """A preset by name, with its dimensions [m] by keyword. Raises FlexureError for an unknown name or dimension."""
    if not isinstance(name, str) or name not in PRESETS:
        raise FlexureError(f"unknown hinge {show(name)}: give a path that ends in .toml, or a preset's name; "
                           f"{hint(name, PRESETS)}")  # fmt: skip
    known = set(inspect.signature(PRESETS[name]).parameters)
    for key in dimensions:
        if key not in known:
            raise FlexureError(
                f"hinge {name} has no {key!r}; its dimensions are {', '.join(sorted(known - {'material'}))}"
            )
        if key not in ("arm", "crossing", "material"):
            check_positive(key, dimensions[key], "m")
    return PRESETS[name](**dimensions)
