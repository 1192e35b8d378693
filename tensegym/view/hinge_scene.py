"""HingeScene: a hinge as the finite elements bend it, and where each fitted model has its tip."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from tensegym.arrays import FloatArray, IntArray
from tensegym.flexure.fem.mesh import mesh_of
from tensegym.flexure.hinge import GROUND, Hinge
from tensegym.flexure.models.load_solver import Answer
from tensegym.plotting import COLOURS

from .page import Page
from .surroundings import light

_BAR, _LEVER = 0.25, 0.35  # parts of L: half the bar across a tip, and what reaches on from it
_LEAF = (120, 130, 145)


class HingeScene:
    """A hinge in a page, L as one unit; x along the hinge, y across, z out of its plane.

    Args:
        page: to draw into.
        hinge: what is bent.
        elements: of a leaf as long as the hinge, as the solutions to be drawn have.
        models: names of the models, in the order of their colours; the first is the finite elements'.
    """

    def __init__(self, page: Page, hinge: Hinge, elements: int, models: tuple[str, ...]) -> None:
        self._scale, self._hinge = 1 / hinge.length, hinge
        self._ends = mesh_of(hinge, elements).ends
        self._leaves = [
            page.scene.add_mesh_simple(f"/leaf {n + 1}", np.zeros((2 * (count + 1), 3)), _strip(count + 1), color=_LEAF,
                                       side="double", flat_shading=False)
            for n, count in enumerate(self._ends[:, 2].tolist())
        ]  # fmt: skip
        light(page)
        joints = max(1, len(self._body_lines(np.zeros((int(self._ends[-1, 2:].sum()) + 1, 3)))))
        self._bodies = page.scene.add_line_segments("/bodies", np.zeros((joints, 2, 3)), (60, 60, 66), thickness=0.03)
        self._tips = {
            name: page.scene.add_line_segments(f"/tip {name}", np.zeros((2, 2, 3)), rgb(n), thickness=0.016)
            for n, name in enumerate(models)
        }  # fmt: skip
        page.scene.add_grid("/plane", width=4, height=4, cell_size=0.1, section_size=1.0, cell_color=(225, 225, 225),
                            section_color=(190, 190, 190), position=(0.5, 0.0, -0.5 * self._width(0)))  # fmt: skip
        page.initial_camera.position = (0.65, -0.5, 1.75)
        page.initial_camera.look_at = (0.65, 0.1, 0.0)

    def _width(self, leaf: int) -> float:
        return self._hinge.leaves[leaf].width * self._scale

    def draw_leaves(self, nodes: FloatArray) -> None:
        """Show a shape: nodes (k, 3) of the leaves, one after another, as a Solution has them."""
        for n, (leaf, (_, _, count, first)) in enumerate(zip(self._leaves, self._ends.tolist(), strict=True)):
            line = self._scale * nodes[first : first + count + 1, :2]
            z = np.full(len(line), 0.5 * self._width(n))
            leaf.vertices = np.concatenate([np.column_stack([line, z]), np.column_stack([line, -z])])
        lines = self._body_lines(nodes)
        if lines:
            self._bodies.points = np.array(lines)

    def _body_lines(self, nodes: FloatArray) -> list[FloatArray]:
        """Lines (2, 3) between the ends of leaves on one body."""
        points: dict[str, list[FloatArray]] = {}
        for leaf, (_, _, count, first) in zip(self._hinge.leaves, self._ends.tolist(), strict=True):
            points.setdefault(leaf.start_body, []).append(nodes[first, :2])
            points.setdefault(leaf.end_body, []).append(nodes[first + count, :2])
        return [np.array([[*(self._scale * a), 0.0], [*(self._scale * b), 0.0]])
                for body, ends in points.items() if body != GROUND for a, b in pairwise(ends)]  # fmt: skip

    def draw_tips(self, answers: Mapping[str, Answer]) -> None:
        """Show where each model has the tip; one without an answer is hidden."""
        for level, (name, answer) in enumerate(answers.items()):
            tip = self._tips[name]
            tip.visible = not answer.reason
            if answer.reason:
                continue
            at, z = self._scale * np.array([answer.x, answer.y]), 0.5 * self._width(0) + 0.02 * level
            along = np.array([np.cos(answer.theta), np.sin(answer.theta)])
            across = np.array([-along[1], along[0]])
            ends = [(at - _BAR * across, at + _BAR * across), (at, at + _LEVER * along)]
            tip.points = np.array([[[*a, z], [*b, z]] for a, b in ends])


def rgb(number: int) -> tuple[int, int, int]:
    """Colour of a model: black for the first, the finite elements, then those of the figures."""
    text = ("#000000", *COLOURS)[number % (1 + len(COLOURS))]
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


def _strip(count: int) -> IntArray:
    """Triangles between two rows of ``count`` points."""
    a = np.arange(count - 1)
    b = a + count
    return np.concatenate([np.stack([a, b, a + 1], axis=1), np.stack([a + 1, b, b + 1], axis=1)])
