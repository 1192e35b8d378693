"""Prisms as tables of a design file."""

import numpy as np


def prism(rods, radius, height, twist, **groups):
    """Cables around both ends and up the sides; a rod leads from a node to the one beside that above it."""
    angles = 2 * np.pi * np.arange(rods) / rods
    ends = ((0.0, 0.0), (twist, height))
    rings = [[[radius * np.cos(a + t), radius * np.sin(a + t), z] for a in angles] for t, z in ends]
    ring = [[i + 1, (i + 1) % rods + 1] for i in range(rods)]
    members = {
        "nodes": rings[0] + rings[1], "stiff_cables": [],
        "rods": [[i + 1, rods + (i + 1) % rods + 1] for i in range(rods)],
        "cables": ring + [[a + rods, b + rods] for a, b in ring] + [[i + 1, rods + i + 1] for i in range(rods)],
    }  # fmt: skip
    return {"structure": members, **groups}
