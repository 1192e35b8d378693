"""Tree: the links of a loaded body as flat arrays, for the equations of motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray
from tensegym.bullet import FIXED, Articulated


class Tree(NamedTuple):
    """Row 0 is the base, row i + 1 the engine's link i. A named tuple, as compiled functions take one."""

    parent: IntArray
    """(l,) row of the parent; -1 for the base."""
    kind: IntArray
    """(l,) FIXED, REVOLUTE or PRISMATIC joint to the parent."""
    joint: IntArray
    """(l,) column among the moving joints; 0 where fixed."""
    offset: FloatArray
    """(l, 3) origin in the parent's frame with the joint at zero [m]; the base: in its own principal frame."""
    turn: FloatArray
    """(l, 3, 3) axes in the parent's frame with the joint at zero."""
    axis: FloatArray
    """(l, 3) unit joint axis in the link's frame."""
    mass: FloatArray
    """(l,) [kg]; zero for the links between a flexure's joints."""
    centre: FloatArray
    """(l, 3) centre of mass in the link's frame [m]."""
    inertia: FloatArray
    """(l, 3, 3) about the centre, link's axes [kg m^2]."""
    first: int
    """Column of the first joint: 6 on a floating base, 0 on a fixed one."""


def read_tree(body: Articulated, fixed_base: bool) -> Tree:
    """Tree of a body just loaded with every joint at zero."""
    inertias, infos = body.inertias(), body.joint_info
    size = len(inertias)
    centre = np.array([row[2] for row in inertias], dtype=float)
    own = [Rotation.from_quat(row[3]) for row in inertias]
    inertia = np.array([(r.as_matrix() * row[1]) @ r.as_matrix().T for r, row in zip(own, inertias, strict=True)])
    pose, twist = np.empty(7), np.empty(6)
    body.read_base(pose, twist)
    turned = [Rotation.from_quat(pose[3:]) * own[0].inv()]
    origins = [pose[:3] - turned[0].apply(centre[0])]
    for position, quaternion in body.link_frames():
        origins.append(np.array(position))
        turned.append(Rotation.from_quat(quaternion))
    parent = np.array([-1] + [info[16] + 1 for info in infos], dtype=np.int64)
    offset, turn = np.empty((size, 3)), np.empty((size, 3, 3))
    offset[0], turn[0] = own[0].inv().apply(-centre[0]), own[0].inv().as_matrix()
    for i in range(1, size):
        up = parent[i]
        offset[i] = turned[up].inv().apply(origins[i] - origins[up])
        turn[i] = (turned[up].inv() * turned[i]).as_matrix()
    columns = {link: column for column, link in enumerate(body.moving)}
    mass = np.array([row[0] for row in inertias], dtype=float)
    return Tree(
        parent, np.array([FIXED, *body.kinds], dtype=np.int64),
        np.array([0] + [columns.get(i, 0) for i in range(size - 1)], dtype=np.int64), offset, turn,
        np.array([[0.0, 0.0, 1.0]] + [info[13] for info in infos], dtype=float), mass, centre, inertia,
        0 if fixed_base else 6,
    )  # fmt: skip
