"""Painting: strokes and four-cornered patches on a picture, one over the other, with soft edges."""

from __future__ import annotations

import numpy as np

from tensegym.compiled import kernel
from tensegym.physics.vectors import KERNEL

# Columns of an item: what it is, its colour (0 to 255), its opacity (0 to 1), whether it is round, its points [pixels]
KIND, COLOUR, OPACITY, ROUND, POINTS = 0, slice(1, 4), 4, 5, slice(6, 14)
STROKE, PATCH = 0.0, 1.0
ITEM_SIZE = 14


@kernel(**KERNEL)
def paint(image, items):
    """Paint items (k, 14) in their order onto image (h, w, 3), 0 to 255.

    A stroke's points are x, y and half its width at one end, then at the other; a patch's x, y of its corners, convex.
    What is round is lit as a rod is, or as a ball where both ends are one.
    """
    for k in range(len(items)):
        if items[k, 0] == STROKE:
            _stroke(image, items[k])
        else:
            _patch(image, items[k])


@kernel(**KERNEL)
def _stroke(image, item):
    """One stroke."""
    height, width = image.shape[0], image.shape[1]
    x0, y0, half0, x1, y1, half1 = item[6], item[7], item[8], item[9], item[10], item[11]
    dx, dy = x1 - x0, y1 - y0
    square = dx * dx + dy * dy
    reach = max(half0, half1) + 1
    for row in range(max(0, int(min(y0, y1) - reach)), min(height, int(max(y0, y1) + reach) + 1)):
        for column in range(max(0, int(min(x0, x1) - reach)), min(width, int(max(x0, x1) + reach) + 1)):
            px, py = column + 0.5 - x0, row + 0.5 - y0
            along = min(max((px * dx + py * dy) / square, 0.0), 1.0) if square > 0 else 0.0
            ox, oy = px - along * dx, py - along * dy
            half = half0 + along * (half1 - half0)
            off = np.sqrt(ox * ox + oy * oy)
            cover = item[4] * min(1.0, half + 0.5 - off) * min(1.0, 2 * half)
            if cover <= 0:
                continue
            light = 1.0
            if item[5] > 0:
                if square > 0:  # across the stroke alone, else the joints of a rod's pieces show
                    across = (px * dy - py * dx) / square
                    ox, oy = across * dy, -across * dx
                    off = np.sqrt(ox * ox + oy * oy)
                nx, ny = ox / max(half, off), oy / max(half, off)
                nz = np.sqrt(max(0.0, 1 - nx * nx - ny * ny))
                light = 0.5 + 0.7 * max(0.0, -0.35 * nx - 0.6 * ny + 0.72 * nz)  # from the upper left, before it
            for i in range(3):
                image[row, column, i] += cover * (min(255.0, light * item[1 + i]) - image[row, column, i])


@kernel(**KERNEL)
def _patch(image, item):
    """One patch, half a pixel larger than it is, so that no gap is left between two of a face."""
    height, width = image.shape[0], image.shape[1]
    left, right = min(item[6], item[8], item[10], item[12]), max(item[6], item[8], item[10], item[12])
    top, bottom = min(item[7], item[9], item[11], item[13]), max(item[7], item[9], item[11], item[13])
    area = (item[10] - item[6]) * (item[13] - item[9]) - (item[12] - item[8]) * (item[11] - item[7])
    sign = 1.0 if area > 0 else -1.0
    for row in range(max(0, int(top) - 1), min(height, int(bottom) + 2)):
        for column in range(max(0, int(left) - 1), min(width, int(right) + 2)):
            inside = 1.0
            for i in range(4):
                x, y, j = item[6 + 2 * i], item[7 + 2 * i], (i + 1) % 4
                ex, ey = item[6 + 2 * j] - x, item[7 + 2 * j] - y
                size = np.sqrt(ex * ex + ey * ey)
                if size > 0:
                    inside = min(inside, 1.0 + sign * (ex * (row + 0.5 - y) - ey * (column + 0.5 - x)) / size)
            cover = item[4] * inside
            if inside > 0:
                for i in range(3):
                    image[row, column, i] += cover * (item[1 + i] - image[row, column, i])
