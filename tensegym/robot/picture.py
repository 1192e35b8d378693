"""Pictures: a sight as a camera sees it, painted from far to near. No engine takes part."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tensegym.arrays import FloatArray
from tensegym.design.solids import Solid, middles

from .ground_lines import box_patches, grid_lines
from .painting import COLOUR, ITEM_SIZE, KIND, OPACITY, PATCH, POINTS, ROUND, paint
from .sight import SLACK_BELOW, Sight, tension_colours
from .surface import draped, on_ground

PIECES = 8  # of a rod or a cable: short ones are painted in the right order
_PAPER = 248.0
_GRID, _SHADOW, _BLOCK = (135, 145, 155), (150, 156, 163), (176, 184, 192)
BLUE, GREEN, ORANGE = (0, 114, 178), (0, 158, 115), (213, 94, 0)


class Camera:
    """Looks at a robot from a little above, its centre of mass in the middle; what is up is up in the picture."""

    def __init__(self, sight: Sight, width: int, height: int, yaw: float) -> None:
        side = np.cross(sight.up, [1.0, 0.0, 0.0])
        side /= np.linalg.norm(side)
        back = 0.9 * (np.cos(yaw) * np.cross(side, sight.up) + np.sin(yaw) * side) + 0.45 * sight.up
        back /= np.linalg.norm(back)
        right = np.cross(sight.up, back)
        right /= np.linalg.norm(right)
        self._axes = np.stack([right, np.cross(right, back), back])  # to the right, down, and towards the camera
        self._target = np.array([*sight.centre[:2], 0.35 * sight.length])
        if sight.ground is None or len(sight.ground.boxes):
            self._target[2] = sight.centre[2]
        self._distance = 2.9 * sight.length
        self.place = self._target + self._distance * back
        self._middle = np.array([width / 2, height / 2])
        self.focal = 1.45 * height

    def __call__(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Where points (..., 3) are in the picture (..., 2) [pixels], and how far before the camera (...) [m]."""
        local = (points - self._target) @ self._axes.T
        depth = self._distance - local[..., 2]
        return self._middle + (self.focal / np.maximum(depth, 1e-6))[..., None] * local[..., :2], depth


Order = Callable[..., FloatArray]  # np.min, np.mean or np.max


class Canvas:
    """Items for a picture: what lies on the ground, and above it what hides one another."""

    def __init__(self, camera: Camera) -> None:
        self.camera = camera
        self._below: list[FloatArray] = []
        self._above: list[tuple[FloatArray, FloatArray]] = []

    def strokes(
        self, ends: FloatArray, colours: ArrayLike, pixels: ArrayLike, *, opacity: ArrayLike = 1.0,
        radii: FloatArray | None = None, by: Order | None = np.mean,
    ) -> None:  # fmt: skip
        """Strokes between ends (k, 2, 3) [m].

        Args:
            colours: (k, 3), or one, 0 to 255.
            pixels: (k,), or one: half the width, or the least that rods of ``radii`` (k,) [m] have.
            opacity: (k,), or one, 0 to 1.
            radii: of what is round.
            by: what of their points' distances says how far away they are; None: on the ground, in the order given.
        """
        at, depth = self.camera(ends)
        half = np.broadcast_to(np.asarray(pixels, dtype=float), len(ends))[:, None]
        items = np.zeros((len(ends), ITEM_SIZE))
        items[:, COLOUR], items[:, OPACITY], items[:, ROUND] = colours, opacity, radii is not None
        if radii is not None:
            half = np.maximum(half, radii[:, None] * self.camera.focal / np.maximum(depth, 1e-6))
        points = np.concatenate([at, np.broadcast_to(half, depth.shape)[..., None]], axis=2)
        items[:, POINTS][:, :6] = points.reshape(-1, 6)
        self._keep(items, depth, by)

    def patches(self, corners: FloatArray, colours: ArrayLike, *, opacity: float = 1.0, by: Order | None) -> None:
        """Patches of four corners (k, 4, 3) [m], convex; ``by`` as of strokes."""
        at, depth = self.camera(corners)
        items = np.zeros((len(corners), ITEM_SIZE))
        items[:, KIND], items[:, COLOUR], items[:, OPACITY] = PATCH, colours, opacity
        items[:, POINTS] = at.reshape(-1, 8)
        self._keep(items, depth, by)

    def _keep(self, items: FloatArray, depth: FloatArray, by: Order | None) -> None:
        before = depth.min(axis=1, initial=np.inf) > 0.1  # of the camera
        if by is None:
            self._below.append(items[before])
        else:
            self._above.append((items[before], by(depth[before], axis=1)))

    def painted(self, width: int, height: int) -> NDArray[np.uint8]:
        """(height, width, 3) the picture."""
        image = np.full((height, width, 3), _PAPER, dtype=np.float32)
        items, depths = (np.concatenate(part) for part in zip(*self._above, strict=True))
        order = np.argsort(-depths.round(6), kind="stable")  # what is level stays as it came, whatever the last bit
        paint(image, np.concatenate([*self._below, items[order]]))
        image += 0.5
        return image.astype(np.uint8)


