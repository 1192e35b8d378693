"""A program of this shelf: its options are the fields of a dataclass, which is called."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import tyro

from tensegym.errors import TensegymError, one_line


def run_script(command: Callable[..., Callable[[], Any]]) -> None:
    """Run it with the options of the command line and print what it returns; bad input is one line and status 2."""
    try:
        found = tyro.cli(command)()
    except (TensegymError, OSError) as error:
        print(f"error: {one_line(str(error))}", file=sys.stderr)
        sys.exit(2)
    print(*(found if isinstance(found, list) else [found]), sep="\n")
