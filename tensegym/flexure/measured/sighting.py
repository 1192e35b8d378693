"""Sighting: where the arm is in a picture of the stand, by its own known length and a marker fixed to the stand.

The stand of "Analytical and simulation modeling of flexible joints" (Rakshin and Borisov, 2023, fig. 4): the arm beyond
the hinge and a reference marker are black on a white ground; a camera looking square at them sees the arm's direction
and place, and the arm's length says how many pixels a metre has. The marker is a compact spot (disc or square) that
stays with the hinge's fixed side and lies nearer to the arm's hinge end than to its free end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError

from .dark_shapes import DarkShapes, Shape, alone, find_dark_shapes

LEAST_ARM_PX = 60.0
"""A shorter arm cannot give its angle to 0.1 deg: that is 0.1 px at its ends."""

_LEAST_ARM_ASPECT = 3.0
_LARGEST_MARKER_ASPECT = 1.6
_CORE = 0.15  # half width of the strip along the axis whose ends are the arm's ends, in widths: rounded ends count too


@dataclass(frozen=True)
class Sighting:
    """Arm and marker in one picture. Pixel points are (column, row), row downward, as drawing programs count."""

    angle: float
    """Direction from hinge end to free end, counterclockwise from the picture's right [rad]"""
    angle_error: float
    """Standard error of ``angle`` from the scatter of the arm's middle line [rad]"""
    hinge_end: FloatArray
    """(2,) [px]"""
    free_end: FloatArray
    """(2,) [px]"""
    marker: FloatArray
    """(2,) centre of the marker [px]"""
    width: float
    """Width of the arm [px]"""

    def metres_per_pixel(self, arm_length: float) -> float:
        """Scale of the picture for an arm of ``arm_length`` [m]."""
        return arm_length / float(np.linalg.norm(self.free_end - self.hinge_end))

    def from_marker(self, arm_length: float) -> FloatArray:
        """(2,) hinge end of the arm seen from the marker [m], picture axes with y upward."""
        return (self.hinge_end - self.marker) * (1.0, -1.0) * self.metres_per_pixel(arm_length)


def sight(grey: FloatArray) -> Sighting:
    """Find arm and marker in a grey picture (rows, columns), to a fraction of a pixel.

    Raises FlexureError: no contrast, no arm, no marker, several of one, an arm that is cut by the picture's edge, too
    short or not straight, a marker as far from one end as from the other.
    """
    dark = find_dark_shapes(grey)
    arm = _the_arm(dark.shapes)
    marker = _the_marker(dark.shapes, arm)
    ends, width, angle_error = _middle_line(dark, arm)
    centre = _centroid(dark, marker)
    distances = np.linalg.norm(ends - centre, axis=1)
    if abs(distances[0] - distances[1]) < 0.1 * arm.long:
        raise FlexureError("the marker is as near to one end of the arm as to the other: which is the hinge end?")
    near, far = ends[np.argsort(distances)]
    right, down = far[1] - near[1], far[0] - near[0]
    return Sighting(float(np.arctan2(-down, right)), angle_error, near[::-1], far[::-1], centre[::-1], width)


def _the_arm(shapes: tuple[Shape, ...]) -> Shape:
    arms = [s for s in shapes if s.long >= _LEAST_ARM_ASPECT * s.short]
    arms.sort(key=lambda s: -s.long)
    if not arms:
        raise FlexureError("no arm found: no dark shape is three times longer than wide")
    if len(arms) > 1 and arms[1].long > 0.5 * arms[0].long:
        raise FlexureError("more than one dark bar: which is the arm?")
    if arms[0].cut:
        raise FlexureError("the arm runs out of the picture: its length cannot give the scale")
    if arms[0].long < LEAST_ARM_PX:
        raise FlexureError(f"no arm found: the longest dark bar has {arms[0].long:.0f} px, {LEAST_ARM_PX:.0f} needed")
    return arms[0]


def _the_marker(shapes: tuple[Shape, ...], arm: Shape) -> Shape:
    spots = [s for s in shapes if s.long <= _LARGEST_MARKER_ASPECT * s.short and not s.cut and s.long > arm.short / 4.0]
    if not spots:
        raise FlexureError("no marker found: no compact dark spot apart from the arm")
    if len(spots) > 1 and spots[1].area > 0.25 * spots[0].area:
        raise FlexureError("more than one dark spot: which is the marker?")
    return spots[0]


def _centroid(dark: DarkShapes, shape: Shape) -> FloatArray:
    """(2,) row, column of the centre of darkness [px]: grey rims place it between pixels."""
    margin = max(3, round(shape.short / 8.0))
    weights, corner = alone(dark, shape, margin)
    rows, columns = np.indices(weights.shape)
    centre: FloatArray = np.array([np.vdot(weights, rows), np.vdot(weights, columns)]) / weights.sum() + corner
    return centre


