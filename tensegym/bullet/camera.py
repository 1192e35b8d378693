"""Camera: pictures of a world, and what its window shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray

from .engine import pybullet


class Camera:
    """Looks at a client's bodies."""

    def __init__(self, client: int) -> None:
        self.client = client
        self._lines: list[int] = []

    def image(self, eye: Sequence[float], target: Sequence[float], width: int, height: int) -> tuple[Any, ...]:
        """TinyRenderer: rgb (h, w, 3) uint8 and the (4, 4) world-to-clip matrix used."""
        view = pybullet.computeViewMatrix(list(eye), list(target), [0, 0, 1], physicsClientId=self.client)
        projection = pybullet.computeProjectionMatrixFOV(40, width / height, 0.05, 20, physicsClientId=self.client)
        _, _, pixels, _, _ = pybullet.getCameraImage(
            width, height, view, projection, shadow=1, lightDirection=[1, 1, 3],
            renderer=pybullet.ER_TINY_RENDERER, physicsClientId=self.client,
        )  # fmt: skip
        rgb = np.asarray(pixels, dtype=np.uint8).reshape(height, width, 4)[:, :, :3]
        clip = np.reshape(projection, (4, 4), order="F") @ np.reshape(view, (4, 4), order="F")
        return rgb, clip

    def draw_lines(self, ends: FloatArray, colours: Sequence[Sequence[float]]) -> None:
        """Lines (k, 2, 3) in the window, replacing those drawn before."""
        old = self._lines or [-1] * len(ends)
        self._lines = [
            pybullet.addUserDebugLine(a.tolist(), b.tolist(), list(colour), 2, replaceItemUniqueId=line,
                                      physicsClientId=self.client)
            for (a, b), colour, line in zip(ends, colours, old, strict=True)
        ]  # fmt: skip

    def look_at(self, target: FloatArray, distance: float) -> None:
        """Move the window's camera."""
        pybullet.resetDebugVisualizerCamera(distance, 45, -25, target.tolist(), physicsClientId=self.client)
