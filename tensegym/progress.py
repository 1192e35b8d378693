"""The one progress bar: on standard error where that is a terminal; a log file stays short."""

from __future__ import annotations

import sys
from typing import Any


def progress_bar(**options: Any) -> Any:
    """A tqdm bar, which shows nothing where standard error is no terminal; ``options`` are tqdm's."""
    from tqdm import tqdm

    return tqdm(file=sys.stderr, disable=None, **options)
