"""A URDF looked through before the engine sees it: what it means is kept, or a line says what cannot be.

Left alone, PyBullet gives a link without <inertial> 1 kg and 1 kg m^2, reads a number it cannot read as zero, takes an
axis of length 2 for twice the motion, makes an impossible inertia zero, and says so on standard output at best.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from tensegym.errors import FlexureError

from .urdf_meshes import resolve_meshes
from .urdf_xml import as_text, axis_of, base_link, end_of, numbers, title

KINDS = ("revolute", "continuous", "prismatic", "fixed")
_MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
_SIZES = (("box", "size", 3), ("sphere", "radius", 1), ("cylinder", "radius", 1), ("cylinder", "length", 1),
          ("capsule", "radius", 1), ("capsule", "length", 1))  # fmt: skip
# Of an inertia: by so much the moments of a flat body may miss each other's sum, and so much below it they are put
ROUNDING, MARGIN = 1e-6, 1e-9


def audit(root: ET.Element, folder: Path, what: str, fixed_base: bool) -> tuple[str, ...]:
    """Check a URDF and complete it in place.

    Args:
        root: the URDF.
        folder: where its file lies, for its meshes.
        what: names it in an error.
        fixed_base: whether its base link will be held; a floating one needs a mass.

    Returns:
        A line for everything in it that is not simulated.

    Raises:
        FlexureError: for what cannot be what it says, naming link or joint, element, attribute and value.
    """
    try:
        _refuse_macros(root)
        links = _named(root, "link")
        joints = _named(root, "joint")
        for joint in joints.values():
            _check_joint(joint, links)
        base = base_link(root)
        for link in links.values():
            _complete_inertial(link)
            _check_shapes(link)
        _check_tree(base, links, joints, fixed_base)
    except FlexureError as error:
        raise FlexureError(f"{what}: {error}") from None
    return (*resolve_meshes(root, folder, what), *_left_out(links, joints))


def revolute_without_limit(joint: ET.Element) -> bool:
    """Whether a joint that needs stops has none."""
    limit = joint.find("limit")
    return joint.get("type") in ("revolute", "prismatic") and (
        limit is None or limit.get("lower") is None or limit.get("upper") is None
    )


def _refuse_macros(root: ET.Element) -> None:
    for top in root:
        for element in top.iter():
            tag = element.tag.rpartition("}")[2]
            if "xacro" in element.tag:
                raise FlexureError(f"<xacro:{tag}> is left in it; run xacro on the file first")
            for attribute, text in element.attrib.items():
                if "${" in text or "$(" in text:
                    raise FlexureError(f"{title(top)}: <{tag}> {attribute} = {text[:80]!r} holds a xacro expression; "
                                       "run xacro on the file first")  # fmt: skip


def _named(root: ET.Element, tag: str) -> dict[str, ET.Element]:
    out: dict[str, ET.Element] = {}
    for element in root.findall(tag):
        name = element.get("name")
        if not name:
            raise FlexureError(f"a {tag} has no name")
        if name in out:
            raise FlexureError(f"{tag} {name!r} is there twice")
        out[name] = element
    return out


def _check_joint(joint: ET.Element, links: dict[str, ET.Element]) -> None:
    if joint.get("type") not in KINDS:
        raise FlexureError(f"{title(joint)}: type = {joint.get('type')!r}; one of {', '.join(KINDS)}")
    for end in ("parent", "child"):
        if end_of(joint, end) not in links:
            raise FlexureError(f"{title(joint)}: its {end} {end_of(joint, end)!r} is no link of the file")
    _check_origin(joint, joint)
    element = joint.find("axis")
    if joint.get("type") != "fixed":
        axis = axis_of(joint)
        if element is not None and not abs(np.linalg.norm(numbers(joint, element, "xyz", "1 0 0")) - 1) < 1e-12:
            element.set("xyz", as_text(axis))  # the engine takes its length for a ratio
    if revolute_without_limit(joint):
        raise FlexureError(f"{title(joint)} is {joint.get('type')} without a limit; give it <limit lower= upper=>, or "
                           "make it continuous")  # fmt: skip
    for tag, attributes in (("limit", ("lower", "upper")), ("dynamics", ("damping", "friction"))):
        for found in joint.findall(tag):
            for attribute in attributes:
                numbers(joint, found, attribute, "0", 1)
    dynamics = joint.find("dynamics")
    if dynamics is not None and numbers(joint, dynamics, "damping", "0", 1)[0] < 0:
        raise FlexureError(f"{title(joint)}: <dynamics> damping = {dynamics.get('damping')}; give 0 or more")


def _check_origin(owner: ET.Element, element: ET.Element) -> None:
    for origin in element.findall("origin"):
        numbers(owner, origin, "xyz", "0 0 0")
        numbers(owner, origin, "rpy", "0 0 0")


def _check_shapes(link: ET.Element) -> None:
    for shape in [*link.findall("visual"), *link.findall("collision")]:
        _check_origin(link, shape)
        for tag, attribute, count in _SIZES:
            for body in shape.iter(tag):
                if not (numbers(link, body, attribute, count=count) > 0).all():
                    raise FlexureError(f"{title(link)}: <{tag}> {attribute} = {body.get(attribute)!r}; give sizes "
                                       "above 0")  # fmt: skip


def _complete_inertial(link: ET.Element) -> None:
    """Check mass and inertia; a link without them gets none, not the engine's own."""
    inertial = link.find("inertial")
    if inertial is None:
        add_inertial(link)
        return
    _check_origin(link, inertial)
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    if mass is None or inertia is None:
        raise FlexureError(f"{title(link)}: <inertial> has no <{'mass' if mass is None else 'inertia'}>")
    kilograms = float(numbers(link, mass, "value", count=1)[0])
    ixx, iyy, izz, ixy, ixz, iyz = (float(numbers(link, inertia, k, "0", 1)[0]) for k in _MOMENTS)
    least, middle, most = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    if kilograms < 0 or (kilograms == 0 and most > 0):
        raise FlexureError(f"{title(link)}: mass = {kilograms:g} kg beside an inertia; give a mass above 0")
    if least < -ROUNDING * most or most > (1 + ROUNDING) * (least + middle):
        raise FlexureError(f"{title(link)}: no body has the principal moments {least:.4g}, {middle:.4g}, {most:.4g} "
                           "kg m^2: none is negative and none above the other two together")  # fmt: skip
    flat = most - (1 - MARGIN) * (least + middle)
    if most > 0 and (flat > 0 if ixy or ixz or iyz else most > least + middle):
        # by rounding the engine, which turns it to its principal axes, would find it impossible, and make it zero
        for key, value in (("ixx", ixx), ("iyy", iyy), ("izz", izz)):
            inertia.set(key, as_text((value + flat,)))