def _middle_line(dark: DarkShapes, arm: Shape) -> tuple[FloatArray, float, float]:
    """Ends (2, 2) as row, column [px], width [px] and standard error of the direction [rad] of the arm.

    The picture is resampled along and across the arm. Its middle line is the straight line through the centres of
    darkness of the cross sections that have the arm's usual width: a dark leaf of the hinge that hangs on to the arm is
    left out.
    """
    margin = max(6, round(arm.short / 2.0))
    darkness, corner = alone(dark, arm, margin)
    along = np.arange(-arm.long / 2.0 - margin, arm.long / 2.0 + margin + 0.5)
    across = np.arange(-arm.short / 2.0 - margin, arm.short / 2.0 + margin + 0.25, 0.5)
    inner = np.abs(along) < 0.45 * arm.long
    point, axis = arm.centre - corner, arm.axis
    for _ in range(4):
        normal = np.array([-axis[1], axis[0]])
        grid = point[:, None, None] + axis[:, None, None] * along[:, None] + normal[:, None, None] * across
        cut = ndimage.map_coordinates(darkness, grid, order=1, mode="constant")
        breadth = cut.sum(axis=1)
        inner = _usual(breadth, float(np.median(breadth[inner])))
        offset = (cut @ across)[inner] / breadth[inner]
        (slope, intercept), covariance = np.polyfit(along[inner], offset, 1, cov=True)
        scatter = offset - (slope * along[inner] + intercept)
        point = point + intercept * normal
        axis = (axis + slope * normal) / np.hypot(1.0, slope)
    if np.sqrt(np.mean(scatter**2)) > 0.1 * arm.short:
        raise FlexureError("no arm found: the longest dark shape is not a straight bar")
    core = cut[:, np.abs(across) <= max(0.5, _CORE * arm.short)].mean(axis=1)
    width = 0.5 * float(np.median(breadth[inner]) / np.median(core[inner]))
    middle = float(along[inner].mean())
    reaches = [(sign, _end(core, breadth, sign * (along - middle), inner, width)) for sign in (-1.0, 1.0)]
    ends = np.array([point + axis * (middle + sign * reach) for sign, reach in reaches])
    return ends + corner, width, float(np.sqrt(covariance[0, 0])) * _inflation(scatter)


def _usual(breadth: FloatArray, level: float) -> NDArray[np.bool_]:
    """The longest run of cross sections of about the usual breadth ``level``, a twentieth cut off at each end, (n,)."""
    labels, count = ndimage.label((breadth > 0.6 * level) & (breadth < 1.6 * level))
    if not count:
        raise FlexureError("no arm found: the longest dark shape is not a straight bar")
    run = np.flatnonzero(labels == np.bincount(labels)[1:].argmax() + 1)
    spare = len(run) // 20
    inner = np.zeros(len(breadth), dtype=bool)
    inner[run[0] + spare : run[-1] + 1 - spare] = True
    return inner


def _end(core: FloatArray, breadth: FloatArray, reach: FloatArray,
         inner: NDArray[np.bool_], width: float) -> float:  # fmt: skip
    """Where along ``reach`` (n,), zero at the arm's middle, the arm ends [px].

    That is where the darkness falls to half, which neither blur nor the grey of cut pixels moves: the darkness near the
    middle line, so that a rounded end counts whole, unless something thinner than the arm goes on from there.
    """
    level = float(np.median(breadth[inner]))
    end = _falls(breadth, reach, 0.5 * level)
    beyond = breadth[(reach > end + 0.3 * width) & (reach < end + 0.8 * width)]
    thin = float(np.median(beyond)) if beyond.size else 0.0
    if thin > 0.07 * level:
        end = _falls(breadth, reach, 0.5 * (level + thin))
    else:
        end = _falls(core, reach, 0.5 * float(np.median(core[inner])))
    if not np.isfinite(end):
        raise FlexureError("no arm found: the longest dark bar has no clear end")
    return end


def _falls(profile: FloatArray, reach: FloatArray, level: float) -> float:
    """Where ``profile`` (n,) first falls through ``level`` beyond reach 0; infinite if it does not."""
    order = np.argsort(reach)
    profile, reach = profile[order], reach[order]
    beyond = np.flatnonzero((reach > 0.0) & (profile < level))
    if not beyond.size:
        return float(np.inf)
    k = int(beyond[0])
    return float(np.interp(level, [profile[k], profile[k - 1]], [reach[k], reach[k - 1]]))


def _inflation(scatter: FloatArray) -> float:
    """How much larger a standard error is than least squares says, for neighbours (n,) that err together."""
    power = float(scatter @ scatter)
    together = sum(float(scatter[k:] @ scatter[:-k]) for k in range(1, 5)) / power if power > 0.0 else 0.0
    return float(np.sqrt(max(1.0, 1.0 + 2.0 * together)))
