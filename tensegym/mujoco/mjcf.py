"""MJCF of a scene: its bodies, free, with their masses, inertias and shapes that touch, and the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.design.bodies import Body, Link, Shape
from tensegym.engine import Scene
from tensegym.physics.box import Box
from tensegym.physics.terrain import Ground

# A contact gives way as a critically damped spring with this time constant [s], the least that MuJoCo takes at 2 ms (it
# takes two time steps where that is more); a cone and not a pyramid of friction forces, ten times as stiff as the
# normal ones, so that feet at rest hardly creep
CONTACT_TIME, FRICTION_RATIO = 0.004, 10
BASE = 1.0  # m; how far the ground of a height field reaches below its lowest point


def scene_mjcf(scene: Scene) -> str:
    """What `MujocoWorld` loads: the integrator whose step the leapfrog is made of, no automatic resets."""
    names = [f"body_{row}" if any(row in pair for pair in scene.joined) else "" for row in range(len(scene.bodies))]
    bodies = [body_mjcf(*each) for each in zip(scene.bodies, scene.poses, names, strict=True)]
    apart = [f'    <exclude body1="{names[a]}" body2="{names[b]}"/>' for a, b in scene.joined]
    asset, ground = ground_mjcf(scene.ground)
    ground += [_box(box) for box in scene.boxes]
    option = option_mjcf(scene.dt, scene.gravity, "Euler", '<flag autoreset="disable"/>')
    rest = ["  <contact>", *apart, "  </contact>"] if apart else []
    return mjcf("scene", option, scene.friction, asset, [*ground, *bodies], rest)


def option_mjcf(dt: float, gravity: float, integrator: str, flags: str = "") -> str:
    """Time step [s], gravity straight down [m/s^2], MuJoCo's name of an integrator; how contacts are solved."""
    return (f'<option timestep="{dt:.17g}" gravity="0 0 {-gravity:.17g}" integrator="{integrator}" cone="elliptic" '
            f'impratio="{FRICTION_RATIO}">{flags}</option>')  # fmt: skip


def mjcf(name: str, option: str, friction: float, asset: list[str], parts: list[str], rest: Sequence[str] = ()) -> str:
    """A file's text: ``parts`` of the world, and what follows it."""
    time = f"{CONTACT_TIME:g} 1"
    return "\n".join([
        f'<mujoco model="{name}">',
        '  <compiler angle="radian" inertiafromgeom="false"/>',
        f"  {option}",
        f'  <default><geom condim="3" friction="{friction:.17g} 0 0" solref="{time}"/>'
        f'<joint solreflimit="{time}"/></default>',
        *(f"  <asset>{line}</asset>" for line in asset),
        "  <worldbody>", *parts, "  </worldbody>", *rest, "</mujoco>", "",
    ])  # fmt: skip


def ground_mjcf(ground: Ground | None) -> tuple[list[str], list[str]]:
    """Assets and geoms of the ground; the heights of a field are put into the model when it is loaded."""
    if ground is None:
        return [], []
    if not ground.rough:
        return [], ['    <geom name="ground" type="plane" size="0 0 1"/>']
    count, low, high = len(ground.heights), ground.heights.min(), ground.heights.max()
    half = 0.5 * (count - 1) * ground.cell
    size = f"{half:.17g} {half:.17g} {max(high - low, 1e-6):.17g} {BASE:g}"
    return ([f'<hfield name="ground" nrow="{count}" ncol="{count}" size="{size}"/>'],
            [f'    <geom name="ground" type="hfield" hfield="ground" pos="0 0 {low:.17g}"/>'])  # fmt: skip


def _box(box: Box) -> str:
    turn = text(np.roll(box.turn, 1))
    return f'    <geom type="box" size="{text(box.half)}" pos="{text(box.centre)}" quat="{turn}"/>'


def body_mjcf(
    body: Body, pose: FloatArray, name: str = "", sites: Sequence[str] = ("", ""), pin: str = "", seen: bool = False
) -> str:
    """A free body at a pose (7,) of its first link's centre, position and xyzw.

    Args:
        name: in place of the body's own, which equal bodies share; without one it has none.
        sites: more elements of its first and of its second link.
        pin: more attributes of the joint between them.
        seen: also the shapes that do not touch anything.
    """
    inside = [_link(body.link, seen), sites[0]]
    if body.pin and body.second:
        limit = body.pin.limit
        inside += [
            f'      <body pos="0 0 {body.pin.z:.17g}"{_named(name, "_2")}>',
            f'      <joint type="hinge" axis="0 1 0" range="{-limit:.17g} {limit:.17g}"{_named(name, "_pin")}{pin}/>',
            _link(body.second, seen), sites[1], "      </body>",
        ]  # fmt: skip
    place, turn = text(pose[:3]), text(np.roll(pose[3:], 1))
    lines = [f'    <body pos="{place}" quat="{turn}"{_named(name)}>', "      <freejoint/>", *inside, "    </body>"]
    return "\n".join(filter(None, lines))


def _named(name: str, suffix: str = "") -> str:
    return f' name="{name}{suffix}"' if name else ""


def _link(link: Link, seen: bool) -> str:
    inertial = (f'      <inertial pos="0 0 {link.centre:.17g}" mass="{link.mass:.17g}" '
                f'diaginertia="{text(link.inertia)}"/>')  # fmt: skip
    return "\n".join([inertial, *(_geom(shape) for shape in link.shapes if seen or not shape.colour)])


def _geom(shape: Shape) -> str:
    sizes = [size / 2 for size in shape.size]
    if shape.kind != "box":
        sizes[0] = shape.size[0]  # a radius; all else is halved
    look = f' contype="0" conaffinity="0" group="1" rgba="{shape.colour}"' if shape.colour else ' group="3"'
    return f'      <geom type="{shape.kind}" size="{text(sizes)}" pos="0 0 {shape.z:.17g}"{look}/>'


def text(values: Sequence[float] | FloatArray) -> str:
    """Numbers as they stand in an attribute."""
    return " ".join(f"{value:.17g}" for value in values)
