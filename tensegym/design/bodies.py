"""Bodies: what a design is made of, as engines and files take it. A rod's axis is z, its pin, if it is split, turns
about y."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from .design import RobotDesign
from .groups import group_names
from .parameters import Payload, Rod, RodFlexure

if TYPE_CHECKING:
    from tensegym.flexure.models.rod_pin import RodPin

Kind = Literal["capsule", "sphere", "cylinder", "box"]


class Shape(NamedTuple):
    """A shape about its link's z axis."""

    kind: Kind
    size: tuple[float, ...]
    """[m] of a capsule or cylinder the radius and the length without the caps, of a sphere the radius, of a box the
    sides."""
    z: float = 0.0
    """Of its middle [m]."""
    colour: str = ""
    """Red, green, blue and opacity of a shape that is only seen; empty where it is one that touches."""


class Link(NamedTuple):
    """A rigid part, symmetric about its z axis."""

    name: str
    mass: float
    """[kg]."""
    inertia: tuple[float, float, float]
    """Principal moments about the centre of mass [kg m^2]."""
    shapes: tuple[Shape, ...]
    centre: float = 0.0
    """z of the centre of mass [m]; 0 in a body's first link."""


class Pin(NamedTuple):
    """Joins the second link of a body to the first, turning about y; the second link's origin is on it."""

    z: float
    """In the first link [m]."""
    limit: float
    """It turns this far to either side [rad]."""


class Body(NamedTuple):
    """A link, or two that a pin joins. Bodies of one name are equal."""

    name: str
    link: Link
    pin: Pin | None = None
    second: Link | None = None


def design_bodies(design: RobotDesign) -> tuple[Body, ...]:
    """The rods in their order, then the payload, each at the origin. Rods whose lengths agree to 1e-9 m are equal."""
    made: dict[str, Body] = {}
    names = _rod_names(design)
    for index, name in enumerate(names):
        if name in made:
            continue
        colour = "0.85 0.3 0.2 1" if index in design.active_rods else "0.25 0.25 0.3 1"
        length, rod = float(design.standing.rod_lengths[index]), design.rod(index)
        if design.flexure and index in design.flexible_rods:
            made[name] = _split_rod(name, rod, length, design.flexure, design.rod_pins[index], colour)
        else:
            made[name] = _rod(name, rod, length, colour)
    bodies = [made[name] for name in names]
    return tuple([*bodies, _payload(design.payload)] if design.payload else bodies)


def _rod_names(design: RobotDesign) -> list[str]:
    """(r,) one name for all rods that are equal."""
    lengths = design.standing.rod_lengths.round(9)
    kinds = sorted(set(lengths))
    groups = group_names(design.rods, design.structure.rods)
    names = []
    for index, (length, group) in enumerate(zip(lengths, groups, strict=True)):
        kind = "active" if index in design.active_rods else "passive"
        suffix = "" if len(kinds) == 1 else f"_{kinds.index(length) + 1}"
        split = "_split" if index in design.flexible_rods else ""
        names.append(f"{kind}_rod{split}{'_' * bool(group)}{group}{suffix}")
    return names


def _tube(rod: Rod, length: float, middle: float, ends: tuple[float, ...], colour: str) -> tuple[Shape, ...]:
    """A capsule about z = middle, with a foot sphere at each of ``ends`` where the feet are thicker than the tube."""
    size = rod.tube_outer_radius, length
    shapes = [Shape("capsule", size, middle), Shape("cylinder", size, middle, colour)]
    for z in ends:
        if rod.foot_radius > rod.tube_outer_radius:
            shapes.append(Shape("sphere", (rod.foot_radius,), z))
        shapes.append(Shape("sphere", (max(rod.foot_radius, rod.end_mass_radius),), z, colour))
    return tuple(shapes)


def _rod(name: str, rod: Rod, length: float, colour: str) -> Body:
    across = rod.transverse_inertia(length)
    shapes = _tube(rod, length, 0.0, (-length / 2, length / 2), colour)
    return Body(name, Link(name, rod.mass, (across, across, rod.axial_inertia), shapes))


def _split_rod(name: str, rod: Rod, length: float, flexure: RodFlexure, pin: RodPin, colour: str) -> Body:
    """A rod with a flexure in the middle: two links joined at the pin, stops at +-max_angle."""
    tube = (length - flexure.length) / 2
    half = rod.half(tube)
    inertia = (half.transverse_inertia, half.transverse_inertia, half.axial_inertia)
    place = tube + pin.fraction * flexure.length  # of the pin, from the first end
    leaf = flexure.thickness, flexure.width, flexure.length
    first = _tube(rod, tube, tube / 2 - half.centre, (-half.centre,), colour)
    first += (Shape("box", leaf, length / 2 - half.centre, "0.7 0.75 0.8 1"),)
    end = length - place
    second = _tube(rod, tube, end - tube / 2, (end,), colour)
    return Body(
        name,
        Link(name, half.mass, inertia, first),
        Pin(place - half.centre, flexure.max_angle),
        Link(f"{name}_2", half.mass, inertia, second, end - half.centre),
    )


def _payload(payload: Payload) -> Body:
    """A solid ball."""
    inertia = 0.4 * payload.mass * payload.radius**2
    ball = (payload.radius,)
    shapes = (Shape("sphere", ball), Shape("sphere", ball, colour="0.85 0.65 0.2 0.6"))
    return Body("payload", Link("payload", payload.mass, (inertia, inertia, inertia), shapes))
