"""Parts: what is seen of a robot, for whatever draws one."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tensegym.design.bodies import Kind, design_bodies
from tensegym.design.design import RobotDesign
from tensegym.structure.faces import hull_faces

from .recording import Recording


class Part(NamedTuple):
    """A shape on a body, about the body's z axis."""

    body: int
    """Row of the body."""
    kind: Kind
    size: tuple[float, ...]
    """As `tensegym.design.bodies.Shape` has it [m]."""
    z: float
    """Of its middle, from the body's centre of mass [m]."""
    colour: tuple[float, ...]
    """Red, green, blue and opacity, 0 to 1."""


def parts_of(design: RobotDesign) -> list[Part]:
    """All that is seen of a design's bodies; the cables are not in it."""
    bodies = design_bodies(design)
    links = [(row, body.link) for row, body in enumerate(bodies)]
    second = [body.second for body in bodies if body.second is not None]
    links += list(enumerate(second, start=len(bodies)))
    return [
        Part(row, shape.kind, shape.size, shape.z - link.centre, tuple(map(float, shape.colour.split())))
        for row, link in links for shape in link.shapes if shape.colour
    ]  # fmt: skip


def scenery(recording: Recording) -> dict[str, Any]:
    """What a page needs to draw a recording, as plain JSON types: parts, cables, nodes, faces, masses, limits."""
    model, design = recording.model, recording.design
    cables = model.first_flexure
    return {
        "parts": [part._asdict() for part in parts_of(design)],
        "cables": {"bodies": model.spring_bodies[:cables].tolist(),
                   "points": np.round(model.spring_params[:cables, :6], 6).tolist(),
                   "driven": [model.driven.start, model.driven.stop]},
        "nodes": {"bodies": model.node_bodies.tolist(), "points": np.round(model.node_points, 6).tolist(),
                  "radii": model.foot_radii.tolist()},
        "faces": hull_faces(design.standing).triangles.tolist(),
        "masses": model.masses.tolist(), "limits": recording.limits._asdict(), "length": design.length,
    }  # fmt: skip
