"""Flexures of a robot, declared in a TOML file beside its URDF; the URDF stays as it is.

    urdf = "leg.urdf"               # beside this file, or a URDF that ships with the package
    [[flexure]]
    joint = "knee"                  # the revolute joint it takes the place of
    hinge = "leaf-spring"           # a preset, or a hinge's TOML file
    fit = "leaf.json"               # optional: a file of `tensegym flexure fit`; without it the hinge is fitted now
    model = "potential"             # optional: potential, planar (constant k) or torsion
    along = [1.0, 0.0, 0.0]         # optional: the hinge's x in the joint's frame, across the axis
    centre = 0.5                    # optional: where on the hinge's length the joint's axis is
    loss_time_s = 1e-4              # optional: structural damping B = loss time x K(q)
    out_of_plane = [1e5, 50, 50]    # optional: N/m along z, N m/rad about y and x; without it these three are held

With ``fit`` and no ``hinge`` (a joint fitted to measured data has none) the joint is taken as it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tensegym.bullet import packaged_urdf
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import as_hinge
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_file import load_joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.tables import Checked, choice, fill, in_file, known, noted, read_toml, show

from .flexible_robot import FlexibleRobot
from .flexure_joint import FlexureJoint

MODELS = ("potential", "planar", "torsion")


@dataclass(frozen=True)
class Section(Checked, error=FlexureError):
    """A [[flexure]] section; what its fields mean is said above."""

    joint: str = noted(what="the revolute joint it takes the place of")
    hinge: str | None = noted(None, "a preset, or a hinge's TOML file")
    fit: str | None = noted(None, "a file of `tensegym flexure fit`; without it the hinge is fitted now")
    model: str = choice(*MODELS, what="which of the fitted models")
    along: tuple[float, float, float] | None = noted(None, "the hinge's x in the joint's frame, across the axis")
    centre: float = noted(0.5, "where on the hinge's length the joint's axis is")
    loss_time_s: float = noted(0.0, "structural damping over stiffness [s]")
    out_of_plane: tuple[float, float, float] | None = noted(None, "N/m along z, N m/rad about y and x")


def load_robot(path: str | Path, **options: Any) -> FlexibleRobot:
    """The robot of a flexure file; ``options`` go to FlexibleRobot.

    Raises FlexureError naming the file and the field, FileNotFoundError for a file that is not there. Nothing is
    loaded into PyBullet before the whole file has been read.
    """
    path = Path(path)
    data = read_toml(path, "flexure file", FlexureError)
    with in_file(str(path)):
        known(data, ("urdf", "flexure"), "the file", FlexureError)
        if not isinstance(data.get("urdf"), str):
            raise FlexureError(f"urdf = {show(data.get('urdf'))}; give the name of a URDF file")
        if not isinstance(data.get("flexure"), list) or not data["flexure"]:
            raise FlexureError("there is no flexure; add a [[flexure]] section")
        sections = [fill(Section, table, f"flexure {i + 1}", FlexureError) for i, table in enumerate(data["flexure"])]
        fitted = [_fitted(path, section) for section in sections]
    urdf = path.parent / data["urdf"]
    robot = FlexibleRobot(urdf if urdf.is_file() else packaged_urdf(data["urdf"]) or urdf, **options)
    try:
        with in_file(str(path)):
            for section, joint in zip(sections, fitted, strict=True):
                FlexureJoint(robot, section.joint, joint, kind=section.model, along=section.along,
                             centre=section.centre, loss_time=section.loss_time_s,
                             across=section.out_of_plane)  # fmt: skip
    except FlexureError:
        robot.close()
        raise
    return robot


def _fitted(path: Path, section: Section) -> Joint:
    """The joint of one section, read or fitted. Raises FlexureError."""
    named, fit = section.hinge, section.fit
    if named is None and fit is None:
        raise FlexureError(f"the flexure of joint {section.joint!r} has neither hinge nor fit")
    hinge = None
    if named is not None:
        hinge = as_hinge(path.parent / named if named.endswith(".toml") else named)
    if fit is None:
        assert hinge is not None
        return fit_joint(hinge, held_out=0)
    joint = load_joint(path.parent / fit)
    if hinge is not None and joint.hinge != hinge:
        raise FlexureError(f"{fit} was fitted to another hinge ({joint.source}), not to {hinge.describe()}")
    return joint
