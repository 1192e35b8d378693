"""Photo: picture files to grey levels, and a picture with what was found drawn on it.

Pillow is imported when a picture is read: it comes with matplotlib in the `train` extra, the rest of the package does
without.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.arrays import FloatArray
from tensegym.errors import FlexureError, InputError
from tensegym.files import replace_path

from .sighting import Sighting


def _pillow(module: str) -> Any:
    try:
        return importlib.import_module(f"PIL.{module}")
    except ImportError as error:
        raise FlexureError("reading pictures needs Pillow: pip install pillow") from error


def read_grey(path: Path) -> FloatArray:
    """Grey levels (rows, columns) of a picture file, turned upright as its camera noted, clear parts taken as white.

    Raises InputError naming a file that is no picture, FileNotFoundError if it is not there.
    """
    image_module, operations = _pillow("Image"), _pillow("ImageOps")
    try:
        with image_module.open(path) as file:
            picture = operations.exif_transpose(file)
            if picture.mode.startswith(("I", "F")):  # 16 and 32 bit grey: "L" would cut them to 8 bit
                grey = np.asarray(picture, dtype=float)
            else:
                paper = image_module.new("RGBA", picture.size, "white")
                on_paper = image_module.alpha_composite(paper, picture.convert("RGBA"))
                grey = np.asarray(on_paper.convert("L"), dtype=float)
    except FileNotFoundError:
        raise
    except (OSError, SyntaxError, ValueError, image_module.DecompressionBombError) as error:
        raise InputError(f"{path}: not a picture that can be read ({error})".splitlines()[0]) from error
    return grey


def draw_overlay(grey: FloatArray, seen: Sighting, path: Path) -> None:
    """Save the picture (rows, columns) as PNG with the arm's middle line in red and the marker's centre in blue.

    A ring marks the hinge end, a bar across the arm each end.
    """
    image_module, draw_module = _pillow("Image"), _pillow("ImageDraw")
    low, high = float(grey.min()), float(grey.max())
    levels = np.round((grey - low) * 255.0 / (high - low)).astype(np.uint8)
    picture = image_module.fromarray(levels).convert("RGB")
    pen = draw_module.Draw(picture)
    near, far, spot = seen.hinge_end, seen.free_end, seen.marker
    along = (far - near) / np.linalg.norm(far - near)
    half = np.array([-along[1], along[0]]) * seen.width
    right, down = seen.width * np.eye(2)
    thick = max(1, round(seen.width / 10.0))
    for a, b, colour in (
        (near, far, "red"),
        (near - half, near + half, "red"),
        (far - half, far + half, "red"),
        (spot - right, spot + right, "blue"),
        (spot - down, spot + down, "blue"),
    ):
        pen.line([*map(float, a), *map(float, b)], fill=colour, width=thick)
    box = [*map(float, near - seen.width), *map(float, near + seen.width)]
    pen.ellipse(box, outline="red", width=thick)
    with replace_path(path) as fresh:
        picture.save(fresh, format="PNG")
