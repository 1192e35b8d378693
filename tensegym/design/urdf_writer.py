"""URDF of a design's bodies. One link a file, two for a split rod; a rod's axis is z, the first link's centre of mass
the origin. A split rod's pin turns about y.

Numbers carry 14 digits: more than the engine's contacts can tell, and the same text on every machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .design import RobotDesign
from .parameters import Payload, Rod, RodFlexure

if TYPE_CHECKING:
    from tensegym.flexure.models.rod_pin import RodPin


def _shape(kind: str, geometry: str, z: float = 0.0, colour: str = "") -> str:
    material = f'<material name="{kind}{z:g}"><color rgba="{colour}"/></material>' if kind == "visual" else ""
    return f'    <{kind}><origin xyz="0 0 {z:.14g}"/><geometry>{geometry}</geometry>{material}</{kind}>'


def _link(name: str, mass: float, inertia: tuple[float, float, float], shapes: list[str], z: float = 0.0) -> list[str]:
    ixx, iyy, izz = inertia
    origin = f'<origin xyz="0 0 {z:.14g}"/>' if z else ""
    return [
        f'  <link name="{name}">',
        f'    <inertial>{origin}<mass value="{mass:.14g}"/>',
        f'      <inertia ixx="{ixx:.14g}" iyy="{iyy:.14g}" izz="{izz:.14g}" ixy="0" ixz="0" iyz="0"/></inertial>',
        *shapes,
        "  </link>",
    ]


def _robot(name: str, *parts: list[str]) -> str:
    lines = [line for part in parts for line in part]
    return "\n".join(['<?xml version="1.0"?>', f'<robot name="{name}">', *lines, "</robot>", ""])


def _tube(rod: Rod, length: float, middle: float, ends: tuple[float, ...], colour: str) -> list[str]:
    """A capsule about z = middle, with a foot sphere at each of ``ends`` where the feet are thicker than the tube."""
    size = f'radius="{rod.tube_outer_radius:.14g}" length="{length:.14g}"'
    shapes = [_shape("collision", f"<capsule {size}/>", middle),
              _shape("visual", f"<cylinder {size}/>", middle, colour)]  # fmt: skip
    for z in ends:
        if rod.foot_radius > rod.tube_outer_radius:
            shapes.append(_shape("collision", f'<sphere radius="{rod.foot_radius:.14g}"/>', z))
        ball = max(rod.foot_radius, rod.end_mass_radius)
        shapes.append(_shape("visual", f'<sphere radius="{ball:.14g}"/>', z, colour))
    return shapes


def rod_urdf(name: str, rod: Rod, length: float, colour: str) -> str:
    """A rod of this length [m]."""
    across = rod.transverse_inertia(length)
    shapes = _tube(rod, length, 0.0, (-length / 2, length / 2), colour)
    return _robot(name, _link(name, rod.mass, (across, across, rod.axial_inertia), shapes))


def split_rod_urdf(name: str, rod: Rod, length: float, flexure: RodFlexure, pin: RodPin, colour: str) -> str:
    """A rod of this length [m] with a flexure in the middle: two links joined at the pin, stops at +-max_angle."""
    tube = (length - flexure.length) / 2
    half = rod.half(tube)
    inertia = (half.transverse_inertia, half.transverse_inertia, half.axial_inertia)
    place = tube + pin.fraction * flexure.length  # of the pin, from the first end
    leaf = f'<box size="{flexure.thickness:.14g} {flexure.width:.14g} {flexure.length:.14g}"/>'
    first = _tube(rod, tube, tube / 2 - half.centre, (-half.centre,), colour)
    first.append(_shape("visual", leaf, length / 2 - half.centre, "0.7 0.75 0.8 1"))
    end = length - place
    joint = [
        '  <joint name="flexure" type="revolute">',
        f'    <parent link="{name}"/><child link="{name}_2"/><axis xyz="0 1 0"/>',
        f'    <origin xyz="0 0 {place - half.centre:.14g}"/>',
        f'    <limit lower="{-flexure.max_angle:.14g}" upper="{flexure.max_angle:.14g}" effort="0" velocity="0"/>',
        "  </joint>",
    ]
    return _robot(
        name,
        _link(name, half.mass, inertia, first),
        _link(f"{name}_2", half.mass, inertia, _tube(rod, tube, end - tube / 2, (end,), colour), end - half.centre),
        joint,
    )


def payload_urdf(payload: Payload) -> str:
    """A solid ball."""
    inertia = 0.4 * payload.mass * payload.radius**2
    ball = f'<sphere radius="{payload.radius:.14g}"/>'
    shapes = [_shape("collision", ball), _shape("visual", ball, colour="0.85 0.65 0.2 0.6")]
    return _robot("payload", _link("payload", payload.mass, (inertia, inertia, inertia), shapes))


def urdf_files(design: RobotDesign) -> dict[str, str]:
    """File name -> URDF text for every body that the design needs.

    Rods that differ in length get files of their own; `rod_files` says which file each rod loads.
    """
    files: dict[str, str] = {}
    for index, name in enumerate(rod_files(design)):
        colour = "0.85 0.3 0.2 1" if index in design.active_rods else "0.25 0.25 0.3 1"
        length = float(design.standing.rod_lengths[index])
        if name in files:
            continue
        link, rod = name.removesuffix(".urdf"), design.rod(index)
        if design.flexure and index in design.flexible_rods:
            files[name] = split_rod_urdf(link, rod, length, design.flexure, design.rod_pins[index], colour)
        else:
            files[name] = rod_urdf(link, rod, length, colour)
    if design.payload:
        files["payload.urdf"] = payload_urdf(design.payload)
    return files


def rod_files(design: RobotDesign) -> list[str]:
    """(r,) file name of each rod's URDF; lengths that agree to 1e-9 m share one file."""
    lengths = design.standing.rod_lengths.round(9)
    kinds = sorted(set(lengths))
    names = []
    for index, length in enumerate(lengths):
        kind = "active" if index in design.active_rods else "passive"
        suffix = "" if len(kinds) == 1 else f"_{kinds.index(length) + 1}"
        split = "_split" if index in design.flexible_rods else ""
        names.append(f"{kind}_rod{split}{suffix}.urdf")
    return names
