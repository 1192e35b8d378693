"""Pictures of a stand with a known pose, drawn by counting sub-pixels: nothing of what `track` does to find it."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy import ndimage

ARM_MM = 120.0


@dataclass(frozen=True)
class Picture:
    """One picture; lengths in px, points (column, row), the angle counterclockwise as seen."""

    rows: int = 240
    columns: int = 320
    angle_deg: float = 12.0
    tip: tuple[float, float] = (104.3, 121.6)
    length: float = 160.0
    width: float = 14.0
    marker: tuple[float, float] = (38.7, 119.2)
    marker_radius: float = 8.0
    square_marker: bool = False
    round_ends: bool = False
    blur: float = 0.0
    noise: float = 0.0
    uneven: float = 0.0
    seed: int = 0

    def drawn(self) -> np.ndarray:
        """Grey levels 0..255 (rows, columns)."""
        grey = replace(self, noise=0.0, seed=0)._noiseless()
        noise = np.random.default_rng(self.seed).normal(0.0, self.noise, grey.shape)
        return np.clip(np.round(grey + noise), 0.0, 255.0)

    @lru_cache(maxsize=4)  # noqa: B019 a few pictures, for tests that repeat one with other noise
    def _noiseless(self) -> np.ndarray:
        n = 4
        x = (np.arange(self.columns * n) + 0.5) / n - 0.5
        y = ((np.arange(self.rows * n) + 0.5) / n - 0.5)[:, None]
        c, s = np.cos(np.radians(self.angle_deg)), -np.sin(np.radians(self.angle_deg))
        along = (x - self.tip[0]) * c + (y - self.tip[1]) * s
        across = (y - self.tip[1]) * c - (x - self.tip[0]) * s
        if self.round_ends:
            r = self.width / 2
            ink = np.hypot(along - np.clip(along, r, self.length - r), across) <= r
        else:
            ink = (np.abs(along - self.length / 2) <= self.length / 2) & (np.abs(across) <= self.width / 2)
        dx, dy = x - self.marker[0], y - self.marker[1]
        spot = np.maximum(np.abs(dx), np.abs(dy)) if self.square_marker else np.hypot(dx, dy)
        ink |= spot <= self.marker_radius
        cover = ink.reshape(self.rows, n, self.columns, n).mean(axis=(1, 3))
        v, u = np.mgrid[-1 : 1 : self.rows * 1j, -1 : 1 : self.columns * 1j]
        light = 215.0 * (1.0 - self.uneven * (0.3 * (1.0 + u) + 0.2 * (u**2 + v**2)))
        grey = light * (1.0 - 0.88 * cover)
        return ndimage.gaussian_filter(grey, self.blur) if self.blur else grey

    def scaled(self, factor: float) -> "Picture":
        """The same scene with ``factor`` times as many pixels a side."""
        k = factor
        return replace(self, rows=round(k * self.rows), columns=round(k * self.columns), length=k * self.length,
                       width=k * self.width, marker_radius=k * self.marker_radius,
                       tip=(k * self.tip[0], k * self.tip[1]),
                       marker=(k * self.marker[0], k * self.marker[1]))  # fmt: skip

    def tip_from_marker_mm(self) -> np.ndarray:
        """(2,) y upward."""
        return (np.array(self.tip) - self.marker) * (1.0, -1.0) * ARM_MM / self.length


def save(grey: np.ndarray, path: Path) -> Path:
    from PIL import Image

    Image.fromarray(grey.astype(np.uint8)).save(path)
    return path


def stand(theta_deg: float, tip_mm: tuple[float, float], tilt_deg: float = 1.7, **options: float) -> Picture:
    """A stand whose hinge's base sits in the picture under a camera tilted by ``tilt_deg``, 0.4 mm a pixel."""
    tilt, scale, base, marker_mm = np.radians(tilt_deg), 0.4, np.array([60.0, 150.0]), np.array([-8.0, 11.0])
    turn = np.array([[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]])
    tip, marker = (base + (turn @ np.array(p)) * (1.0, -1.0) / scale for p in (tip_mm, marker_mm))
    return Picture(rows=300, columns=500, angle_deg=theta_deg + tilt_deg, tip=tuple(tip), marker=tuple(marker),
                   length=ARM_MM / scale, width=25.0, marker_radius=12.0, **options)  # fmt: skip
