"""BaseFrame: where a hinge's base axes lie in a picture, so that a sighting becomes the hinge tip's pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tensegym.arrays import FloatArray

from .sighting import Sighting


@dataclass(frozen=True)
class BaseFrame:
    """Base axes of the hinge (origin at its fixed end A, x along the undeformed arm) seen by the camera."""

    turn: float = 0.0
    """Angle from the picture's right to the base x axis, counterclockwise [rad]"""
    marker: tuple[float, float] = (0.0, 0.0)
    """Marker's centre in base axes [m]"""

    def pose(self, seen: Sighting, arm_length: float, arm_start: float = 0.0) -> tuple[float, FloatArray]:
        """Angle [rad] in (-pi, pi] and tip (2,) [m] of the hinge in base axes.

        ``arm_length`` [m] is the painted arm's, ``arm_start`` [m] how far along the arm beyond the tip it begins.
        """
        theta = -float((self.turn - seen.angle + np.pi) % (2.0 * np.pi) - np.pi)
        from_marker = _turned(seen.from_marker(arm_length), -self.turn)
        return theta, self.marker + from_marker - arm_start * np.array([np.cos(theta), np.sin(theta)])


def frame_at_rest(seen: Sighting, arm_length: float, tip_at_rest: float, arm_start: float = 0.0) -> BaseFrame:
    """The frame in which the arm of an unloaded picture lies along x with the hinge's tip at (``tip_at_rest``, 0) [m].

    It takes the camera's tilt and the place of the marker out of the measurement.
    """
    from_marker = _turned(seen.from_marker(arm_length), -seen.angle)
    x, y = np.array([tip_at_rest + arm_start, 0.0]) - from_marker
    return BaseFrame(seen.angle, (float(x), float(y)))


def _turned(vector: FloatArray, angle: float) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ vector
