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

from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np
import tomli_w
from numpy.typing import NDArray

from tensegym.arrays import FloatArray, IntArray
from tensegym.design.design import RobotDesign
from tensegym.design.symmetry import symmetries
from tensegym.errors import DesignError
from tensegym.robot.reading import heading_rotation
from tensegym.robot.robot import TensegrityRobot
from tensegym.tables import Checked, bounded, parse_toml

from .bearing import Bearing

if TYPE_CHECKING:
    from .policy import PolicyController

_PAIRS = np.triu_indices(6)
TERMS = 6 + len(_PAIRS[0]) + 1  # linear, quadratic and constant terms of a drive's feedback


@dataclass(frozen=True)
class Cpg(Checked, error=DesignError):
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
    amplitudes: tuple[float, ...] = bounded(-1e3, 1e3, (0.4, 0.4), "", "of each kind of drive's oscillators")
    lags: tuple[float, ...] = bounded(-1e3, 1e3, (0.0, 0.0), "rad", "of each kind of drive's phase")
    feedback: tuple[float, ...] = bounded(-1e6, 1e6, (), "", "weights; none for the fitted ones")

    def __post_init__(self) -> None:
        super().__post_init__()
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
    return tuple(value for row in parse_toml(text, "feedback.toml", DesignError)["feedback"] for value in row)


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
    turn = heading_rotation(direction)
    nodes = (robot.node_positions_in_world() - robot.centre_of_mass_in_world()) @ turn.T / robot.design.length
    return nodes[robot.design.standing.stiff_cables].reshape(-1, 6)


def pose_terms(ends: FloatArray) -> FloatArray:
    """(w, TERMS) linear terms, products of two and 1 of each row of cable ends (w, 6)."""
    return np.column_stack([ends, ends[:, _PAIRS[0]] * ends[:, _PAIRS[1]], np.ones(len(ends))])


class CpgController:
    """A generator as a controller; every episode starts with all phases at their lags.

    Args:
        parameters: of the generator.
        policy: gives the feedback in place of the quadratic form, from -1/2 to 1/2 a drive.
    """

    def __init__(self, parameters: Cpg | None = None, policy: PolicyController | None = None) -> None:
        self.parameters = parameters or Cpg()
        self._policy = policy

    @property
    def period(self) -> float:
        """A command is held for this long [s]."""
        return self.parameters.period

    def begin(self, robot: TensegrityRobot, seed: int = 0) -> None:
        """As `Controller` has it. Raises DesignError where the robot has another number of kinds of drives."""
        p, kinds = self.parameters, drive_kinds(robot.design)
        count = len(np.unique(kinds))
        if count != len(p.amplitudes):
            raise DesignError(
                f"the controller has weights for {len(p.amplitudes)} kinds of drives, the robot has {count}"
            )
        self._weights = np.array(p.feedback).reshape(count, TERMS)[kinds]
        self._amplitudes, self._lags = np.array(p.amplitudes)[kinds], np.array(p.lags)[kinds]
        self.phases = self._lags.copy()
        if self._policy:
            self._policy.begin(robot, seed)

    def _feedback(self, robot: TensegrityRobot, bearing: Bearing) -> NDArray[Any]:
        if self._policy:
            return self._policy.action(robot, bearing) / 2
        return (self._weights * pose_terms(cable_ends_in_heading(robot, bearing.direction))).sum(axis=1)

    def angles(self, robot: TensegrityRobot, bearing: Bearing) -> FloatArray:
        """As `Controller` has it; advances the oscillators by a period."""
        p = self.parameters
        signal = self._feedback(robot, bearing)
        part = np.clip(0.5 + p.gain * signal + self._amplitudes * np.cos(self.phases), 0, 1)
        steps = max(1, round(p.period / 0.02))
        for _ in range(steps):
            ahead = self.phases - self._lags
            pull = np.sin(ahead[None, :] - ahead[:, None]).mean(axis=1)
            rate = 2 * np.pi * p.frequency + p.coupling * pull - p.entrainment * signal * np.sin(self.phases)
            self.phases = self.phases + p.period / steps * rate
        return part * robot.command_limit
