"""DarkShapes: a grey picture made two-coloured, as on the paper's stand, and cut into its connected dark shapes.

Pictures are arrays (rows, columns) of grey levels, any scale; pixel (row, column) has its centre at those numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from tensegym.arrays import FloatArray, IntArray
from tensegym.errors import FlexureError

LEAST_CONTRAST = 0.2
"""Paint must swallow this share of the light at least; a grey wall in soft shade swallows less."""

_GROUND_DEGREE = 3  # a cubic follows a lamp at one side and the fall of light toward the corners
_GROUND_SAMPLES = 40_000  # more pixels than that add time and no accuracy to ten coefficients
_RIM_PX = 2  # how far blur carries a shape's darkness beyond its outline
_SMOOTHING_PX = 0.8  # for cutting out only: measurements use the unsmoothed picture


@dataclass(frozen=True)
class Shape:
    """One connected dark shape."""

    label: int
    """Its number in ``DarkShapes.labels``."""
    area: int
    """px"""
    centre: FloatArray
    """(2,) row, column [px]"""
    axis: FloatArray
    """(2,) unit vector of the long axis, row and column, sign arbitrary"""
    long: float
    """Length of the rectangle with the same second moments [px]"""
    short: float
    """Width of that rectangle [px]"""
    cut: bool
    """Whether the shape reaches the picture's edge."""


@dataclass(frozen=True)
class DarkShapes:
    """Dark shapes of one picture, largest first."""

    darkness: FloatArray
    """(rows, columns) share of the light swallowed, 0 on the ground; uneven light is divided out."""
    labels: NDArray[np.int32]
    """(rows, columns) number of the shape a pixel belongs to, 0 for the ground."""
    shapes: tuple[Shape, ...]


def darkness(grey: FloatArray) -> FloatArray:
    """Share of the light each pixel swallows, 0 on the ground, (rows, columns).

    The light ground is a cubic surface fitted to the pixels, those much darker than the surface left out in turn: a
    picture divided by it has the same ground level everywhere, so one threshold serves all of it.

    Raises FlexureError where the ground comes out black.
    """
    rows, columns = grey.shape
    v, u = np.linspace(-1, 1, rows), np.linspace(-1, 1, columns)
    powers = [(i, j) for i in range(_GROUND_DEGREE + 1) for j in range(_GROUND_DEGREE + 1 - i)]
    step = max(1, int(np.sqrt(grey.size / _GROUND_SAMPLES)))
    basis = np.stack([np.outer(v[::step] ** i, u[::step] ** j).ravel() for i, j in powers], axis=1)
    level = grey[::step, ::step].ravel()
    light = np.ones(level.size, dtype=bool)
    for _ in range(12):
        coefficients = np.linalg.lstsq(basis[light], level[light], rcond=None)[0]
        above = level - basis @ coefficients
        spread = 1.4826 * np.median(np.abs(above[light] - np.median(above[light])))
        fresh = above > -2.5 * max(spread, 1e-3 * float(np.ptp(level)))
        if np.array_equal(fresh, light) or fresh.sum() < 0.3 * fresh.size:
            break
        light = fresh
    surface = np.zeros((_GROUND_DEGREE + 1, _GROUND_DEGREE + 1))
    surface[tuple(zip(*powers, strict=True))] = coefficients
    ground = np.polynomial.polynomial.polygrid2d(v, u, surface)
    if not ground.min() > 0.0:
        raise FlexureError("the ground is black in places; the stand needs a light ground")
    return 1.0 - grey / ground


def threshold(dark: FloatArray) -> float:
    """Darkness half way between ground (0) and paint, found by repeated means (Ridler and Calvard, 1978).

    ``dark`` (rows, columns). Raises FlexureError if nothing is dark enough to be paint.
    """
    noise = 1.4826 * float(np.median(np.abs(dark - np.median(dark))))
    least = max(LEAST_CONTRAST, 6.0 * noise)
    paint = float(dark.max())
    # Starting from the darkest pixel rather than from the mean keeps a grey shadow out of the paint.
    for _ in range(20):
        inside = dark[dark > paint / 2.0]
        fresh = float(np.median(inside))
        if fresh == paint:
            break
        paint = fresh
    if paint < least:
        raise FlexureError("nothing dark on a light ground: no arm and no marker")
    return paint / 2.0


def find_dark_shapes(grey: FloatArray, least_area: int = 12) -> DarkShapes:
    """Binarise a picture (rows, columns) and measure its dark shapes of at least ``least_area`` px, largest first.

    Raises FlexureError for a picture without contrast.
    """
    if grey.ndim != 2 or min(grey.shape) < 32:
        raise FlexureError(f"a picture of {' x '.join(map(str, grey.shape))} px is too small; 32 x 32 is the least")
    if not np.ptp(grey) > 0.0:
        raise FlexureError("nothing dark on a light ground: no arm and no marker")
    dark = darkness(grey)
    smooth = ndimage.gaussian_filter(dark, _SMOOTHING_PX)
    labels, count = ndimage.label(smooth > threshold(smooth), structure=np.ones((3, 3)))
    areas = np.bincount(labels.ravel(), minlength=count + 1)
    boxes = ndimage.find_objects(labels)
    order = [k for k in np.argsort(-areas[1:], kind="stable") + 1 if areas[k] >= least_area]
    return DarkShapes(dark, labels.astype(np.int32), tuple(_measure(labels, int(k), boxes[k - 1]) for k in order))


def alone(dark: DarkShapes, shape: Shape, margin: int) -> tuple[FloatArray, IntArray]:
    """Darkness around one shape, ``margin`` px wider than it, and the (2,) row, column of that window's corner.

    Other shapes and their grey rims are painted over with ground, so that they cannot pull a measurement.
    """
    rows, columns = np.nonzero(dark.labels == shape.label)
    corner = np.maximum([rows.min() - margin, columns.min() - margin], 0)
    window = (slice(corner[0], rows.max() + margin + 1), slice(corner[1], columns.max() + margin + 1))
    labels = dark.labels[window]
    others = ndimage.binary_dilation((labels > 0) & (labels != shape.label), iterations=_RIM_PX)
    return np.where(others, 0.0, dark.darkness[window]), corner


def _measure(labels: NDArray[np.int32], label: int, box: tuple[slice, slice]) -> Shape:
    pixels = np.argwhere(labels[box] == label) + np.array([box[0].start, box[1].start])
    centre = pixels.mean(axis=0)
    # A pixel is a square, not a point: its own 1/12 px^2 keeps a one-pixel line from having no width.
    moments = np.cov(pixels.T, bias=True) + np.eye(2) / 12.0
    values, vectors = np.linalg.eigh(moments)
    short, long = np.sqrt(12.0 * values)
    rows, columns = labels.shape
    cut = box[0].start == 0 or box[1].start == 0 or box[0].stop == rows or box[1].stop == columns
    return Shape(label, len(pixels), centre, vectors[:, 1], float(long), float(short), bool(cut))
