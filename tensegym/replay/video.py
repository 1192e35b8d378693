"""Pictures and videos of recordings: the clock, the colours' key and the nodes' numbers are written into them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tensegym.design.solids import solids
from tensegym.files import replace_path
from tensegym.robot.picture import Camera, picture
from tensegym.robot.sight import FULL_SCALE, Sight, cable_ends, tension_colours, upward

from .recording import Recording

FRAMES_PER_SECOND = 25


def sight_at(recording: Recording, row: int) -> Sight:
    """What there is to be seen at a row of a recording."""
    poses, face = recording.poses[row], int(recording.faces[row])
    nodes = recording.nodes[row]
    direction, place = (each if np.isfinite(each).all() else None
                        for each in (recording.directions[row], recording.places[row]))  # fmt: skip
    return Sight(
        solids(recording.design), poses, cable_ends(recording.model, poses), recording.tensions[row],
        recording.model.driven, recording.design.length, recording.centres[row], upward(recording.gravity),
        recording.ground, nodes[recording.triangles[face]] if face >= 0 else None,
        direction, place, recording.path,
    )  # fmt: skip


def frame(
    recording: Recording, row: int, width: int = 640, height: int = 480, *, numbers: bool = False, key: bool = True
) -> NDArray[np.uint8]:
    """(height, width, 3) picture of one row: what was seen, the time, and the key of the cables' colours.

    Raises ModuleNotFoundError without Pillow.
    """
    from PIL import Image, ImageDraw, ImageFont

    sight = sight_at(recording, row)
    image = Image.fromarray(picture(sight, width, height))
    pen, font = ImageDraw.Draw(image), ImageFont.load_default(round(height / 22))
    pen.text((12, 8), f"t = {recording.times[row]:.2f} s", "#111111", font)
    if numbers:
        at, depth = Camera(sight, width, height, 0.8)(recording.nodes[row])
        taken = np.zeros((0, 2))
        for n in np.argsort(depth).tolist():  # the nearer one first; one that hides behind another is written below
            below = bool(len(taken)) and np.abs(taken - at[n]).max(axis=1).min() < height / 24
            pen.text(tuple(at[n] + [6, height / 24 if below else -6]), str(n + 1), "#111111", font, anchor="ls",
                     stroke_width=2, stroke_fill="#f8f8f8")  # fmt: skip
            taken = np.concatenate([taken, at[n][None]])
    if key:
        _draw_key(image, pen, font)
    return np.asarray(image)


def _draw_key(image: object, pen: object, font: object) -> None:
    """What the cables' colours say."""
    from PIL import Image, ImageDraw

    assert isinstance(image, Image.Image) and isinstance(pen, ImageDraw.ImageDraw)
    wide, high = image.width // 5, max(6, image.height // 60)
    left, top = image.width - wide - image.width // 6, image.height - 3 * high
    bar = tension_colours(np.linspace(0.1, FULL_SCALE, wide)).astype(np.uint8)
    image.paste(Image.fromarray(np.tile(bar, (high, 1, 1))), (left, top))
    pen.text((left - 8, top + high / 2), "tension  0", "#111111", font, anchor="rm")  # type: ignore[arg-type]
    pen.text((left + wide + 8, top + high / 2), f"{FULL_SCALE:g} N", "#111111", font, anchor="lm")  # type: ignore[arg-type]


def write_video(recording: Recording, out: Path) -> None:
    """H.264, FRAMES_PER_SECOND, at true speed. Raises ModuleNotFoundError without moviepy."""
    from moviepy import ImageSequenceClip

    count = max(1, round(recording.seconds * FRAMES_PER_SECOND))
    wanted = recording.times[0] + np.arange(count) / FRAMES_PER_SECOND
    rows = np.searchsorted(recording.times, wanted + 1e-9, side="right") - 1
    frames = [frame(recording, row) for row in rows.tolist()]
    with replace_path(out) as fresh:
        ImageSequenceClip(frames, fps=FRAMES_PER_SECOND).write_videofile(str(fresh), logger=None, audio=False)
