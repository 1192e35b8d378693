"""Whether a robot stands: what its weight makes of its shape, face by face, and the least pretension that holds it.

Each face is tried in the robot's own simulation: rods, cables, payload, hinges, friction and momentum are the robot's.
Statics would not do: some robots that stand if their weight is let on slowly fall when they are let go, as they are at
every reset.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tensegym.design.design import RobotDesign

from .pretension import Holding, least_pretension
from .settling import Settled, alike, robot_for, settle

SAGS = 0.1  # of the longest rod: a robot that a node moves farther in has sagged


class Verdict(NamedTuple):
    """Whether a robot stands."""

    design: RobotDesign
    faces: Sequence[Settled]
    """Those that the centre of mass is above, which a rigid robot would rest on; the one with least volume first."""
    holding: Holding | None
    """Which pretension holds it; None where none was looked for, as with a given natural length."""

    @property
    def kind(self) -> str:
        """stands, sags or falls."""
        if self.faces[0].fell:
            return "falls"
        return "sags" if max(face.sag for face in self.faces) > SAGS * self.design.length else "stands"

    @property
    def falls_everywhere(self) -> bool:
        return all(face.fell for face in self.faces)

    @property
    def text(self) -> str:
        """The verdict in one line, and what form finding did in another."""
        every, fell = _count(self.faces), [face for face in self.faces if face.fell]
        if fell and not fell[0].volume >= 0:
            line = f"comes apart on face {fell[0].names[0]}: its simulation diverges"
        elif fell:
            line = f"falls flat under its weight on {_count(fell)} of {every} faces ({fell[0].names[0]} first)"
        else:
            sag = 1e3 * max(face.sag for face in self.faces)
            line = f"{self.kind} on all {every} faces, its nodes displaced by up to {sag:.3g} mm under its weight"
        if self.holding:
            line += f"; {self.holding.text}"
        if self.design.shape.moved > 1e-3 * self.design.length:
            line += f"\n{self.moved}"
        return line

    @property
    def moved(self) -> str:
        """What form finding did, in words."""
        given, found = self.design.built.nodes, self.design.standing.nodes
        shifts = np.linalg.norm(found - given, axis=1)
        farthest = np.flatnonzero(shifts > (1 - 1e-6) * shifts.max())[0]
        line = f"form finding moved the given nodes by up to {shifts.max():.3g} m (node {farthest + 1})"
        before, after = np.ptp(given[:, 2]), np.ptp(found[:, 2])
        if abs(after - before) > 1e-3 * self.design.length:
            line += f", their height from {before:.3g} to {after:.3g} m"
        return line

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON types, but for nan where there is no number."""
        shape, holding = self.design.shape, self.holding
        return {
            "verdict": self.kind, "moved_m": shape.moved, "thickness_m": shape.thickness,
            "least_stiffness_N_per_m": shape.least_stiffness,
            "least_pretension_N": holding.least if holding else None,
            "highest_pretension_tried_N": holding.highest if holding else None,
            "faces_no_pretension_holds": list(holding.never) if holding else [],
            "stiffness_that_would_N_per_m": holding.stiffer if holding else None,
            "faces": [{"faces": list(f.names), "sag_m": f.sag, "volume": f.volume, "fell": f.fell} for f in self.faces],
        }  # fmt: skip


def _count(faces: Sequence[Settled]) -> int:
    return sum(len(face.names) for face in faces)


def standing_verdict(design: RobotDesign, engine: str = "pybullet", *, pretension: bool = True) -> Verdict:
    """Set a robot down on every face that it could rest on and let go: some tenths of a second of processor time.

    Args:
        design: what is judged.
        engine: that simulates it, see `tensegym.robot.engines`.
        pretension: whether to look for the least pretension that holds it on all of them too.

    Raises:
        StructureError: the nodes span no volume.
    """
    with robot_for(design, engine) as robot:
        faces = [settle(robot, names) for names in alike(robot)]
    faces.sort(key=lambda face: face.volume if face.volume >= 0 else -1.0)
    tensions = design.rest_tensions
    searched = pretension and not np.isnan(tensions).any() and tensions.max(initial=0.0) > 0 and design.gravity > 0
    return Verdict(design, faces, least_pretension(design, engine, faces) if searched else None)
