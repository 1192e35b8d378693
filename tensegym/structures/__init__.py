"""Builders of tensegrities: parameters in, nodes, rods and groups of cables out, in balance by a closed form.

A builder is a dataclass whose fields are its parameters and whose `build` gives a `Blueprint`; `BUILDERS` has them by
name, for `tensegym build` and for the [structure] table of a design file.
"""

from .blueprint import Blueprint
from .builders import BUILDERS, blueprint, parameters
from .octahedron import Octahedron
from .prism import Prism, ThreeRodRobot
from .spine import Spine
from .tower import Stack, Tower
from .truncated import Truncated

__all__ = [
    "BUILDERS", "Blueprint", "Octahedron", "Prism", "Spine", "Stack", "ThreeRodRobot", "Tower", "Truncated",
    "blueprint", "parameters",
]  # fmt: skip
