"""TorsionSpring: the paper's 1-DoF pseudo-rigid-body model, a pin with a spring."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import States
from tensegym.flexure.hinge.ranges import check_positive, finite_array

from .pseudo_rigid import torsion_lambda


@dataclass(frozen=True)
class TorsionSpring:
    """A pin at (L (1 - lambda), 0), a rigid link lambda L to the tip, and a spring of constant stiffness."""

    length: float
    """L [m]."""
    fraction: float
    """lambda, of L; above 1 the pin lies behind the hinge's base."""
    stiffness: float
    """[N m/rad]."""

    def __post_init__(self) -> None:
        check_positive("length", self.length, "m")
        finite_array([self.fraction], "lambda", 1)
        check_positive("stiffness", self.stiffness, "N m/rad")

    def poses(self, theta: FloatArray, force: FloatArray) -> States:
        """States at theta (n,) [rad] under the dead force (n, 2) [N] at the tip; the pin does not give."""
        arm = self.fraction * self.length
        link = arm * np.column_stack([np.cos(theta), np.sin(theta)])
        tip = link + np.array([self.length - arm, 0.0])
        moment = self.stiffness * theta - (link[:, 0] * force[:, 1] - link[:, 1] * force[:, 0])
        return States(theta, tip, np.broadcast_to(force, (len(theta), 2)), moment)

    def energies(self, states: States) -> FloatArray:
        """(n,) strain energy [J]."""
        return 0.5 * self.stiffness * states.theta**2


def fit_torsion(states: States, length: float) -> TorsionSpring:
    """lambda by F1, then the stiffness by least squares on the moment about the pin.

    Args:
        states: a sweep of 3 or more.
        length: L [m].

    Raises:
        FlexureError: for too few states, or a stiffness that is not positive.
    """
    fraction = torsion_lambda(states, length)
    return TorsionSpring(length, fraction, stiffness_about(states, length * (1 - fraction)))


def stiffness_about(states: States, place: float) -> float:
    """Stiffness of a pin by least squares on the moment about it.

    Args:
        states: those that are not whole are passed over.
        place: of the pin on the hinge's axis [m], from the base.

    Returns:
        [N m/rad].
    """
    whole = states.whole()
    if len(whole) < 2:
        raise FlexureError(f"{len(whole)} states with tip, force and moment; the torsion spring needs 2 or more")
    pin = whole.tip - [place, 0.0]
    about_pin = whole.moment + pin[:, 0] * whole.force[:, 1] - pin[:, 1] * whole.force[:, 0]
    return float(whole.theta @ about_pin / (whole.theta @ whole.theta))
