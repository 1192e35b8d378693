"""Faces: the hull triangles a structure can stand on, and the geometry of tipping from one to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray, IntArray
from tensegym.compiled import kernel
from tensegym.errors import StructureError

from .structure import Structure

LEVEL = 1e-5  # of the hull's size, and of the cosine between normals: triangles no farther apart are one face


@dataclass(frozen=True)
class Faces:
    """Hull triangles, ordered by their node numbers.

    triangles (f, 3): node indices, smallest first, counter-clockwise seen from outside. normals (f, 3): unit, outward.
    neighbours (f, 3): the face across the edge from node i to node i + 1. closed (f,): all three edges are cables.
    planes (f,): the first of the triangles that make one level face with this one, as the halves of a square do.
    """

    triangles: IntArray
    normals: FloatArray
    neighbours: IntArray
    closed: np.ndarray
    planes: IntArray

    def names(self) -> list[str]:
        """Node numbers from 1, as in 3-5-12, ascending."""
        return ["-".join(str(n + 1) for n in sorted(t)) for t in self.triangles.tolist()]


def hull_faces(structure: Structure) -> Faces:
    """Hull triangles of a structure. Raises StructureError when its nodes span no volume."""
    nodes = structure.nodes
    try:
        hull = ConvexHull(nodes)
    except Exception as error:  # qhull's own error type is not public
        raise StructureError("the nodes span no volume, so there is no face to stand on") from error
    a, b, c = hull.simplices.T
    inward = (np.cross(nodes[b] - nodes[a], nodes[c] - nodes[a]) * hull.equations[:, :3]).sum(axis=1) < 0
    rows = np.where(inward[:, None], hull.simplices[:, [0, 2, 1]], hull.simplices).tolist()
    triangles = []
    for row in rows:
        first = row.index(min(row))
        triangles.append((*row[first:], *row[:first]))
    triangles.sort(key=lambda t: (sorted(t), t))
    array = np.array(triangles)
    normals = np.cross(nodes[array[:, 1]] - nodes[array[:, 0]], nodes[array[:, 2]] - nodes[array[:, 0]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    across = {(t[i], t[(i + 1) % 3]): f for f, t in enumerate(triangles) for i in range(3)}
    neighbours = [[across[t[(i + 1) % 3], t[i]] for i in range(3)] for t in triangles]
    cables = {frozenset(c) for c in structure.cables.tolist()}
    closed = [all(frozenset((t[i], t[(i + 1) % 3])) in cables for i in range(3)) for t in triangles]
    return Faces(array, normals, np.array(neighbours), np.array(closed), _planes(normals, nodes[array[:, 0]]))


def _planes(normals: FloatArray, corners: FloatArray) -> IntArray:
    """(f,) the first face with the same normal, and as far out, as each."""
    out, size = (normals * corners).sum(axis=1), np.linalg.norm(np.ptp(corners, axis=0))
    same = (normals @ normals.T > 1 - LEVEL) & (np.abs(out[:, None] - out) < LEVEL * size)
    return np.asarray(same.argmax(axis=1))


def face_by_nodes(faces: Faces, name: str) -> int:
    """Index of a face by the numbers of its nodes.

    Args:
        faces: those of a structure.
        name: node numbers from 1 in any order, as in 3-5-12.

    Raises:
        StructureError: no face has these nodes; it lists those there are.
    """
    names = faces.names()
    try:
        key = "-".join(str(n) for n in sorted(int(part) for part in name.split("-")))
        return names.index(key)
    except ValueError:
        raise StructureError(f"no face {name!r}; the faces are {', '.join(names)}") from None


def resting_rotation(nodes: FloatArray, triangle: IntArray, heading: float = 0.0) -> FloatArray:
    """Rotation that lays a hull triangle flat, outward side down.

    Args:
        nodes: (n, 3) positions in the structure's axes [m].
        triangle: (3,) node indices, counter-clockwise seen from outside.
        heading: from x to the line from the face's middle to its first node, about z [rad].

    Returns:
        (3, 3) from the structure's axes to the world's.
    """
    a, b, c = nodes[triangle]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    forward = a - (a + b + c) / 3
    forward /= np.linalg.norm(forward)
    flat = np.stack([forward, np.cross(-normal, forward), -normal])
    return Rotation.from_euler("z", heading).as_matrix() @ flat


@dataclass(frozen=True)
class TipGeometry:
    """Rigid tipping over the edge shared by two faces."""

    angle: float
    """Between the two faces' normals [rad]."""
    barrier: float
    """Rise of the centre of mass above where it rests on the first face [m]."""
    travel: float
    """Horizontal distance between the centre of mass resting on one face and on the other [m]."""


def resting_height(nodes: FloatArray, triangle: IntArray, centre: FloatArray) -> float:
    """Height of a point above the plane of a hull triangle.

    Args:
        nodes: (n, 3) positions [m].
        triangle: (3,) node indices, counter-clockwise seen from outside.
        centre: (3,) the point, in the nodes' axes [m].

    Returns:
        [m], positive inside the hull.
    """
    a, b, c = nodes[triangle]
    normal = np.cross(b - a, c - a)
    return float((a - centre) @ normal / np.linalg.norm(normal))


def tip_geometry(faces: Faces, nodes: FloatArray, centre: FloatArray, face: int, neighbour: int) -> TipGeometry:
    """Tip a rigid body from one face onto another about their common edge.

    Args:
        faces: those of the structure.
        nodes: (n, 3) positions [m].
        centre: (3,) centre of mass, in the nodes' axes [m].
        face, neighbour: indices of the two faces.

    Raises:
        StructureError: the faces share no edge.
    """
    shared = [n for n in faces.triangles[face].tolist() if n in faces.triangles[neighbour].tolist()]
    if len(shared) != 2:
        raise StructureError(f"faces {face} and {neighbour} share no edge")
    p, q = nodes[shared]
    edge = (q - p) / np.linalg.norm(q - p)
    arm = (centre - p) - ((centre - p) @ edge) * edge
    angle = float(np.arccos(np.clip(faces.normals[face] @ faces.normals[neighbour], -1, 1)))
    heights = [resting_height(nodes, faces.triangles[f], centre) for f in (face, neighbour)]
    radius = float(np.linalg.norm(arm))
    travel = sum(np.sqrt(max(radius**2 - h**2, 0.0)) for h in heights)
    return TipGeometry(angle, radius - heights[0], float(travel))


def supporting_face(faces: Faces, nodes: FloatArray, centre: FloatArray) -> int:
    """The hull triangle that the line down from the centre of mass leaves the body through.

    Args:
        faces: of the structure at rest.
        nodes: (n, 3) positions in the world, as deformed now [m].
        centre: (3,) centre of mass in the world [m].

    Returns:
        Its index; the lowest where the line meets several or, on a body bent out of shape, none.
    """
    return _face_under(faces.triangles, nodes, centre)


@kernel
def _face_under(triangles, nodes, centre):
    best, lowest = 0, np.inf
    for t in range(len(triangles)):
        above, below, height = True, True, 0.0
        for i in range(3):
            a, b = nodes[triangles[t, i]], nodes[triangles[t, (i + 1) % 3]]
            cross = (a[0] - centre[0]) * (b[1] - centre[1]) - (b[0] - centre[0]) * (a[1] - centre[1])
            above, below = above and cross >= 0, below and cross <= 0
            height += a[2] / 3
        if not (above or below):
            height += 1e3
        if height < lowest:
            best, lowest = t, height
    return best
