"""RobotScene: a robot drawn into a page, a frame at a time."""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh

from tensegym.arrays import FloatArray
from tensegym.design.solids import Solid, middles, solids
from tensegym.physics.geometry import points_at
from tensegym.physics.robot_arrays import robot_model
from tensegym.robot.sight import SLACK_BELOW, cable_ends, tension_colours
from tensegym.structure.faces import hull_faces

from .frame import Frame, Stage
from .page import Page, linear

UNIT: dict[str, Any] = {
    "cylinder": lambda: trimesh.creation.cylinder(radius=1.0, height=1.0, sections=16),
    "sphere": lambda: trimesh.creation.icosphere(subdivisions=2, radius=1.0),
    "box": lambda: trimesh.creation.box(extents=(1.0, 1.0, 1.0)),
}
"""Meshes of size 1 about z, stretched to each solid's size."""
_TUBE, _SLACK, _TAUT, _WOUND = 0.012, 0.002, 0.004, 0.006
"""Radii in rod lengths: the least a tube is drawn with, and those of cables, slack, taut and wound. True ones, of a few
millimetres, would be hairlines."""
_LIFT = 0.006  # rod lengths of what is drawn on the ground above it


class RobotScene:
    """A robot in a page.

    Few messages a frame: all tubes are one batch of meshes, and so are all balls, all leaves and all cables.

    Args:
        page: to draw into.
        stage: the robot, and what stands around it.
        name: of the frame in the page's tree that everything hangs on.
        aside: how far beside where it was it is shown, along y [m].
    """

    def __init__(self, page: Page, stage: Stage, name: str = "/world/robot", aside: float = 0.0) -> None:
        self._aside = aside
        self._model = robot_model(stage.design)
        self._faces = hull_faces(stage.design.standing).triangles
        self._solids = solids(stage.design)
        self._length = length = stage.design.length
        self.root = page.scene.add_frame(name, show_axes=False)
        self._batches = {kind: self._batch(page, f"{name}/{kind}", kind) for kind in UNIT if self._of(kind)}
        cables = self._model.first_flexure
        self._wound = np.zeros(cables, dtype=bool)
        self._wound[self._model.driven] = True
        self._cables = _batched(page, f"{name}/cables", "cylinder", np.full((cables, 3), 1e-3),
                                np.zeros((cables, 3), dtype=np.uint8))  # fmt: skip
        self._support = page.scene.add_line_segments(f"{name}/support", np.zeros((3, 2, 3)), (0, 114, 178),
                                                     thickness=0.012 * length)  # fmt: skip
        self._plumb = page.scene.add_line_segments(f"{name}/plumb", np.zeros((1, 2, 3)), (0, 0, 0),
                                                   thickness=0.004 * length)  # fmt: skip
        self._centre = page.scene.add_icosphere(f"{name}/centre", 0.02 * length, (0, 0, 0))
        self._foot = page.scene.add_icosphere(f"{name}/foot", 0.012 * length, (0, 114, 178))
        self._labels = [page.scene.add_label(f"{name}/node {n + 1}", str(n + 1), visible=False)
                        for n in range(len(self._model.node_bodies))]  # fmt: skip

    def _of(self, kind: str) -> list[int]:
        return [k for k, solid in enumerate(self._solids) if solid.kind == kind]

    def _batch(self, page: Page, name: str, kind: str) -> Any:
        of = [self._solids[k] for k in self._of(kind)]
        colours = np.array([solid.colour for solid in of])
        sides = np.array([_sides(solid, _TUBE * self._length) for solid in of])
        return _batched(page, name, kind, sides, linear(255 * colours[:, :3]), colours[:, 3])

    def draw(self, frame: Frame) -> None:
        """Show a frame.

        All parts are placed about the frame below the centre of mass: a browser moves frames at once, and takes batches
        in when it comes to it.
        """
        masses = self._model.masses
        x, y = masses @ frame.poses[:, :2] / masses.sum()
        here = np.array([x, y, 0.0])
        self.root.position = (x, y + self._aside, 0.0)
        poses = np.column_stack([frame.poses[:, :3] - here, frame.poses[:, 3:]])
        places, turns = middles(self._solids, poses), wxyz(poses[[solid.body for solid in self._solids], 3:])
        for kind, batch in self._batches.items():
            of = self._of(kind)
            batch.batched_positions, batch.batched_wxyzs = places[of], turns[of]
        self._draw_cables(cable_ends(self._model, poses), frame.tensions)
        nodes = points_at(poses, self._model.node_bodies, self._model.node_points)
        centre = masses @ poses[:, :3] / masses.sum()
        corners = nodes[self._faces[frame.face]]
        self._support.points = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
        corners[:, 2] = corners[:, 2].mean() - self._model.foot_radii.mean() + _LIFT * self._length
        foot = np.array([*centre[:2], corners[0, 2]])
        self._plumb.points = np.stack([centre, foot])[None]
        self._centre.position, self._foot.position = tuple(centre), tuple(foot)
        if self._labels[0].visible:
            for label, node in zip(self._labels, nodes, strict=True):
                label.position = tuple(node)
        self.centre = centre + here

    def _draw_cables(self, ends: FloatArray, tensions: FloatArray) -> None:
        spans = ends[:, 1] - ends[:, 0]
        lengths = np.linalg.norm(spans, axis=1)
        radii = self._length * np.where(tensions <= SLACK_BELOW, _SLACK, np.where(self._wound, _WOUND, _TAUT))
        self._cables.batched_positions = ends.mean(axis=1)
        self._cables.batched_wxyzs = _turns_of_z(spans / np.maximum(lengths, 1e-12)[:, None])
        self._cables.batched_scales = np.column_stack([radii, radii, lengths])
        self._cables.batched_colors = linear(tension_colours(tensions))

    def show_support(self, on: bool) -> None:
        """Support triangle, centre of mass and its projection."""
        for part in (self._support, self._plumb, self._centre, self._foot):
            part.visible = on

    def show_numbers(self, on: bool) -> None:
        """Numbers of the nodes."""
        for label in self._labels:
            label.visible = on

    def remove(self) -> None:
        """Take all of it out of the page."""
        self.root.remove()


