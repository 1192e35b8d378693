"""Advice on a design whose shape its cables do not make or hold: what does, of some things that are tried."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from tensegym.errors import TensegymError

from .design import RobotDesign

RATIOS = (0.7, 1.4, 0.5, 2.0, 0.33, 3.0)  # of a group's pretension over that of the others
TWISTS = (15, -15, 30, -30, 45, -45, 60, -60, 75, -75, 90, -90)  # degrees, of the highest nodes against the lowest
UPRIGHT = 0.5  # of a cable's length: cables that rise by more are upright


def advice(data: dict[str, Any], make: Callable[[dict[str, Any]], RobotDesign]) -> str:
    """What would ``make`` a robot of a design's table (as a file gives it): tensions that hold its nodes or
    their height, another ratio of pretensions, a twist; or that none of those tried does."""
    for kept, what in (("shape", "it as given"), ("height", "its height")):
        held = _made({**data, "keep": {kept: True}}, make)
        if held is not None:
            low, high = held.rest_tensions.min(), held.rest_tensions.max()
            return f"[keep] {kept} = true holds {what}, by {low:.3g} to {high:.3g} N"
    for text, changed in (*_ratios(data), *_twists(data)):
        if _made(changed, make) is not None:
            return text
    return "no tensions hold it or its height, and no ratio of tensions or twist helps"


def _made(data: dict[str, Any], make: Callable[[dict[str, Any]], RobotDesign]) -> RobotDesign | None:
    try:
        return make(data)
    except TensegymError:
        return None


def _ratios(data: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """With the pretension of a group, or of the upright cables where there is none, in other ratios to the others'."""
    nodes, cables = np.array(data["structure"]["nodes"], dtype=float), data["structure"]["cables"]
    groups = data.get("cables", {})
    if not groups:
        spans = [nodes[b - 1] - nodes[a - 1] for a, b in cables]
        upright = [pair for pair, span in zip(cables, spans, strict=True)
                   if abs(span[2]) > UPRIGHT * np.linalg.norm(span)]  # fmt: skip
        groups = {"upright": {"pairs": upright}} if upright else {}
    level = data.get("elastic_cable", {}).get("pretension", 10.0)
    for name, group in groups.items():
        for ratio in RATIOS:
            changed = {key: value for key, value in group.items() if key not in ("force_density", "natural_length")}
            changed["pretension"] = ratio * changed.get("pretension", level)
            text = f"[cables.{name}] pretension = {changed['pretension']:.3g} makes a shape that stands"
            yield text, {**data, "cables": {**groups, name: changed}}


def _twists(data: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """With the nodes turned about the vertical by their height's part of an angle."""
    nodes = np.array(data["structure"]["nodes"], dtype=float)
    heights, middle = nodes[:, 2], nodes.mean(axis=0)
    part = (heights - heights.min()) / (np.ptp(heights) or 1.0)
    for degrees in TWISTS:
        c, s = np.cos(np.radians(degrees) * part), np.sin(np.radians(degrees) * part)
        x, y, _ = (nodes - middle).T
        turned = np.column_stack([middle[0] + c * x - s * y, middle[1] + s * x + c * y, heights])
        structure = {**data["structure"], "nodes": turned.tolist()}
        yield f"nodes twisted by {degrees} deg from bottom to top stand", {**data, "structure": structure}
