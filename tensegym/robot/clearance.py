"""Whether a design's bodies stand clear of one another at rest: contacts would push apart what overlaps at once."""

from __future__ import annotations

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign
from tensegym.errors import DesignError


def check_clear(design: RobotDesign) -> None:
    """Raise DesignError for rods that overlap at rest, with one another or with the payload, naming the deepest."""
    ends = design.standing.nodes[design.standing.rods]
    names = ["-".join(map(str, rod + 1)) for rod in design.structure.rods]
    tubes = np.array([design.rod(i).tube_outer_radius for i in range(len(ends))])
    feet = np.array([max(design.rod(i).foot_radius, design.rod(i).tube_outer_radius) for i in range(len(ends))])
    if design.payload is not None:
        centre = np.repeat(ends.mean(axis=(0, 1))[None], 2, axis=0)
        gaps = np.array([segment_distance(centre, rod) for rod in ends]) - design.payload.radius - tubes
        rod = int(gaps.argmin())
        if gaps[rod] < 0:
            raise DesignError(
                f"the payload and rod {names[rod]} overlap by {-gaps[rod]:.3g} m at rest: with Payload.radius = "
                f"{design.payload.radius:g} m and a rod of radius {tubes[rod]:g} m; make either thinner"
            )
    least, pair, joined = 0.0, (0, 0), {(a, b) for a, b in design.structure.joined.tolist()}
    for i in range(len(ends)):
        for j in range(i):
            if (j, i) in joined:
                continue
            gap = segment_distance(ends[i], ends[j]) - tubes[i] - tubes[j]
            for foot, other in ((i, j), (j, i)):
                points = ends[foot][:, None].repeat(2, axis=1)
                gap = min(gap, *(segment_distance(point, ends[other]) - feet[foot] - tubes[other] for point in points))
            apart = np.linalg.norm(ends[i][:, None] - ends[j][None], axis=2)
            gap = min(gap, float(apart.min()) - feet[i] - feet[j])
            if gap < least:
                least, pair = gap, (j, i)
    if least < 0:
        a, b = pair
        raise DesignError(
            f"rods {names[a]} and {names[b]} overlap by {-least:.3g} m at rest: with tube_outer_radius = {tubes[a]:g} "
            f"and {tubes[b]:g} m, foot_radius = {design.rod(a).foot_radius:g} and {design.rod(b).foot_radius:g} m; "
            "make them thinner or the robot larger"
        )


def segment_distance(one: FloatArray, two: FloatArray) -> float:
    """Least distance of two segments, each from its first to its second point (2, 3), which may be the same."""
    along, other, between = one[1] - one[0], two[1] - two[0], one[0] - two[0]
    a, b, c = float(along @ along), float(along @ other), float(other @ other)
    d, e = float(along @ between), float(other @ between)
    tries = [(s, np.clip((e + s * b) / c, 0, 1) if c else 0.0) for s in (0.0, 1.0)]
    tries += [(np.clip((t * b - d) / a, 0, 1) if a else 0.0, t) for t in (0.0, 1.0)]
    across = a * c - b * b
    if across > 1e-12 * a * c:
        s, t = (b * e - c * d) / across, (a * e - b * d) / across
        if 0 <= s <= 1 and 0 <= t <= 1:
            tries.append((s, t))
    return min(float(np.linalg.norm(between + s * along - t * other)) for s, t in tries)
