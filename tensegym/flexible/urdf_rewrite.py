"""A URDF in which a named revolute joint is a flexure: text in, text out; no mesh is touched.

    parent --(prismatic x)--(prismatic y)--[prismatic z]--(revolute)--[revolute y]--[revolute x]--(fixed)-- child

The links between have no mass. At zero every joint leaves the child where the file has it.
"""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

from .urdf_audit import add_inertial
from .urdf_xml import as_text, axis_of, end_of, numbers


@dataclass(frozen=True)
class Chain:
    """Where the moving joints of a flexure stand in the frame of the URDF joint they replace."""

    along: FloatArray
    """(3,) unit vector of the hinge's base x axis."""
    moving: FloatArray
    """(3,) point about which the revolute joint turns and to which x and y belong [m]: the tip at rest, or the pin."""
    slides: bool
    """With prismatic x and y; without, the joint is a pin."""
    across: bool
    """With z and the two turns out of the plane."""

    def names(self, joint: str) -> list[str | None]:
        """Names of the joints x, y, theta, z, turn about y, turn about x; None where the chain has none."""
        slides = [f"{joint}/x", f"{joint}/y"] if self.slides else [None, None]
        across = [f"{joint}/z", f"{joint}/ry", f"{joint}/rx"] if self.across else [None] * 3
        return [*slides, joint, *across]


def revolute_joint(root: ET.Element, name: str, what: str) -> ET.Element:
    """The revolute or continuous joint of that name.

    Raises FlexureError for a name that is not there or another kind of joint.
    """
    joints = {str(joint.get("name")): joint for joint in root.findall("joint")}
    if name not in joints:
        raise FlexureError(f"{what} has no joint {name!r}; its joints are {', '.join(sorted(joints)) or 'none'}")
    joint = joints[name]
    kind = joint.get("type")
    if kind not in ("revolute", "continuous"):
        raise FlexureError(f"joint {name!r} of {what} is {kind}; a flexure takes the place of a revolute joint")
    return joint


def put_chain(root: ET.Element, joint: ET.Element, chain: Chain) -> None:
    """Replace ``joint`` in place. The revolute joint keeps its name and its limit, the stop of the rotation."""
    name, parent, child = str(joint.get("name")), end_of(joint, "parent"), end_of(joint, "child")
    frame = Rotation.from_matrix(np.column_stack([chain.along, np.cross(axis_of(joint), chain.along), axis_of(joint)]))
    origin = joint.find("origin")
    place = numbers(joint, origin, "xyz", "0 0 0") if origin is not None else np.zeros(3)
    turned = Rotation.from_euler("xyz", numbers(joint, origin, "rpy", "0 0 0") if origin is not None else np.zeros(3))
    start, start_turn = place + turned.apply(chain.moving), turned * frame

    axes = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "": (0, 0, 1), "ry": (0, 1, 0), "rx": (1, 0, 0)}
    order = ["x", "y"] * chain.slides + ["z"] * chain.across + [""] + ["ry", "rx"] * chain.across
    index = list(root).index(joint)
    root.remove(joint)
    at, made = parent, []
    for key in order:
        title = f"{name}/{key}" if key else name
        link = f"{name}/link_{key or 'theta'}"
        slides = key in ("x", "y", "z")
        kind = "prismatic" if slides else str(joint.get("type")) if not key else "continuous"
        new = _joint(title, kind, at, link, start, start_turn)
        ET.SubElement(new, "axis", xyz=as_text(axes[key]))
        limit = joint.find("limit")
        if slides:  # an empty range is PyBullet's way to say none
            ET.SubElement(new, "limit", lower="1", upper="0", effort="1e9", velocity="1e9")
        elif not key and limit is not None:
            new.append(limit)
        made += [ET.Element("link", name=link), new]
        add_inertial(made[-2])
        at, start, start_turn = link, np.zeros(3), Rotation.identity()
    made.append(_joint(f"{name}/end", "fixed", at, child, frame.inv().apply(-chain.moving), frame.inv()))
    for element in reversed(made):
        root.insert(index, element)


def _joint(name: str, kind: str, parent: str, child: str, place: FloatArray, turn: Rotation) -> ET.Element:
    joint = ET.Element("joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # at gimbal lock any of the angles that make the turn will do
        angles = turn.as_euler("xyz")
    ET.SubElement(joint, "origin", xyz=as_text(place), rpy=as_text(angles))
    return joint
