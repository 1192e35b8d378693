"""A URDF's XML: parsed, its numbers read, its elements named, its text written."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

DEEPEST = 50  # elements inside one another; a URDF has 6


def parse(content: bytes, what: str) -> ET.Element:
    """Root of a URDF. Raises FlexureError naming ``what`` for content that is no XML or no URDF."""
    depth, parser = 0, ET.XMLPullParser(("start", "end"))  # type: ignore[var-annotated]
    try:
        parser.feed(content)
        for event in parser.read_events():
            depth += 1 if event[0] == "start" else -1
            if depth > DEEPEST:
                raise FlexureError(f"{what}: elements stand more than {DEEPEST} deep in one another: no URDF")
        root = ET.fromstring(content)
    except (ET.ParseError, ValueError, LookupError) as error:
        raise FlexureError(f"{what} is no XML: {str(error)[:200]}") from error
    if root.tag != "robot":
        raise FlexureError(f"{what} is no URDF: its root is <{root.tag[:40]}>, not <robot>")
    return root


def title(element: ET.Element) -> str:
    """How an error names a link or a joint."""
    return f"{element.tag} {element.get('name')!r}"


def numbers(owner: ET.Element, element: ET.Element, attribute: str, default: str | None = None, count: int = 3,
            where: str = "") -> FloatArray:  # fmt: skip
    """(count,) finite numbers of an attribute.

    Args:
        owner: the link or joint that an error names.
        element: what has the attribute.
        attribute: its name.
        default: its text where it is missing; None: it must be there.
        count: of numbers.
        where: begins an error.

    Raises:
        FlexureError: naming owner, element, attribute and text.
    """
    text = element.get(attribute, default)
    what = f"{where}{title(owner)}: <{element.tag}>"
    if text is None:
        raise FlexureError(f"{what} has no {attribute}=")
    try:
        values = [float(part) for part in text.split()]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        wanted = f"{count} finite numbers" if count > 1 else "a finite number"
        raise FlexureError(f"{what} {attribute} = {text[:80]!r}; give {wanted}")
    return np.array(values)


def end_of(joint: ET.Element, end: str) -> str:
    """Name of a joint's parent or child link."""
    element = joint.find(end)
    if element is None or element.get("link") is None:
        raise FlexureError(f"{title(joint)} has no <{end} link=...>")
    return str(element.get("link"))


def base_link(root: ET.Element) -> str:
    """The link that is no joint's child. Raises FlexureError unless there is exactly one."""
    children = {end_of(joint, "child") for joint in root.findall("joint")}
    roots = [str(link.get("name")) for link in root.findall("link") if link.get("name") not in children]
    if len(roots) != 1:
        raise FlexureError(f"a robot has one link that is no joint's child; here are {len(roots)}: "
                           f"{', '.join(roots[:5]) or 'every link hangs on another'}")  # fmt: skip
    return roots[0]


def axis_of(joint: ET.Element) -> FloatArray:
    """(3,) unit axis in the joint's frame; URDF's default is x."""
    element = joint.find("axis")
    axis = numbers(joint, element, "xyz", "1 0 0") if element is not None else np.array([1.0, 0.0, 0.0])
    size = float(np.linalg.norm(axis))
    if not size > 0:
        raise FlexureError(f"{title(joint)}: <axis> xyz = '0 0 0' has no direction")
    return np.asarray(axis / size)


def to_text(root: ET.Element) -> str:
    """URDF text in short lines: PyBullet's parser breaks on long ones."""
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def as_text(values: FloatArray | tuple[float, ...]) -> str:
    """Numbers as an attribute has them, every digit kept."""
    return " ".join(f"{v:.17g}" for v in values)
