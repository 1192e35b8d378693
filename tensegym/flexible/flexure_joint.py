"""FlexureJoint: a fitted planar spring between two links of a robot in PyBullet."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import Box
from tensegym.flexure.hinge.box import SLACK
from tensegym.flexure.hinge.ranges import check_not_negative, finite_array, is_number, shown
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_file import load_joint
from tensegym.flexure.models.torsion_spring import TorsionSpring

from . import spring_kernel
from .springs import Spring, Springs, spring_row
from .urdf_rewrite import Chain


class Host(Protocol):
    """What a flexure needs of its robot, a FlexibleRobot: to be built in, and to read where it is."""

    @property
    def springs(self) -> Springs: ...

    @property
    def positions(self) -> FloatArray: ...

    def put(self, flexure: FlexureJoint) -> None: ...


@dataclass(frozen=True)
class Outside:
    """How far a flexure has been outside the domain its model was fitted on since the last reset."""

    steps: int
    """Time steps that began outside."""
    margin: float
    """The worst distance to the limit, negative outside; 1 before the first step."""
    time: float
    """When that was [s]."""


class FlexureJoint:
    """A revolute joint of a robot replaced by a fitted flexure; reloads the robot, at rest.

    The hinge's base frame has its z along the URDF joint's axis, its x along ``along``, and stands so that the URDF's
    axis passes through the hinge at the fraction ``centre`` of its length: no link moves when the joint is put in.

    Args:
        robot: a FlexibleRobot.
        joint: name of its revolute joint.
        model: a fitted Joint, one of its models with the ``box`` it holds on, or the path of a joint file.
        kind: which model of a Joint: potential, planar or torsion.
        box: where the model holds; default: the Joint's or the Potential's own.
        along: (3,) the hinge's x in the URDF joint's frame, across the axis; default: the part of the frame's x across
            the axis, or of y where the axis is nearly x.
        centre: where on the hinge's length the URDF joint's axis passes, as a fraction.
        loss_time: structural damping B = loss_time x K(q), Kelvin-Voigt [s]; a mode of frequency w [rad/s] then has
            the damping ratio loss_time w / 2.
        across: (3,) stiffnesses of z [N/m] and of the turns about y and x [N m/rad], all about the tip; without it
            these three are held.

    Attributes:
        outside: how far it has been outside the box since the robot was placed.

    Raises:
        FlexureError: for a joint that is not there or not revolute, a model without an energy, one without a limit, a
            value out of range.
    """

    def __init__(
        self, robot: Host, joint: str, model: Joint | Spring | str | Path, *, kind: str = "potential",
        box: Box | None = None, along: ArrayLike | None = None, centre: float = 0.5, loss_time: float = 0.0,
        across: tuple[float, float, float] | None = None,
    ) -> None:  # fmt: skip
        fitted = load_joint(model) if isinstance(model, str | Path) else model
        if isinstance(fitted, Joint):
            spring, box = fitted.model(kind), box or fitted.box
        else:
            spring, box = fitted, box or getattr(fitted, "box", None)
        spring_row(spring)  # refuses a model without an energy
        if box is None:  # of a spring of its own
            kind = type(spring).__name__
            raise FlexureError(f"joint {joint!r}: a {kind} alone has no limit; give box=Box(angle, force)")
        check_not_negative(f"joint {joint!r}: loss_time", loss_time, "s")
        if not is_number(centre):
            raise FlexureError(f"joint {joint!r}: centre = {shown(centre)}; give a fraction of the hinge's length")
        if across is not None and not (finite_array(across, f"joint {joint!r}: across", 3) > 0).all():
            raise FlexureError(f"joint {joint!r}: across = {across}; give 3 stiffnesses above 0 (z, about y, about x)")
        self.robot, self.name, self.box = robot, joint, box
        self.spring: Spring = spring  # type: ignore[assignment]
        self.loss_time, self.across, self.centre = float(loss_time), across, float(centre)
        self._along = None if along is None else finite_array(along, f"joint {joint!r}: along", 3)
        self.row, self._warned = -1, False
        self.outside = Outside(0, 1.0, 0.0)
        robot.put(self)

    def chain(self, axis: FloatArray) -> Chain:
        """The moving joints, for a URDF joint with this unit ``axis`` in its frame."""
        along = self._along
        if along is None:
            along = np.array([0.0, 1.0, 0.0] if abs(axis[0]) > 0.9 else [1.0, 0.0, 0.0])
            if abs(along @ axis) > 0:
                along = along - (along @ axis) * axis
        if not abs(along @ axis) < 1e-6 * np.linalg.norm(along):
            raise FlexureError(f"joint {self.name!r}: along = {along.tolist()} is not across the axis {axis.tolist()}")
        along = along / np.linalg.norm(along)
        pin = isinstance(self.spring, TorsionSpring)
        length = self.spring.length
        start = length * (1 - self.spring.fraction) if isinstance(self.spring, TorsionSpring) else length
        return Chain(along, (start - self.centre * length) * along, not pin, self.across is not None)

    @property
    def pose(self) -> FloatArray:
        """(3,) tip x, y [m] and theta [rad] in the hinge's base axes, now."""
        return self._now()[0][:3]

    @property
    def wrench(self) -> FloatArray:
        """(3,) force x, y [N] in base axes and moment about the tip [N m] by which the next link strains the spring."""
        return self._now()[1][:3]

    @property
    def energy(self) -> float:
        """Energy stored in the spring [J]."""
        return self._now()[2]

    @property
    def margin(self) -> float:
        """Distance to the limit of the model: 1 in the middle of its box (at rest, where forces run from -F to F), 0 on
        the limit, negative outside (spring_kernel.margin)."""
        pose, gradient, _ = self._now()
        return float(spring_kernel.margin(self.robot.springs, self.row, pose, gradient))

    def _now(self) -> tuple[FloatArray, FloatArray, float]:
        pose, gradient = np.empty(6), np.empty(6)
        spring_kernel.pose_of(self.robot.springs, self.row, self.robot.positions, pose)
        energy = spring_kernel.spring(self.robot.springs, self.row, pose, gradient, np.empty((6, 6)))
        return pose, gradient, float(energy)

    def note(self, margin: float, time: float) -> None:
        """Keep the worst margin; count a step outside the fitted domain; the first one ever warns."""
        past = self.outside
        if margin >= -SLACK:  # a box of pulls alone has rest on its limit
            if margin < past.margin:
                self.outside = Outside(past.steps, margin, time)
            return
        if not self._warned:
            self._warned = True
            theta, force, limit = np.degrees(self.pose[2]), self.wrench[:2], self.box
            warnings.warn(
                f"flexure {self.name!r} left its fitted domain at t = {time:.4g} s: theta = {theta:.4g} of "
                f"+-{np.degrees(limit.max_angle):.4g} deg, force ({force[0]:.4g}, {force[1]:.4g}) of "
                f"{limit.told()}, margin {margin:.3g}; what follows is extrapolated (see .outside)",
                UserWarning, stacklevel=3,
            )  # fmt: skip
        worst = margin < past.margin
        self.outside = Outside(past.steps + 1, margin if worst else past.margin, time if worst else past.time)
