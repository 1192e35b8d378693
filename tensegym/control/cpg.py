"""A central pattern generator for rolling: coupled phase oscillators, one a drive, and feedback from the body's pose.

Every drive has a phase p_i with

    dp_i/dt = 2 pi f + k / n sum_j sin(p_j - p_i - (lag_j - lag_i)) - e s_i sin(p_i)

(Kuramoto oscillators; the last term lets the body entrain them) and is commanded the part

    u_i = clip(1/2 + g s_i + a_i cos(p_i), 0, 1)

of its deepest pull. The feedback s_i is a quadratic form of where the stiff cable's two ends are, in rod lengths from
the centre of mass, in the frame whose x axis is the wanted direction: all that a pull can do to a body that stands on
any face at any heading is a function of these. Drives that the robot's rotations map onto each other share weights, so
that one set serves all faces. Without the oscillators the feedback stalls wherever its own pull is a resting pose.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np
import tomli_w

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.design import RobotDesign
from tensegym.design.parameters import bounded, check_ranges
from tensegym.design.symmetry import symmetries
from tensegym.errors import DesignError
from tensegym.robot.robot import TensegrityRobot

_PAIRS = np.triu_indices(6)
TERMS = 6 + len(_PAIRS[0]) + 1  # linear, quadratic and constant terms of a drive's feedback


@dataclass(frozen=True)
class Cpg:
    """Parameters of the generator. Raises DesignError naming the field that is out of its range.

    feedback: (kinds * TERMS,) weights, for each kind of drive in turn those of `pose_terms`; empty takes the fitted
    ones. amplitudes and lags [rad]: (kinds,). A kind is a set of drives that the robot's rotations map onto each
    other, in the order of its first drive.
    """

    frequency: float = bounded(0, 10, 0.6, "Hz", "of the oscillators when nothing disturbs them")
    coupling: float = bounded(0, 100, 2.0, "rad/s", "pull of the others' phases")
    entrainment: float = bounded(-100, 100, 0.0, "rad/s", "pull of the feedback on the phase")
    gain: float = bounded(0, 100, 2.0, "", "of the feedback")
    period: float = bounded(1e-3, 10, 0.4, "s", "a command is held for this long")
    amplitudes: tuple[float, ...] = (0.4, 0.4)
    lags: tuple[float, ...] = (0.0, 0.0)
    feedback: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        check_ranges(self)
        for name in ("amplitudes", "lags", "feedback"):
            values = tuple(getattr(self, name))
            if not all(isinstance(v, int | float | np.number) and math.isfinite(v) for v in values):
                raise DesignError(f"Cpg.{name} = {values!r} must be finite numbers")
            object.__setattr__(self, name, values)
        if not self.feedback:
            object.__setattr__(self, "feedback", fitted_feedback())
        kinds = len(self.amplitudes)
        if len(self.lags) != kinds or len(self.feedback) != kinds * TERMS:
            raise DesignError(
                f"Cpg.amplitudes of {kinds} kinds of drives want as many lags and {kinds * TERMS} feedback weights; "
                f"given {len(self.lags)} and {len(self.feedback)}"
            )


@cache
def fitted_feedback() -> tuple[float, ...]:
    """Weights fitted to the commands of the shipped rolling policy (`python -m tensegym.train.distil`)."""
    text = (resources.files("tensegym.control") / "feedback.toml").read_text()
    return tuple(value for row in tomllib.loads(text)["feedback"] for value in row)


def feedback_text(weights: FloatArray) -> str:
    """What `fitted_feedback` reads, from weights (kinds, TERMS)."""
    return tomli_w.dumps({"feedback": np.round(weights, 4).tolist()})


def drive_kinds(design: RobotDesign) -> IntArray:
    """(w,) number of each drive's kind: those a rotation of the robot maps onto each other are of one kind."""
    first = np.arange(len(design.standing.stiff_cables))
    for symmetry in symmetries(design):
        first = np.minimum(first, first[symmetry.drives])
    return np.unique(first, return_inverse=True)[1]


def cable_ends_in_heading(robot: TensegrityRobot, direction: FloatArray) -> FloatArray:
    """(w, 6) the two ends of every stiff cable from the centre of mass, in rod lengths; x along ``direction`` (2,)."""
    c, s = direction
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    nodes = (robot.node_positions_in_world() - robot.centre_of_mass_in_world()) @ turn.T / robot.design.length
    return nodes[robot.design.standing.stiff_cables].reshape(-1, 6)


def pose_terms(ends: FloatArray) -> FloatArray:
    """(w, TERMS) linear terms, products of two and 1 of each row of cable ends (w, 6)."""
    return np.column_stack([ends, ends[:, _PAIRS[0]] * ends[:, _PAIRS[1]], np.ones(len(ends))])


class CpgController:
    """A generator driving a robot towards a direction (2,); starts with all phases at their lags.

    feedback: called for the signals (w,), in place of the quadratic form. Raises DesignError where the robot has
    another number of kinds of drives than the parameters.
    """

    def __init__(
        self, robot: TensegrityRobot, parameters: Cpg, direction: FloatArray,
        feedback: Callable[[], FloatArray] | None = None,
    ) -> None:  # fmt: skip
        self.robot, self.parameters, self.direction = robot, parameters, direction
        self._feedback = feedback or self._pose_feedback
        kinds = drive_kinds(robot.design)
        count = int(kinds.max()) + 1
        if count != len(parameters.amplitudes):
            raise DesignError(
                f"the controller has weights for {len(parameters.amplitudes)} kinds of drives, the robot has {count}"
            )
        self._weights = np.array(parameters.feedback).reshape(count, TERMS)[kinds]
        self._amplitudes = np.array(parameters.amplitudes)[kinds]
        self._lags = np.array(parameters.lags)[kinds]
        self.phases = self._lags.copy()

    @property
    def period(self) -> float:
        """A command is held for this long [s]."""
        return self.parameters.period

    def _pose_feedback(self) -> FloatArray:
        return (self._weights * pose_terms(cable_ends_in_heading(self.robot, self.direction))).sum(axis=1)

    def angles(self) -> FloatArray:
        """Commanded spool angles (w,) [rad] for the next period; advances the oscillators by it."""
        p = self.parameters
        signal = self._feedback()
        part = np.clip(0.5 + p.gain * signal + self._amplitudes * np.cos(self.phases), 0, 1)
        steps = max(1, round(p.period / 0.02))
        for _ in range(steps):
            ahead = self.phases - self._lags
            pull = np.sin(ahead[None, :] - ahead[:, None]).mean(axis=1)
            rate = 2 * np.pi * p.frequency + p.coupling * pull - p.entrainment * signal * np.sin(self.phases)
            self.phases = self.phases + p.period / steps * rate
        return part * self.robot.command_limit
