"""Observations by name: what is seen, and what may be put beside it: a goal, the past, the design."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.design.variation import Variation
from tensegym.errors import DesignError
from tensegym.robot.reading import Reading
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import show

from .bearing import Bearing
from .observation import FullObservation, Observation, OnboardObservation, Part

MOMENTS = 3  # that a memory holds


class GoalObservation(Observation):
    """Another observation, and what there is to say of the place to go to beside its direction, which is the heading
    frame's: how far it is, as a part of four rod lengths and of one, and whether to stop there."""

    def __init__(self, observation: Observation, robot: TensegrityRobot) -> None:
        self._observation, self._length = observation, robot.design.length
        self.parts = (*observation.parts, Part("goal", "robot", 1, 3, 1.0))

    def values(self, robot: TensegrityRobot, reading: Reading, bearing: Bearing) -> FloatArray:
        """As `Observation` has it."""
        far = bearing.distance / self._length
        goal = [min(far / 4, 1.0), min(far, 1.0), float(bearing.stay)]
        return np.concatenate([self._observation.values(robot, reading, bearing), goal])


class Memory(Observation):
    """Another observation as it was seen now and at the last moments before, the present one first.

    It is remembered as the sensors gave it. Before the first of an episode the first stands in.

    Args:
        observation: what is remembered; asked once a control step.
        moments: how many, the present one included.
    """

    def __init__(self, observation: Observation, moments: int = MOMENTS) -> None:
        self._observation = observation
        self.parts = observation.parts * moments
        self._seen: deque[NDArray[np.float32]] = deque(maxlen=moments)
        self._when = (-1, 0.0)

    def values(self, robot: TensegrityRobot, reading: Reading, bearing: Bearing) -> FloatArray:
        """As `Observation` has it, as though it had always been as now."""
        return np.tile(self._observation.values(robot, reading, bearing), self._seen.maxlen or 1)

    def see(self, robot: TensegrityRobot, bearing: Bearing, reading: Reading | None = None) -> NDArray[np.float32]:
        """As `Observation` has it; asked again at the same time, it sees the present anew and remembers no more."""
        now = self._observation.see(robot, bearing, reading)
        if robot.resets != self._when[0]:
            self._seen.extend([now] * (self._seen.maxlen or 1))
        elif robot.time == self._when[1]:
            self._seen[0] = now
        else:
            self._seen.appendleft(now)
        self._when = robot.resets, robot.time
        return np.concatenate(self._seen)


class ConditionedObservation(Observation):
    """Another observation, and where the robot's design lies in the ranges that designs vary over."""

    def __init__(self, observation: Observation, robot: TensegrityRobot, variation: Variation) -> None:
        self._observation = observation
        self._place = variation.normalised(robot.design)
        self.parts = (*observation.parts, Part("design", "robot", len(self._place), 1, 1.0))

    def values(self, robot: TensegrityRobot, reading: Reading, bearing: Bearing) -> FloatArray:
        """As `Observation` has it."""
        return np.concatenate([self._observation.values(robot, reading, bearing), self._place])


OBSERVATIONS: dict[str, Callable[[TensegrityRobot], Observation]] = {
    "full": FullObservation,
    "onboard": OnboardObservation,
    "full-goal": lambda robot: GoalObservation(FullObservation(robot), robot),
    "onboard-goal": lambda robot: GoalObservation(OnboardObservation(robot), robot),
    "onboard-memory": lambda robot: Memory(OnboardObservation(robot)),
    "onboard-goal-memory": lambda robot: Memory(GoalObservation(OnboardObservation(robot), robot)),
}


def make_observation(kind: str, robot: TensegrityRobot, variation: Variation | None = None) -> Observation:
    """What is seen of a robot: one of OBSERVATIONS, with its design where designs vary.

    Raises:
        DesignError: there is no such kind.
    """
    if not isinstance(kind, str) or kind not in OBSERVATIONS:
        raise DesignError(f"observation = {show(kind)} is not one of {', '.join(OBSERVATIONS)}")
    plain: Observation = OBSERVATIONS[kind](robot)
    return ConditionedObservation(plain, robot, variation) if variation else plain
