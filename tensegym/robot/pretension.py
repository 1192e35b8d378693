"""The least pretension at which a robot stands, and the stiffness of cables that would take as much.

Where cables pull unlike it is the largest of their pretensions, the others in proportion.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.design.groups import column, scaled
from tensegym.errors import DesignError, StructureError

from .robot import TensegrityRobot
from .settling import Settled, robot_for, settle

CLOSE = 1.1  # ratio of a pretension that stands over one that does not, where the search ends
LOWEST = 2.0**-2  # of the design's pretension: none lower is tried
NEARLY = 0.98  # of the pretension that would stretch the shortest cable from nothing: none higher is tried
STIFFER = (2, 4, 8)  # ratios of stiffness tried where no pretension holds it


class Holding(NamedTuple):
    """Which pretension holds a robot on its faces."""

    least: float | None
    """At which it stands on all faces that any pretension tried holds it on [N], within 10 %; None where that is no
    face."""
    lowest: float
    highest: float
    """That was tried [N]."""
    never: tuple[str, ...]
    """Faces on which it stands with none of those tried."""
    limit: str
    """Why none higher was tried."""
    stiffer: float | None
    """Stiffness of the cables [N/m] with which ``highest`` holds it on those faces; None where none tried does."""

    @property
    def text(self) -> str:
        """In words that go on from a verdict."""
        if not self.never:
            if self.least == self.lowest:
                return f"so it does at a pretension of {self.lowest:.3g} N, the lowest tried"
            return f"it stands from a pretension of {self.least:.3g} N on"
        others = f" and {len(self.never) - 1} more" if len(self.never) > 1 else ""
        where = f"{self.never[0]}{others}" if self.least else "any of them"
        line = f"no pretension up to {self.highest:.3g} N, {self.limit}, holds it on {where}"
        if self.stiffer:
            line += f", but with cables of {self.stiffer:.4g} N/m that does"
        return f"{line}; on the others it stands from {self.least:.3g} N on" if self.least else line


def least_pretension(design: RobotDesign, engine: str, faces: Sequence[Settled]) -> Holding:
    """Look for the least pretension that holds a robot on all of ``faces``, tried at the present one and worst first.

    What holds it on one face is tried on the next, and raised where it does not, until it holds on all of them.
    """
    with ExitStack() as stack:
        trials = _Trials(design, engine, stack)
        least, never = trials.lowest, list[Settled]()
        while True:
            before = least
            for face in faces:
                if face in never or trials.stands(face, least):
                    continue
                held = trials.least(face, least)
                if held is None:
                    never.append(face)
                else:
                    least = held
            if least == before:
                break
        stiffer = trials.stiffness(never) if never else None
        names = tuple(name for face in never for name in face.names)
        found = least if len(never) < len(faces) else None
        return Holding(found, trials.lowest, trials.highest, names, trials.limit, stiffer)


class _Trials:
    """A robot with one pretension and another, set down on one face and another."""

    def __init__(self, design: RobotDesign, engine: str, stack: ExitStack) -> None:
        self.design, self.engine, self.stack = design, engine, stack
        self.present = self.highest = float(design.rest_tensions.max())
        self.lowest = LOWEST * self.present
        lengths = design.standing.lengths(design.standing.cables) - 2 * design.attachment_radius
        stiffness = column(design.each_cable, "stiffness")
        part = design.rest_tensions / self.present
        self.most = max(NEARLY * float(((stiffness * lengths)[part > 0] / part[part > 0]).min()), self.present)
        self.limit = f"the most its cables take at {stiffness.min():.4g} N/m"
        self._robots: dict[float, TensegrityRobot | None] = {}
        self._known: dict[tuple[Settled, float], bool] = {}

    def least(self, face: Settled, low: float) -> float | None:
        """Least pretension [N] above ``low``, at which it falls, that holds it on a face."""
        high = self.present if low < self.present and not face.fell else low
        while high == low:
            if low >= self.most:
                return None
            high = min(2 * low, self.most)
            if not self.stands(face, high):
                low = high
        while high > CLOSE * low:
            middle = float(np.sqrt(low * high))
            low, high = (low, middle) if self.stands(face, middle) else (middle, high)
        return high

    def stands(self, face: Settled, pretension: float) -> bool:
        """Whether it stands on a face at a pretension [N]; not where no robot can be made with it."""
        if (face, pretension) not in self._known:
            if pretension not in self._robots:
                self._robots[pretension] = robot = self._robot(pretension)
                self.highest = max(self.highest, pretension if robot else 0.0)
            robot = self._robots[pretension]
            self._known[face, pretension] = robot is not None and not settle(robot, face.names).fell
        return self._known[face, pretension]

    def stiffness(self, faces: Sequence[Settled]) -> float | None:
        """Least stiffness of the cables [N/m], of those tried, with which the highest pretension holds it on faces."""
        for ratio in STIFFER:
            robot = self._robot(self.highest, ratio)
            if robot and not any(settle(robot, face.names).fell for face in faces):
                return float(ratio * column(self.design.each_cable, "stiffness").max())
        return None

    def _robot(self, pretension: float, stiffer: float = 1.0) -> TensegrityRobot | None:
        """With this largest pretension [N], others in proportion, and all cables so many times stiffer."""
        cable, part = self.design.elastic_cable, pretension / self.present
        own = pretension if cable.pretension == self.present else part * cable.pretension
        try:
            changed = self.design.with_(
                elastic_cable=replace(cable, pretension=own, stiffness=stiffer * cable.stiffness),
                cables=scaled(self.design.cables, {"pretension": part, "stiffness": stiffer}),
            )
            return self.stack.enter_context(robot_for(changed, self.engine))
        except (DesignError, StructureError) as error:
            self.limit = f"over which it cannot be built ({error})"[:150]
            return None
