"""PyBullet itself, for the modules of this package, and what it writes past Python on standard output and error."""

from __future__ import annotations

import ctypes
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress


@contextmanager
def captured() -> Iterator[list[str]]:
    """Keep what the engine writes within the block from everyone; after it the list holds that as one line, if any."""
    said: list[str] = []
    with tempfile.TemporaryFile() as file:
        _flush()
        kept = [os.dup(stream) for stream in (1, 2)]
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
        try:
            yield said
        finally:
            _flush()
            for stream, copy in zip((1, 2), kept, strict=True):
                os.dup2(copy, stream)
                os.close(copy)
            file.seek(0)
            text = re.sub(r"b3\w+\[[^\]]*\]:", " ", file.read().decode(errors="replace"))
            said += [" ".join(text.split())[:300]] if text.strip() else []


def _flush() -> None:
    """Python's and C's own buffers: what was written before belongs where it was meant to go."""
    sys.stdout.flush()
    sys.stderr.flush()
    with suppress(OSError, TypeError, AttributeError):  # no C library by that way: the engine's lines come late
        ctypes.CDLL(None).fflush(None)


with captured():  # its greeting: where a command's error is to stand alone
    import pybullet

__all__ = ["captured", "pybullet"]