def _batched(
    page: Page, name: str, kind: str, sides: FloatArray, colours: Any, opacities: FloatArray | None = None
) -> Any:
    """One message for all of a kind: unit meshes, stretched and coloured one by one."""
    mesh = UNIT[kind]()
    turns, places = np.tile([1.0, 0.0, 0.0, 0.0], (len(sides), 1)), np.zeros((len(sides), 3))
    return page.scene.add_batched_meshes_simple(
        name, mesh.vertices, mesh.faces, turns, places, batched_scales=sides, batched_colors=colours,
        batched_opacities=opacities if opacities is not None and (opacities < 1).any() else None, lod="off",
    )  # fmt: skip


def _sides(solid: Solid, least: float) -> tuple[float, float, float]:
    """What the unit mesh of a solid is stretched by [m]; ``least`` is the least radius of tubes and balls."""
    if solid.kind == "box":
        width, depth, height = solid.size
        return width, depth, height
    radius = max(solid.size[0], least)
    return radius, radius, solid.size[1] if solid.kind == "cylinder" else radius


def wxyz(turns: FloatArray) -> FloatArray:
    """Quaternions xyzw (k, 4) as viser has them."""
    return turns[:, [3, 0, 1, 2]]


def _turns_of_z(directions: FloatArray) -> FloatArray:
    """(k, 4) the shortest rotations, wxyz, of the z axis onto unit vectors (k, 3)."""
    x, y, z = directions.T
    turns = np.column_stack([1 + z, -y, x, np.zeros(len(z))])
    turns[z < -1 + 1e-9] = [0.0, 1.0, 0.0, 0.0]
    return np.asarray(turns / np.linalg.norm(turns, axis=1)[:, None])
