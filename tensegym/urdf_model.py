"""URDF of a design's bodies. One link a file; the rod's axis is the link's z, its centre the origin.

Numbers carry 14 digits: more than the engine's contacts can tell, and the same text on every machine.
"""

from __future__ import annotations

from .design import Payload, RobotDesign, Rod


def _shape(kind: str, geometry: str, z: float = 0.0, colour: str = "") -> str:
    material = f'<material name="{kind}{z:g}"><color rgba="{colour}"/></material>' if kind == "visual" else ""
    return f'    <{kind}><origin xyz="0 0 {z:.14g}"/><geometry>{geometry}</geometry>{material}</{kind}>'


def _robot(name: str, mass: float, inertia: tuple[float, float, float], shapes: list[str]) -> str:
    ixx, iyy, izz = inertia
    return "\n".join([
        '<?xml version="1.0"?>',
        f'<robot name="{name}">',
        f'  <link name="{name}">',
        f'    <inertial><mass value="{mass:.14g}"/>',
        f'      <inertia ixx="{ixx:.14g}" iyy="{iyy:.14g}" izz="{izz:.14g}" ixy="0" ixz="0" iyz="0"/></inertial>',
        *shapes,
        "  </link>",
        "</robot>",
        "",
    ])  # fmt: skip


def rod_urdf(name: str, rod: Rod, length: float, colour: str) -> str:
    """A rod of this length [m]: a capsule, with a foot sphere at each end where the feet are thicker than the tube."""
    half = length / 2
    shapes = [_shape("collision", f'<capsule radius="{rod.tube_outer_radius:.14g}" length="{length:.14g}"/>')]
    tube = f'<cylinder radius="{rod.tube_outer_radius:.14g}" length="{length:.14g}"/>'
    shapes.append(_shape("visual", tube, colour=colour))
    for z in (-half, half):
        if rod.foot_radius > rod.tube_outer_radius:
            shapes.append(_shape("collision", f'<sphere radius="{rod.foot_radius:.14g}"/>', z))
        ball = max(rod.foot_radius, rod.end_mass_radius)
        shapes.append(_shape("visual", f'<sphere radius="{ball:.14g}"/>', z, colour))
    across = rod.transverse_inertia(length)
    return _robot(name, rod.mass, (across, across, rod.axial_inertia), shapes)


def payload_urdf(payload: Payload) -> str:
    """A solid ball."""
    inertia = 0.4 * payload.mass * payload.radius**2
    ball = f'<sphere radius="{payload.radius:.14g}"/>'
    shapes = [_shape("collision", ball), _shape("visual", ball, colour="0.85 0.65 0.2 0.6")]
    return _robot("payload", payload.mass, (inertia, inertia, inertia), shapes)


def urdf_files(design: RobotDesign) -> dict[str, str]:
    """File name -> URDF text for every body that the design needs.

    Rods that differ in length get files of their own; `body_files` says which file each rod loads.
    """
    files: dict[str, str] = {}
    for index, name in enumerate(rod_files(design)):
        colour = "0.85 0.3 0.2 1" if index in design.active_rods else "0.25 0.25 0.3 1"
        length = float(design.standing.rod_lengths[index])
        files.setdefault(name, rod_urdf(name.removesuffix(".urdf"), design.rod(index), length, colour))
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
        names.append(f"{kind}_rod{suffix}.urdf")
    return names
