"""Scenery: what a page needs to draw a recording, beside its arrays, as plain JSON types."""

from __future__ import annotations

from typing import Any

import numpy as np

from tensegym.design.solids import solids
from tensegym.plotting import COLOURS
from tensegym.robot.sight import FULL_SCALE, tension_colour

from .recording import Recording


def scenery(recording: Recording) -> dict[str, Any]:
    """Solids, cables, nodes and faces by the bodies they are on, masses, limits, colours; lengths in m."""
    model, design = recording.model, recording.design
    cables = model.first_flexure
    return {
        "name": design.name, "length": design.length, "masses": model.masses.tolist(),
        "limits": recording.limits._asdict(),
        "solids": [solid._asdict() for solid in solids(design)],
        "cables": {"bodies": model.spring_bodies[:cables].tolist(),
                   "points": np.round(model.spring_params[:cables, :6], 6).tolist(),
                   "driven": [model.driven.start, model.driven.stop]},
        "nodes": {"bodies": model.node_bodies.tolist(), "points": np.round(model.node_points, 6).tolist()},
        "faces": recording.triangles.tolist(),
        "colours": list(COLOURS), "full_scale": FULL_SCALE,
        "tension_colours": [tension_colour(FULL_SCALE * share) for share in np.linspace(1e-3, 1, 13)],
    }  # fmt: skip
