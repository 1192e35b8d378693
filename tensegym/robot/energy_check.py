"""Designs in which energy would come from nothing, or out of all proportion, at any time step: refused by name."""

from __future__ import annotations

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.design.parameters import Drive, StiffCable
from tensegym.errors import DesignError
from tensegym.physics.drives import winding_speed
from tensegym.physics.model import STIFFNESS, Model
from tensegym.physics.step_limit import Held

SPEED_BOUND = 50.0  # m/s; nothing on these robots moves so fast unless the integration has diverged
HIDDEN = 0.25  # of the deepest pull: what a drive may wind in during its cable's lag; those over it broke the audit


def check_energy(design: RobotDesign, model: Model, rest: Held) -> None:
    """Raise DesignError for springs that would fly apart, and for drives whose cables' dampers hide their pull."""
    _check_springs(design, model, rest)
    drives = zip(design.each_stiff_cable, design.each_drive, design.stiff_cable_lengths, strict=True)
    for cable, drive, length in drives:
        _check_lag(cable, drive, float(length))


def _check_springs(design: RobotDesign, model: Model, rest: Held) -> None:
    """Raise DesignError for natural lengths that leave springs so far from rest that letting go, they make any body
    faster than anything that can be simulated."""
    if not np.isnan(design.rest_tensions).any():
        return  # balanced by form finding, or as given
    energy = float((rest.tensions**2 / (2 * model.spring_params[:, STIFFNESS])).sum())
    if np.sqrt(2 * energy / model.masses.sum()) > SPEED_BOUND:
        lengths = design.standing.lengths(design.standing.cables)
        cable = next(cable for cable in design.each_cable if cable.natural_length is not None)
        raise DesignError(
            f"ElasticCable.natural_length = {cable.natural_length:g} m is far from the {lengths.min():.3g} to "
            f"{lengths.max():.3g} m between the nodes: springs that hold {energy:.3g} J make the robot faster than "
            f"{SPEED_BOUND:g} m/s; take one nearer, or a lower stiffness than {cable.stiffness:g} N/m"
        )


def _check_lag(cable: StiffCable, drive: Drive, length: float) -> None:
    """Raise DesignError for a damper that hides a drive's pull.

    It resists dl/dt alone, not what is wound in, so that a cable's tension k s + c dl/dt follows its stretch s with the
    lag c / k: what a drive winds in meanwhile is stored in the spring at no tension, and so at no work.
    """
    hidden = winding_speed(drive) * cable.damping / cable.stiffness
    pull = cable.max_pull * length
    if hidden > HIDDEN * pull:
        raise DesignError(
            f"StiffCable.damping = {cable.damping:g} N s/m lags behind the drives: with a stiffness of "
            f"{cable.stiffness:g} N/m they wind in {hidden:.3g} m unfelt, of {pull:.3g} m in all, and energy comes "
            f"from nothing; it must be below {HIDDEN * pull / hidden * cable.damping:.3g} N s/m, or the cable stiffer"
        )
