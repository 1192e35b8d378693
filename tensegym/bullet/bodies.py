"""Bodies of a client: loaded from URDF files, with nothing of the engine's own in them, and the ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib import resources
from pathlib import Path

from tensegym.arrays import FloatArray
from tensegym.errors import SimulationError
from tensegym.physics.box import Box

from .engine import pybullet

_ROBOT_GROUP, _GROUND_GROUP = 1, 2
_BOX_COLOUR = (0.72, 0.6, 0.45, 1.0)
FIXED, REVOLUTE, PRISMATIC = range(3)  # kinds of joints


def packaged_urdf(name: str) -> Path | None:
    """Path of a URDF that ships with the package, or None."""
    path = resources.files("tensegym.urdf") / name
    return Path(str(path)) if path.is_file() else None


def load_body(client: int, urdf: Path, pose: Sequence[float], friction: float, fixed_base: bool = False) -> int:
    """The engine's number of a body from a URDF, at pose (7,) position and xyzw of the base's centre of mass.

    Its links have true inertia and Coulomb friction, its joints are free. Raises SimulationError for a file that the
    engine cannot load.
    """
    # the meshes of shapes that bodies share, which are half the time of loading, are made once
    flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
    try:
        body = pybullet.loadURDF(
            str(urdf), list(pose[:3]), list(pose[3:]), useFixedBase=fixed_base, flags=flags, physicsClientId=client
        )
    except pybullet.error as error:
        raise SimulationError(f"PyBullet cannot load {urdf.name}: {error}") from error
    count = pybullet.getNumJoints(body, physicsClientId=client)
    for link in range(-1, count):
        _make_plain(client, body, link, friction)
    moving = [i for i in range(count) if joint_kind(client, body, i) != FIXED]
    pybullet.setJointMotorControlArray(
        body, moving, pybullet.VELOCITY_CONTROL, forces=[0.0] * len(moving), physicsClientId=client
    )
    return body


def joint_kind(client: int, body: int, joint: int) -> int:
    """FIXED, REVOLUTE or PRISMATIC. Raises SimulationError, naming the joint, for another kind."""
    kinds = {pybullet.JOINT_REVOLUTE: REVOLUTE, pybullet.JOINT_PRISMATIC: PRISMATIC, pybullet.JOINT_FIXED: FIXED}
    info = pybullet.getJointInfo(body, joint, physicsClientId=client)
    if info[2] not in kinds:
        raise SimulationError(f"joint {info[1].decode()!r} is neither revolute, prismatic nor fixed")
    return kinds[info[2]]


def _make_plain(client: int, body: int, link: int, friction: float) -> None:
    """Coulomb friction and nothing else: the engine's damping, rolling friction and bounce off."""
    # one call each: on a link but the base the engine drops what stands beside a damping or a speed limit; and it
    # clamps joint speeds at 100 by default, which would hide a divergence. Contacts multiply two bodies' coefficients
    for change in ({"linearDamping": 0, "angularDamping": 0}, {"maxJointVelocity": 1e6}, {"jointDamping": 0},
                   {"lateralFriction": math.sqrt(friction), "restitution": 0, "rollingFriction": 0,
                    "spinningFriction": 0}):  # fmt: skip
        pybullet.changeDynamics(body, link, **change, physicsClientId=client)
    pybullet.setCollisionFilterGroupMask(body, link, _ROBOT_GROUP, _ROBOT_GROUP | _GROUND_GROUP, physicsClientId=client)


def make_ground(client: int, friction: float, heights: FloatArray | None = None, cell: float = 0.0) -> int:
    """The engine's number of a fixed body: the plane z = 0, or the surface of ``heights`` (n, n) [m] over x and y,
    ``cell`` [m] apart, about the origin."""
    if heights is None or not len(heights):
        shape, middle = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client), 0.0
    else:
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_HEIGHTFIELD, meshScale=[cell, cell, 1], heightfieldData=heights.T.ravel().tolist(),
            numHeightfieldRows=len(heights), numHeightfieldColumns=len(heights), physicsClientId=client,
        )  # fmt: skip
        middle = float(heights.min() + heights.max()) / 2  # which the engine takes for the shape's origin
    return _fixed(client, shape, (0, 0, middle), (0, 0, 0, 1), friction)


def make_box(client: int, box: Box, friction: float) -> int:
    """The engine's number of a fixed body."""
    shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=box.half, physicsClientId=client)
    seen = pybullet.createVisualShape(
        pybullet.GEOM_BOX, halfExtents=box.half, rgbaColor=_BOX_COLOUR, physicsClientId=client
    )
    return _fixed(client, shape, box.centre, box.turn, friction, seen)


def _fixed(
    client: int, shape: int, place: Sequence[float], turn: Sequence[float], friction: float, seen: int = -1
) -> int:
    """A body that nothing moves and that touches robots alone."""
    body = pybullet.createMultiBody(0, shape, seen, list(place), list(turn), physicsClientId=client)
    pybullet.changeDynamics(body, -1, lateralFriction=math.sqrt(friction), restitution=0, physicsClientId=client)
    pybullet.setCollisionFilterGroupMask(body, -1, _GROUND_GROUP, _ROBOT_GROUP, physicsClientId=client)
    return body