def add_inertial(link: ET.Element) -> None:
    """Give a link no mass and no inertia, in words: without them the engine gives it 1 kg and 1 kg m^2."""
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "mass", value="0")
    ET.SubElement(inertial, "inertia", dict.fromkeys(_MOMENTS, "0"))


def _mass(link: ET.Element) -> float:
    mass = link.find("inertial/mass")
    assert mass is not None
    return float(numbers(link, mass, "value", count=1)[0])


def _check_tree(base: str, links: dict[str, ET.Element], joints: dict[str, ET.Element], fixed_base: bool) -> None:
    """One tree from the base, and a mass beyond every joint that moves."""
    below: dict[str, list[ET.Element]] = {name: [] for name in links}
    for joint in joints.values():
        below[end_of(joint, "parent")].append(joint)
    order, met = [base], {base}
    for name in order:
        for joint in below[name]:
            child = end_of(joint, "child")
            if child in met:
                raise FlexureError(f"link {child!r} is the child of two joints; a robot is a tree")
            met.add(child)
            order.append(child)
    if len(order) < len(links):
        lost = next(name for name in links if name not in met)
        raise FlexureError(f"no joints lead from {base!r} to link {lost!r}: a loop")
    if not fixed_base and not _mass(links[base]) > 0:
        raise FlexureError(f"base link {base!r} has no mass, so it cannot move: take fixed_base=True, or give it an "
                           "<inertial>")  # fmt: skip
    carried = {name: _mass(link) for name, link in links.items()}
    for name in reversed(order):
        for joint in below[name]:
            child = end_of(joint, "child")
            if joint.get("type") != "fixed" and not carried[child] > 0:
                raise FlexureError(f"{title(joint)} moves nothing that has a mass: give link {child!r} an <inertial>, "
                                   "or make the joint fixed")  # fmt: skip
            carried[name] += carried[child]


def _left_out(links: dict[str, ET.Element], joints: dict[str, ET.Element]) -> list[str]:
    notes = []
    for joint in joints.values():
        dynamics = joint.find("dynamics")
        if dynamics is not None and numbers(joint, dynamics, "friction", "0", 1)[0] != 0:
            notes.append(f"{title(joint)}: friction = {dynamics.get('friction')} is not simulated; its damping is")
        if joint.find("mimic") is not None:
            notes.append(f"{title(joint)}: <mimic> is not kept, the joint moves freely")
    for link in links.values():
        for contact in link.findall("contact"):
            notes.append(f"{title(link)}: <contact> is not used; friction is an argument of FlexibleRobot")
            link.remove(contact)
    return notes
