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

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tensegym.bullet import packaged_urdf
from tensegym.errors import FlexureError
from tensegym.flexure.hinge import as_hinge
from tensegym.flexure.models.joint import Joint
from tensegym.flexure.models.joint_file import load_joint
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.tables import read_toml

from .flexible_robot import FlexibleRobot
from .flexure_joint import FlexureJoint

MODELS = ("potential", "planar", "torsion")
_FIELDS = {"joint", "hinge", "fit", "model", "along", "centre", "loss_time_s", "out_of_plane"}


def load_robot(path: str | Path, **options: Any) -> FlexibleRobot:
    """The robot of a flexure file; ``options`` go to FlexibleRobot.

    Raises FlexureError naming the file and the field, FileNotFoundError for a file that is not there. Nothing is
    loaded into PyBullet before the whole file has been read.
    """
    path = Path(path)
    data = read_toml(path, "flexure file", FlexureError)
    _known(path, "the file", data, {"urdf", "flexure"})
    if not isinstance(data.get("urdf"), str):
        raise FlexureError(f"{path}: urdf = {data.get('urdf')!r}; give the name of a URDF file")
    sections = data.get("flexure")
    if not isinstance(sections, list) or not sections:
        raise FlexureError(f"{path} declares no flexure; add a [[flexure]] section")
    fitted = [_fitted(path, section) for section in sections]
    urdf = path.parent / data["urdf"]
    robot = FlexibleRobot(urdf if urdf.is_file() else packaged_urdf(data["urdf"]) or urdf, **options)
    try:
        for section, joint in zip(sections, fitted, strict=True):
            across = section.get("out_of_plane")
            FlexureJoint(
                robot, section["joint"], joint, kind=section.get("model", "potential"), along=section.get("along"),
                centre=section.get("centre", 0.5), loss_time=section.get("loss_time_s", 0.0),
                across=None if across is None else tuple(across),
            )  # fmt: skip
    except FlexureError as error:
        robot.close()
        raise FlexureError(f"{path}: {error}") from error
    return robot


def _fitted(path: Path, section: Any) -> Joint:
    """The joint of one section, read or fitted. Raises FlexureError."""
    if not isinstance(section, dict):
        raise FlexureError(f"{path}: flexure = {section!r}; give a [[flexure]] section")
    _known(path, "a flexure", section, _FIELDS)
    if not isinstance(section.get("joint"), str):
        raise FlexureError(f"{path}: a flexure has no joint; name the revolute joint it takes the place of")
    for name, count in (("along", 3), ("out_of_plane", 3), ("centre", 1), ("loss_time_s", 1)):
        _numbers(path, section, name, count)
    if section.get("model", "potential") not in MODELS:
        raise FlexureError(f"{path}: model = {section['model']!r}; one of {', '.join(MODELS)}")
    named, fit = section.get("hinge"), section.get("fit")
    if named is None and fit is None:
        raise FlexureError(f"{path}: the flexure of joint {section['joint']!r} has neither hinge nor fit")
    hinge = None
    if named is not None:
        beside = path.parent / str(named)
        hinge = as_hinge(beside if str(named).endswith(".toml") else str(named))
    if fit is None:
        assert hinge is not None
        return fit_joint(hinge, held_out=0)
    joint = load_joint(path.parent / str(fit))
    if hinge is not None and joint.hinge != hinge:
        raise FlexureError(f"{path}: {fit} was fitted to another hinge ({joint.source}), not to {hinge.describe()}")
    return joint


def _known(path: Path, what: str, data: dict[str, Any], allowed: Sequence[str] | set[str]) -> None:
    for key in data:
        if key not in allowed:
            raise FlexureError(f"{path}: {what} has no field {key!r}; its fields are {', '.join(sorted(allowed))}")


def _numbers(path: Path, section: dict[str, Any], name: str, count: int) -> None:
    if name not in section:
        return
    values = section[name] if count > 1 else [section[name]]
    good = isinstance(values, list) and len(values) == count
    if not good or any(isinstance(v, bool) or not isinstance(v, int | float) for v in values):
        wanted = "a number" if count == 1 else f"{count} numbers"
        raise FlexureError(f"{path}: {name} = {section[name]!r}; give {wanted}")