def picture(sight: Sight, width: int = 480, height: int = 360, yaw: float = 0.8) -> NDArray[np.uint8]:
    """(height, width, 3) picture; yaw [rad] is where the camera stands about the robot."""
    canvas, unit = Canvas(Camera(sight, width, height, yaw)), height / 360
    if sight.ground is not None:
        ends, opacity = grid_lines(sight)
        canvas.strokes(ends, _GRID, 0.45 * unit, opacity=opacity, by=None)
        lying = np.min if len(sight.ground.boxes) else None
        if sight.support is not None:
            canvas.patches(sight.support[None, [0, 1, 2, 2]], BLUE, opacity=0.15, by=lying)
        _draw_goal(canvas, sight, unit, lying)
        # by its farthest corner, so that a patch hides nothing that stands on it
        canvas.patches(*box_patches(sight, canvas.camera.place, _BLOCK), by=np.max)
    _draw_solids(canvas, sight, unit)
    half = np.where(sight.tensions > SLACK_BELOW, 1.1, 0.6)
    half[sight.driven] += 0.6 * (half[sight.driven] > 1)
    colours = np.repeat(tension_colours(sight.tensions), PIECES, axis=0)
    canvas.strokes(_cut(sight.cables), colours, np.repeat(half * unit, PIECES))
    return canvas.painted(width, height)


def _cut(ends: FloatArray) -> FloatArray:
    """(PIECES k, 2, 3) of lines between ends (k, 2, 3)."""
    shares = np.linspace(0, 1, PIECES + 1)[:, None]
    points = ends[:, None, 0] + shares * (ends[:, None, 1] - ends[:, None, 0])
    return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)


def _draw_goal(canvas: Canvas, sight: Sight, unit: float, by: Order | None) -> None:
    """Path, wanted direction and place, on the ground or on the boxes there."""
    centre, length = sight.centre[:2], sight.length
    lines = [(sight.path, GREEN)] if len(sight.path) else []
    if sight.direction is not None:
        ahead = length * sight.direction
        aside = np.array([-ahead[1], ahead[0]])
        tip = centre + 0.93 * ahead  # farther, and it leaves the picture where it comes towards the camera
        lines.append((np.stack([centre + 0.48 * ahead, tip]), BLUE))
        lines.append((np.stack([tip - 0.13 * ahead + 0.09 * aside, tip, tip - 0.13 * ahead - 0.09 * aside]), BLUE))
    if sight.place is not None:
        angles = np.linspace(0, 2 * np.pi, 33)
        lines.append((sight.place + 0.2 * length * np.column_stack([np.cos(angles), np.sin(angles)]), ORANGE))
    for points, colour in lines:
        at = draped(sight.ground, points, 0.1 * length)
        canvas.strokes(np.stack([at[:-1], at[1:]], axis=1), colour, 2.0 * unit, by=by)


def _draw_solids(canvas: Canvas, sight: Sight, unit: float) -> None:
    """Tubes with their shadows, balls, leaves."""
    at = middles(sight.solids, sight.poses)
    x, y, z, w = sight.poses[:, 3:].T
    axes = np.column_stack([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)])
    lengths = np.array([_length(solid) for solid in sight.solids])
    half = 0.5 * lengths[:, None] * axes[[solid.body for solid in sight.solids]]
    spans, colours = np.stack([at - half, at + half], axis=1), np.array([solid.colour for solid in sight.solids])
    radii, ball = np.array([solid.size[0] for solid in sight.solids]), lengths == 0
    canvas.strokes(spans[ball], 255 * colours[ball, :3], 2 * unit, opacity=colours[ball, 3], radii=radii[ball])
    if sight.ground is not None:
        shadows = on_ground(sight.ground, spans[~ball, :, :2].reshape(-1, 2)).reshape(-1, 2, 3)
        canvas.strokes(shadows, _SHADOW, 2 * unit, opacity=0.3, by=None)
    pieces = _cut(spans[~ball])
    tints = np.repeat(255 * colours[~ball, :3], PIECES, axis=0)
    canvas.strokes(pieces, tints, 1.7 * unit, radii=np.repeat(radii[~ball], PIECES))


def _length(solid: Solid) -> float:
    """Along its body's axis [m]; of a leaf, which is seen as a thin rod, too."""
    return 0.0 if solid.kind == "sphere" else solid.size[-1]
