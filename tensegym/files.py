"""Files that are whole or not there."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO


@contextmanager
def replace_file(path: Path) -> Iterator[TextIO]:
    """Open a text file beside ``path`` for writing and move it there only when the block ends well."""
    fresh = path.with_name(path.name + ".tmp")
    try:
        with fresh.open("w", newline="") as file:
            yield file
        os.replace(fresh, path)
    finally:
        fresh.unlink(missing_ok=True)
