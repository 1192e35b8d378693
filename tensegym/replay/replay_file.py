"""Replay files: a recording inside the page that plays it, one HTML file that needs no server and no network.

The recording stands in ``<script id="recording">`` as base64 of a zlib stream of: the length of a header (4 bytes,
little-endian), the header (JSON), and the arrays it lists, float32, little-endian, one after another.
"""

from __future__ import annotations

import base64
import json
import math
import re
import zlib
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.design.design_file import design_from_dict, design_to_dict
from tensegym.errors import InputError
from tensegym.files import VERSION, check_file, without_version, write_text
from tensegym.physics.terrain import Ground
from tensegym.tables import as_number, as_text, in_file, mapping, parse_json, read_text

from .recording import SHAPES, Recording
from .scenery import scenery

MOST_BYTES = 1 << 30  # of a recording when unpacked
_SLOT = "RECORDING"
_PAGE = ("replay.css", "unpack.js", "robot.js", "view.js", "plots.js", "replay.js")  # what replay.html is made of
_BEGINS = '<script id="recording" type="text/plain">'
_PATTERN = re.compile(_BEGINS + "([A-Za-z0-9+/=]*)</script>")


def check_replay(path: Path, to_be: Path | None = None) -> None:
    """Look whether a replay can be written at a path, or could once the folder ``to_be`` is there. Raises
    FileNotFoundError or InputError."""
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"a replay is an HTML file, its name ends in .html; given {str(path)!r}")
    if to_be is None or path.parent.resolve() != to_be.resolve() or path.exists():
        check_file(path)


def write_replay(recording: Recording, path: str | Path) -> None:
    """Write the page with the recording in it; the file is whole or, as before, not there. Raises as `check_replay`."""
    check_replay(Path(path))
    page = files("tensegym.replay") / "page"
    text = (page / "replay.html").read_text(encoding="utf-8")
    for name in _PAGE:
        text = text.replace(f"/* {name} */", (page / name).read_text(encoding="utf-8"))
    write_text(Path(path), text.replace(_SLOT, base64.b64encode(pack(recording)).decode("ascii"), 1))


def read_replay(path: str | Path) -> Recording:
    """The recording in a replay's page. Raises InputError, naming the file, or FileNotFoundError."""
    text = read_text(path, "replay", InputError)
    with in_file(f"replay {path}"):
        found = _PATTERN.search(text)
        if not found and _BEGINS in text:
            raise InputError("its recording is cut off or damaged; copy it again, or record anew")
        if not found:
            raise InputError("there is no recording in it; tensegym roll --replay run.html writes one")
        try:
            packed = base64.b64decode(found[1], validate=True)
        except ValueError as error:
            raise InputError(f"its recording is damaged: {error}") from error
        return unpack(packed)


def pack(recording: Recording) -> bytes:
    """A recording as bytes, with what a page needs to draw it."""
    arrays = {name: np.asarray(array, dtype="<f4") for name, array in recording.arrays().items()}
    ground = recording.ground
    header = {
        "version": VERSION, "title": recording.title, "engine": recording.engine, "dt": recording.dt,
        "ground": None if ground is None else ground.cell, "design": design_to_dict(recording.design),
        "arrays": {name: array.shape for name, array in arrays.items()}, "order": list(arrays),
        "scenery": scenery(recording),
    }  # fmt: skip
    head = json.dumps(header, allow_nan=False).encode()
    head += b" " * (-len(head) % 4)  # so that the arrays are aligned
    return zlib.compress(b"".join([len(head).to_bytes(4, "little"), head, *(a.tobytes() for a in arrays.values())]), 9)


def unpack(packed: bytes) -> Recording:
    """The recording in bytes. Raises InputError where they are none."""
    try:
        inflate = zlib.decompressobj()
        data = inflate.decompress(packed, MOST_BYTES)
    except zlib.error as error:
        raise InputError(f"its recording is damaged: {error}") from error
    size = 4 + int.from_bytes(data[:4], "little")
    if not inflate.eof or size > len(data):
        raise InputError("its recording is cut off")
    header = without_version(mapping(parse_json(data[4:size].decode("utf-8", "replace"), "header", InputError),
                                     "header", InputError), "the replay")  # fmt: skip
    arrays = _arrays(mapping(header.get("arrays"), "arrays", InputError), data[size:])
    heights, boxes, cell = arrays.pop("heights"), arrays.pop("boxes"), header.get("ground")
    ground = None
    if cell is not None:
        ground = Ground(heights, as_number(cell, "ground", InputError, "the spacing of its grid in m"), boxes)
    faces = arrays.pop("faces").astype(np.int64)
    return Recording(
        design_from_dict(mapping(header.get("design"), "design", InputError)), **arrays, faces=faces, ground=ground,
        title=as_text(header.get("title"), "title", InputError), dt=as_number(header.get("dt"), "dt", InputError),
        engine=as_text(header.get("engine"), "engine", InputError),
    )  # fmt: skip


def _arrays(shapes: dict[str, Any], data: bytes) -> dict[str, Any]:
    """Arrays by name out of the bytes after the header."""
    found, at = dict[str, Any](), 0
    for name, wanted in SHAPES.items():
        shape = shapes.get(name)
        if not (isinstance(shape, list) and len(shape) == len(wanted) and all(map(_is_count, shape))):
            raise InputError(f"its recording has no array {name!r} of {len(wanted)} axes")
        end = at + 4 * math.prod(shape)
        if end > len(data):
            raise InputError(f"its recording ends before {name} does")
        found[name] = np.frombuffer(data[at:end], dtype="<f4").reshape(shape).astype(float)
        at = end
    return found


def _is_count(value: Any) -> bool:
    return type(value) is int and 0 <= value <= MOST_BYTES
