"""G1 to G3: heights that the six-rod robot rests at and what a tip takes, by rigid geometry."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tensegym.structure.faces import hull_faces, resting_height, tip_geometry
from tensegym.structure.structure import six_rod

from .check import Check, furthest


def rows(engine: str = "pybullet") -> Iterator[Check]:
    """G1 to G3: resting heights and tips of equal-mass rods, L = 1 m; no engine takes part."""
    structure = six_rod(1.0)
    faces, centre = hull_faces(structure), structure.nodes.mean(axis=0)
    heights = np.array([resting_height(structure.nodes, t, centre) for t in faces.triangles])
    yield Check("G1", "closed faces", 8, int(faces.closed.sum()), 0)
    yield Check("G1", "open faces", 12, int((~faces.closed).sum()), 0)
    for name, kind, height in (("closed", faces.closed, np.sqrt(3) / 4), ("open", ~faces.closed, 1 / np.sqrt(5))):
        yield Check("G1", f"resting height / L, {name} face", height, furthest(heights[kind], height), 1e-9)
    for face in np.flatnonzero(faces.closed)[:1]:
        tip = tip_geometry(faces, structure.nodes, centre, face, faces.neighbours[face][0])
        yield Check("G2", "closed to open: angle, deg", 39.23, float(np.degrees(tip.angle)), 5e-3)
        yield Check("G2", "closed to open: barrier / L", 0.03469, tip.barrier, 5e-6)
        yield Check("G2", "closed to open: travel / L", 0.3137, tip.travel, 5e-5)
    face = int(np.flatnonzero(~faces.closed)[0])
    other = next(n for n in faces.neighbours[face] if not faces.closed[n])
    tip = tip_geometry(faces, structure.nodes, centre, face, other)
    yield Check("G3", "open to open: angle, deg", 53.13, float(np.degrees(tip.angle)), 5e-3)
    yield Check("G3", "open to open: barrier / L", 0.05279, tip.barrier, 5e-6)
    yield Check("G3", "open to open: travel / L", 0.4472, tip.travel, 5e-5)
