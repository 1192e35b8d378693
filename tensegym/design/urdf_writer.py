"""URDF of a design's bodies. One link a file, two for a split rod; the first link's centre of mass is the origin.

Numbers carry 14 digits: more than the engine's contacts can tell, and the same text on every machine.
"""

from __future__ import annotations

from .bodies import Body, Link, Shape, design_bodies
from .design import RobotDesign

_SIZES = {"capsule": ("radius", "length"), "cylinder": ("radius", "length"), "sphere": ("radius",)}


def _shape(shape: Shape) -> str:
    if shape.kind == "box":
        size = 'size="{:.14g} {:.14g} {:.14g}"'.format(*shape.size)
    else:
        size = " ".join(f'{name}="{value:.14g}"' for name, value in zip(_SIZES[shape.kind], shape.size, strict=True))
    kind, z, colour = "visual" if shape.colour else "collision", shape.z, shape.colour
    material = f'<material name="{kind}{z:g}"><color rgba="{colour}"/></material>' if colour else ""
    return f'    <{kind}><origin xyz="0 0 {z:.14g}"/><geometry><{shape.kind} {size}/></geometry>{material}</{kind}>'


def _link(link: Link) -> list[str]:
    ixx, iyy, izz = link.inertia
    origin = f'<origin xyz="0 0 {link.centre:.14g}"/>' if link.centre else ""
    return [
        f'  <link name="{link.name}">',
        f'    <inertial>{origin}<mass value="{link.mass:.14g}"/>',
        f'      <inertia ixx="{ixx:.14g}" iyy="{iyy:.14g}" izz="{izz:.14g}" ixy="0" ixz="0" iyz="0"/></inertial>',
        *map(_shape, link.shapes),
        "  </link>",
    ]


def body_urdf(body: Body) -> str:
    """A body as a file's text."""
    lines = _link(body.link)
    if body.pin and body.second:
        limit = body.pin.limit
        lines += _link(body.second)
        lines += [
            '  <joint name="flexure" type="revolute">',
            f'    <parent link="{body.link.name}"/><child link="{body.second.name}"/><axis xyz="0 1 0"/>',
            f'    <origin xyz="0 0 {body.pin.z:.14g}"/>',
            f'    <limit lower="{-limit:.14g}" upper="{limit:.14g}" effort="0" velocity="0"/>',
            "  </joint>",
        ]
    return "\n".join(['<?xml version="1.0"?>', f'<robot name="{body.name}">', *lines, "</robot>", ""])


def urdf_files(design: RobotDesign) -> dict[str, str]:
    """File name -> URDF text for every body that the design needs; bodies of one name share a file."""
    return {f"{body.name}.urdf": body_urdf(body) for body in design_bodies(design)}
