"""A URDF in which a named revolute joint is a flexure: text in, text out; no mesh is touched.

    parent --(prismatic x)--(prismatic y)--[prismatic z]--(revolute)--[revolute y]--[revolute x]--(fixed)-- child

The links between have no mass. At zero every joint leaves the child where the file has it.
"""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError


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


def parse(text: str, what: str) -> ET.Element:
    """Root of a URDF. Raises FlexureError naming ``what``."""
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise FlexureError(f"{what} is no XML: {error}") from error
    if root.tag != "robot":
        raise FlexureError(f"{what} is no URDF: its root is <{root.tag}>, not <robot>")
    return root


def revolute_joint(root: ET.Element, name: str, what: str) -> ET.Element:
    """The revolute or continuous joint of that name.

    Raises FlexureError for a name that is not there, another kind of joint, or a revolute joint without its limit.
    """
    joints = {str(joint.get("name")): joint for joint in root.findall("joint")}
    if name not in joints:
        raise FlexureError(f"{what} has no joint {name!r}; its joints are {', '.join(sorted(joints)) or 'none'}")
    joint = joints[name]
    kind = joint.get("type")
    if kind not in ("revolute", "continuous"):
        raise FlexureError(f"joint {name!r} of {what} is {kind}; a flexure takes the place of a revolute joint")
    limit = joint.find("limit")
    if kind == "revolute" and (limit is None or limit.get("lower") is None or limit.get("upper") is None):
        raise FlexureError(f"joint {name!r} of {what} is revolute without a limit; give it <limit lower= upper=>, or "
                           "make it continuous")  # fmt: skip
    return joint


def base_link(root: ET.Element) -> str:
    """The link that is no joint's child."""
    children = {_end(joint, "child") for joint in root.findall("joint")}
    return next(str(link.get("name")) for link in root.findall("link") if link.get("name") not in children)


def axis_of(joint: ET.Element) -> FloatArray:
    """(3,) unit axis in the joint's frame; URDF's default is x."""
    element = joint.find("axis")
    axis = _vector(element.get("xyz", "1 0 0") if element is not None else "1 0 0")
    return axis / np.linalg.norm(axis)


def put_chain(root: ET.Element, joint: ET.Element, chain: Chain) -> None:
    """Replace ``joint`` in place. The revolute joint keeps its name and its limit, the stop of the rotation."""
    name, parent, child = str(joint.get("name")), _end(joint, "parent"), _end(joint, "child")
    frame = Rotation.from_matrix(np.column_stack([chain.along, np.cross(axis_of(joint), chain.along), axis_of(joint)]))
    origin = joint.find("origin")
    place = _vector(origin.get("xyz", "0 0 0")) if origin is not None else np.zeros(3)
    turned = Rotation.from_euler("xyz", _vector(origin.get("rpy", "0 0 0")) if origin is not None else np.zeros(3))
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
        ET.SubElement(new, "axis", xyz=_text(axes[key]))
        limit = joint.find("limit")
        if slides:  # an empty range is PyBullet's way to say none
            ET.SubElement(new, "limit", lower="1", upper="0", effort="1e9", velocity="1e9")
        elif not key and limit is not None:
            new.append(limit)
        made += [ET.Element("link", name=link), new]
        inertial = ET.SubElement(made[-2], "inertial")
        ET.SubElement(inertial, "mass", value="0")
        ET.SubElement(inertial, "inertia", dict.fromkeys(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), "0"))
        at, start, start_turn = link, np.zeros(3), Rotation.identity()
    made.append(_joint(f"{name}/end", "fixed", at, child, frame.inv().apply(-chain.moving), frame.inv()))
    for element in reversed(made):
        root.insert(index, element)


def to_text(root: ET.Element, folder: Path) -> str:
    """URDF text in short lines (PyBullet's parser breaks on long ones), mesh paths made absolute from ``folder``."""
    for mesh in root.iter("mesh"):
        name = mesh.get("filename", "")
        if name and "://" not in name and not Path(name).is_absolute() and (folder / name).exists():
            mesh.set("filename", str((folder / name).resolve()))
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _joint(name: str, kind: str, parent: str, child: str, place: FloatArray, turn: Rotation) -> ET.Element:
    joint = ET.Element("joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # at gimbal lock any of the angles that make the turn will do
        angles = turn.as_euler("xyz")
    ET.SubElement(joint, "origin", xyz=_text(place), rpy=_text(angles))
    return joint


def _end(joint: ET.Element, end: str) -> str:
    element = joint.find(end)
    if element is None or element.get("link") is None:
        raise FlexureError(f"joint {joint.get('name')!r} has no <{end} link=...>")
    return str(element.get("link"))


def _vector(text: str) -> FloatArray:
    return np.array([float(part) for part in text.split()])


def _text(values: FloatArray | tuple[int, ...]) -> str:
    return " ".join(f"{v:.17g}" for v in values)
